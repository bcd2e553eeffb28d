//! What linking proves of the firmware: no request can make it panic, and none costs a double-precision operation.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use crate::common::panic_free;
use object::{Object, ObjectSymbol};

#[test]
fn no_request_can_panic_and_none_needs_double_precision() {
    let bytes = panic_free::image().unwrap();
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
    let output = panic_free::link(&["--features", "with-a-panic"]).unwrap();
    assert!(!output.status.success());
    let told = String::from_utf8_lossy(&output.stderr);
    assert!(
        told.contains("contains at least one panicking branch"),
        "{told}"
    );
}
