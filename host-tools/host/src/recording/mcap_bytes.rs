//! A recording's file in memory.

use leg_base::failure::Failure;
use std::fs::File;
use std::io::{self, Read};
use std::path::Path;

/// All of a file that begins as a recording; no more than the beginning of another one, which may have no end.
/// `help` is what to do where it cannot be read.
pub(super) fn read(file: &Path, help: &str) -> Result<Vec<u8>, Failure> {
    let refused =
        |error| Failure::refused(format!("{}: cannot be read: {error}", file.display()), help);
    bytes(file).map_err(refused)
}

fn bytes(file: &Path) -> io::Result<Vec<u8>> {
    let begins = leg_recording::begins();
    let mut file = File::open(file)?;
    let mut bytes = Vec::new();
    (&mut file)
        .take(begins.len() as u64)
        .read_to_end(&mut bytes)?;
    if bytes == begins {
        file.read_to_end(&mut bytes)?;
    }
    Ok(bytes)
}
