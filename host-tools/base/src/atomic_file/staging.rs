//! Several files that are moved together.

use super::new_directory;
use std::io;
use std::path::{Path, PathBuf};
use tempfile::TempDir;

/// Where several files of one directory are made before all of them are moved into it.
#[derive(Debug)]
pub struct StagingDirectory {
    directory: PathBuf,
    made: TempDir,
}

impl StagingDirectory {
    /// For the files of a directory, which is made if it is not there.
    ///
    /// # Errors
    /// The system's.
    pub fn new(directory: &Path) -> io::Result<Self> {
        std::fs::create_dir_all(directory)?;
        Ok(Self {
            directory: directory.into(),
            made: new_directory(directory)?,
        })
    }

    /// Where to make the files.
    #[must_use]
    pub fn path(&self) -> &Path {
        self.made.path()
    }

    /// Whether every file that was made can be moved into the directory.
    ///
    /// # Errors
    /// A directory is where a file has to go.
    pub fn check(&self) -> io::Result<()> {
        self.moves().map(drop)
    }

    /// Moves the files into the directory: all, or none if one of them cannot be.
    ///
    /// # Errors
    /// As [`Self::check`], or the system's.
    pub fn commit(self) -> io::Result<()> {
        for (from, to) in self.moves()? {
            std::fs::rename(from, to)?;
        }
        Ok(())
    }

    fn moves(&self) -> io::Result<Vec<(PathBuf, PathBuf)>> {
        let mut moves = Vec::new();
        for entry in std::fs::read_dir(self.made.path())? {
            let entry = entry?;
            let to = self.directory.join(entry.file_name());
            if to.is_dir() {
                let taken = format!("{} is a directory", to.display());
                return Err(io::Error::new(io::ErrorKind::IsADirectory, taken));
            }
            moves.push((entry.path(), to));
        }
        Ok(moves)
    }
}
