//! The image that cannot be linked if any request can make the firmware panic.

use leg_boards::image::workspace_root;
use leg_boards::setup;
use std::error::Error;
use std::path::PathBuf;
use std::process::{Command, Output};

/// Kept between runs, so that only the first one compiles everything.
fn directory() -> PathBuf {
    workspace_root().join("target/proof")
}

/// Builds it, with more arguments for cargo.
///
/// # Errors
/// A target that cannot be installed, or cargo that cannot be started.
pub fn link(more: &[&str]) -> Result<Output, Box<dyn Error>> {
    setup::ensure_target(&mut |_| {})?;
    let output = Command::new(env!("CARGO"))
        .arg("no-panic-proof")
        .arg("--target-dir")
        .arg(directory())
        .args(more)
        .current_dir(workspace_root())
        .env_remove("RUSTFLAGS")
        .env_remove("CARGO_ENCODED_RUSTFLAGS")
        .output()?;
    Ok(output)
}

/// Its bytes, once it is linked.
///
/// # Errors
/// As [`link`]; what cargo says where it is not linked.
pub fn image() -> Result<Vec<u8>, Box<dyn Error>> {
    let output = link(&[])?;
    if !output.status.success() {
        return Err(String::from_utf8_lossy(&output.stderr).into());
    }
    let image = directory().join("thumbv7em-none-eabihf/firmware/no-panic-proof");
    Ok(std::fs::read(image)?)
}
