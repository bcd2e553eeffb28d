//! What to do where nothing can be written.

use std::io;

/// What to do about an error of a write: to make room where there is none, and `otherwise` else.
#[must_use]
pub fn help_for(error: &io::Error, otherwise: &'static str) -> &'static str {
    match error.kind() {
        io::ErrorKind::StorageFull | io::ErrorKind::QuotaExceeded => {
            "make room on the disk, or write to another one"
        }
        io::ErrorKind::ResourceBusy => "name another file, or end the program that uses this one",
        io::ErrorKind::FileTooLarge => "raise the limit of a file's size, see `ulimit -f`",
        _ => otherwise,
    }
}
