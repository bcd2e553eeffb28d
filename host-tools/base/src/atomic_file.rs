//! Files that are there as a whole or not at all.

mod part;
mod staging;

pub use part::PartFile;
pub use staging::StagingDirectory;

use std::ffi::OsStr;
use std::io;
use std::path::{Path, PathBuf};
use tempfile::{Builder, NamedTempFile, TempDir};

/// Makes the directory of `path`, lets `write` make a new file beside it whose name ends alike, moves that to `path`, and
/// gives what `write` gave.
///
/// # Errors
/// The error of `write`, or the system's; `path` is then as it was.
pub fn replace<T, E: From<io::Error>>(
    path: &Path,
    write: impl FnOnce(&Path) -> Result<T, E>,
) -> Result<T, E> {
    require_file(path)?;
    let path = &linked(path);
    let (Some(directory), Some(name)) = (path.parent(), path.file_name()) else {
        return Err(io::Error::from(io::ErrorKind::IsADirectory).into());
    };
    std::fs::create_dir_all(directory)?;
    let new = new_file(directory, name)?;
    let written = write(new.path())?;
    new.persist(path).map_err(|error| error.error)?;
    Ok(written)
}

/// The file that a link leads to, which stays a link; the path itself where it is none, or leads nowhere.
fn linked(path: &Path) -> PathBuf {
    let file = path
        .is_symlink()
        .then(|| path.canonicalize().ok())
        .flatten();
    file.unwrap_or_else(|| path.into())
}

/// Refuses what is there and is no file: a directory, or a device, which a file would replace.
fn require_file(path: &Path) -> io::Result<()> {
    match path.metadata() {
        Ok(there) if there.is_dir() => Err(io::ErrorKind::IsADirectory.into()),
        Ok(there) if !there.is_file() => {
            let kind = io::ErrorKind::InvalidInput;
            Err(io::Error::new(kind, "it is a device or a pipe, not a file"))
        }
        _ => Ok(()),
    }
}

/// In the same directory: a move from one disk to another is a copy.
fn new_file(directory: &Path, name: &OsStr) -> io::Result<NamedTempFile> {
    let mut builder = Builder::new();
    // A temporary file is its user's alone unless it is made otherwise; these are as any other file.
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    builder.prefix(".leg-").suffix(name).tempfile_in(directory)
}

fn new_directory(directory: &Path) -> io::Result<TempDir> {
    Builder::new().prefix(".leg-").tempdir_in(directory)
}
