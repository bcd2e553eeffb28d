//! Hands the linker scripts to the board's binary.
//!
//! The linker looks into the workspace's folder first, so `memory.x` there serves every board.

use std::{env, error::Error};

const TARGET: &str = "thumbv7em-none-eabihf";

/// A board's feature, its binary and what its linking needs besides the common scripts.
struct Board {
    feature: &'static str,
    binary: &'static str,
    /// Folder of a `device.x`; the STM32's comes with its peripheral access crate.
    device: Option<&'static str>,
    arguments: &'static [&'static str],
}

const BOARDS: [Board; 2] = [
    Board {
        feature: "qemu",
        binary: "leg-qemu",
        device: Some("qemu"),
        arguments: &["--defsym=_flash_origin=0"],
    },
    Board {
        feature: "stm32g474",
        binary: "leg-stm32g474",
        device: None,
        arguments: &[],
    },
];

fn main() -> Result<(), Box<dyn Error>> {
    println!("cargo::rerun-if-changed=build.rs");
    let chosen: Vec<&Board> = BOARDS.iter().filter(|board| is_enabled(board)).collect();
    match chosen.as_slice() {
        [] => {}
        [board] if env::var("TARGET")? == TARGET => link(board)?,
        [board] => println!(
            "cargo::error=the feature `{}` builds for the board only: add `--target {TARGET}`",
            board.feature
        ),
        _ => println!(
            "cargo::error=an image is for one board: enable either `qemu` or `stm32g474`, not both"
        ),
    }
    Ok(())
}

fn is_enabled(board: &Board) -> bool {
    let variable = format!("CARGO_FEATURE_{}", board.feature.to_uppercase());
    env::var_os(variable).is_some()
}

fn link(board: &Board) -> Result<(), Box<dyn Error>> {
    let package = env::var("CARGO_MANIFEST_DIR")?;
    println!("cargo::rerun-if-changed={package}/../memory.x");
    if let Some(device) = board.device {
        println!("cargo::rerun-if-changed={package}/{device}/device.x");
        println!("cargo::rustc-link-search={package}/{device}");
    }
    let common = ["--nmagic", "-Tlink.x", "-Tdefmt.x"];
    for argument in common.iter().chain(board.arguments) {
        println!("cargo::rustc-link-arg-bin={}={argument}", board.binary);
    }
    Ok(())
}
