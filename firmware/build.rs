//! Hands the linker scripts to the board's binary.
//!
//! The linker looks into the workspace's folder first, so `memory.x` there serves every board.

use std::{env, error::Error};

const TARGET: &str = "thumbv7em-none-eabihf";

/// A board's feature, its binary and what its linking needs besides the common scripts.
struct Board {
    feature: &'static str,
    binary: &'static str,
    /// Its own linker script, by folder and name. (The STM32's `device.x` comes with its peripheral access crate.)
    script: [&'static str; 2],
    /// The linker's arguments, before the common ones: what a script places first stays where it is.
    arguments: &'static [&'static str],
}

const BOARDS: [Board; 2] = [
    Board {
        feature: "qemu",
        binary: "leg-qemu",
        script: ["qemu", "device.x"],
        arguments: &["--defsym=_flash_origin=0"],
    },
    Board {
        feature: "stm32g474",
        binary: "leg-stm32g474",
        script: ["stm32g474", "hot.x"],
        arguments: &["-Thot.x"],
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
    let [folder, script] = board.script;
    println!("cargo::rerun-if-changed={package}/{folder}/{script}");
    println!("cargo::rustc-link-search={package}/{folder}");
    let common = ["--nmagic", "-Tlink.x", "-Tdefmt.x"];
    for argument in board.arguments.iter().chain(&common) {
        println!("cargo::rustc-link-arg-bin={}={argument}", board.binary);
    }
    Ok(())
}
