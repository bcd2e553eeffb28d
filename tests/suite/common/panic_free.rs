//! The image that cannot be linked if any request can make the firmware panic.

use cargo_metadata::Message;
use leg_boards::image::workspace_root;
use leg_boards::setup;
use std::error::Error;
use std::process::{Command, Output};

/// Builds it, with more arguments for cargo, where the images of the boards are built: what they share is compiled
/// once.
///
/// # Errors
/// A target that cannot be installed, or cargo that cannot be started.
pub fn link(more: &[&str]) -> Result<Output, Box<dyn Error>> {
    setup::ensure_target(&mut |_| {})?;
    let output = Command::new(env!("CARGO"))
        .args(["no-panic-proof", "--message-format=json-render-diagnostics"])
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
    let executable = Message::parse_stream(output.stdout.as_slice())
        .filter_map(Result::ok)
        .find_map(|message| match message {
            Message::CompilerArtifact(artifact) => artifact.executable,
            _ => None,
        });
    Ok(std::fs::read(executable.ok_or("cargo names no image")?)?)
}
