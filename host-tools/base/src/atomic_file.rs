//! Files that are there as a whole or not at all.

mod workshop;

pub use workshop::Workshop;

use std::io;
use std::path::Path;
use tempfile::TempDir;

/// Makes the directory of `path`, lets `write` make a new file of the same name beside it, moves that to `path`, and gives
/// what `write` gave.
///
/// # Errors
/// The error of `write`, or the system's; `path` is then as it was.
pub fn replace<T, E: From<io::Error>>(
    path: &Path,
    write: impl FnOnce(&Path) -> Result<T, E>,
) -> Result<T, E> {
    let no_file = || io::Error::from(io::ErrorKind::IsADirectory);
    if path.is_dir() {
        return Err(no_file().into());
    }
    let (Some(directory), Some(name)) = (path.parent(), path.file_name()) else {
        return Err(no_file().into());
    };
    std::fs::create_dir_all(directory)?;
    let workshop = workshop_in(directory)?;
    let new = workshop.path().join(name);
    let written = write(&new)?;
    std::fs::rename(&new, path)?;
    Ok(written)
}

/// In the same directory: a move from one disk to another is a copy.
fn workshop_in(directory: &Path) -> io::Result<TempDir> {
    tempfile::Builder::new()
        .prefix(".leg-")
        .tempdir_in(directory)
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test may panic")]
mod tests {
    use super::replace;
    use std::io;

    #[test]
    fn a_failed_write_leaves_the_old_file_and_nothing_else() {
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().join("chart.svg");
        std::fs::write(&path, "old").unwrap();
        let failed = replace(&path, |new| -> io::Result<()> {
            std::fs::write(new, "half")?;
            Err(io::Error::other("disk full"))
        });
        assert!(failed.is_err());
        assert_eq!(std::fs::read_to_string(&path).unwrap(), "old");
        assert_eq!(std::fs::read_dir(directory.path()).unwrap().count(), 1);
    }

    #[test]
    fn a_folder_is_refused_before_anything_is_written() {
        let directory = tempfile::tempdir().unwrap();
        let refused = replace(directory.path(), |_| -> io::Result<()> { unreachable!() });
        let kind = refused.unwrap_err().kind();
        assert_eq!(kind, io::ErrorKind::IsADirectory);
    }

    #[test]
    fn a_whole_write_replaces_it_and_makes_the_folder() {
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().join("a/b/chart.svg");
        replace(&path, |new| std::fs::write(new, "new")).unwrap();
        assert_eq!(std::fs::read_to_string(&path).unwrap(), "new");
        assert_eq!(
            std::fs::read_dir(directory.path().join("a/b"))
                .unwrap()
                .count(),
            1
        );
    }
}
