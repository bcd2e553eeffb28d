//! Hands the linker scripts to the image.
//!
//! The linker looks into the workspace's directory first, so `memory.x` there serves every board.

use std::{env, error::Error};

const TARGET: &str = "thumbv7em-none-eabihf";

/// The linker's arguments. What a script places first stays where it is, so this board's own come first.
const ARGUMENTS: [&str; 4] = [
    "--defsym=_flash_origin=0",
    "--nmagic",
    "-Tlink.x",
    "-Tdefmt.x",
];

fn main() -> Result<(), Box<dyn Error>> {
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::rerun-if-changed=device.x");
    println!("cargo::rerun-if-changed=../../memory.x");
    if env::var("TARGET")? != TARGET {
        println!("cargo::error=this image is for the board only: build it with `cargo image-qemu`");
        return Ok(());
    }
    println!(
        "cargo::rustc-link-search={}",
        env::var("CARGO_MANIFEST_DIR")?
    );
    for argument in ARGUMENTS {
        println!("cargo::rustc-link-arg-bins={argument}");
    }
    Ok(())
}
