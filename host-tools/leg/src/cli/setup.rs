//! `leg setup`.

use super::{board, print};
use leg_base::failure::Failure;

/// Runs the command.
///
/// # Errors
/// A [`Failure`] that says what is missing and how to install it.
pub(super) fn run() -> Result<(), Failure> {
    let ready = board::prepare()?;
    print(&format!(
        "emulator: {}\nfirmware: {}\nAll is set up.\n",
        ready.qemu.display(),
        ready.image.display()
    ))
}
