//! What linking proves of the firmware: no request can make it panic, and none costs a double-precision operation.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use leg_host_tools::image::workspace_root;
use leg_host_tools::setup;
use object::{Object, ObjectSymbol};
use std::path::PathBuf;
use std::process::{Command, Output};

/// Kept between runs, so that only the first one compiles everything.
fn folder() -> PathBuf {
    workspace_root().join("target/proof")
}

/// Builds the image whose panics cannot be linked.
fn link(more: &[&str]) -> Output {
    setup::ensure_target(&mut |_| {}).unwrap();
    Command::new(env!("CARGO"))
        .arg("no-panic-proof")
        .arg("--target-dir")
        .arg(folder())
        .args(more)
        .current_dir(workspace_root())
        .env_remove("RUSTFLAGS")
        .env_remove("CARGO_ENCODED_RUSTFLAGS")
        .output()
        .unwrap()
}

fn said(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

#[test]
fn no_request_can_panic_and_none_needs_double_precision() {
    let output = link(&[]);
    assert!(output.status.success(), "{}", said(&output));

    let image = folder().join("thumbv7em-none-eabihf/firmware/no-panic-proof");
    let bytes = std::fs::read(image).unwrap();
    let elf = object::File::parse(&*bytes).unwrap();
    let names: Vec<&str> = elf
        .symbols()
        .filter_map(|symbol| symbol.name().ok())
        .collect();
    assert!(names.contains(&"_start"), "the image has a symbol table");
    // The names of the ABI's double-precision routines: __aeabi_dadd, __aeabi_f2d, __adddf3 …
    let double: Vec<&&str> = names
        .iter()
        .filter(|name| {
            name.starts_with("__aeabi_d") || name.ends_with("2d") || name.ends_with("df3")
        })
        .collect();
    assert!(double.is_empty(), "{double:?}");
}

#[test]
fn the_proof_fails_where_there_is_a_panic() {
    let output = link(&["--features", "with-a-panic"]);
    assert!(!output.status.success());
    let told = said(&output);
    assert!(
        told.contains("contains at least one panicking branch"),
        "{told}"
    );
}
