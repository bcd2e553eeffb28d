//! A file that grows for long, and can be found where its program is killed meanwhile.

use std::fs::{File, TryLockError};
use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};
use tempfile::TempPath;

/// The most unfinished files of one name.
const PARTS_MAX: u32 = 1000;

/// A file that is written beside its name, under one that says so: `leg.part.mcap` for `leg.mcap`. Where the name is a link, it is written beside the file
/// that the link leads to, by the name of that. It is removed where it is
/// neither committed nor kept.
#[derive(Debug)]
pub struct PartFile {
    to: PathBuf,
    part: TempPath,
}

impl PartFile {
    /// Makes the directory of `to` and the file. One that is there is left alone: this one is `leg.part2.mcap` then.
    ///
    /// # Errors
    /// The system's; a directory or a device is where the file has to go; [`ErrorKind::ResourceBusy`] where another program is
    /// at work on it.
    pub fn create(to: &Path) -> io::Result<(Self, File)> {
        super::require_file(to)?;
        let to = super::linked(to);
        if let Some(directory) = to.parent() {
            std::fs::create_dir_all(directory)?;
        }
        for number in 1..PARTS_MAX {
            let part = part_path(&to, number);
            match File::create_new(&part) {
                Ok(file) => {
                    lock(&file);
                    let part = TempPath::try_from_path(part)?;
                    return Ok((Self { to, part }, file));
                }
                Err(error) if error.kind() == ErrorKind::AlreadyExists => require_idle(&part)?,
                Err(error) => return Err(error),
            }
        }
        Err(ErrorKind::AlreadyExists.into())
    }

    /// Gives it its name.
    ///
    /// # Errors
    /// The system's; it is removed then.
    pub fn commit(self) -> io::Result<()> {
        Ok(self.part.persist(&self.to)?)
    }

    /// Leaves it as it is, and says where.
    ///
    /// # Errors
    /// The system's.
    pub fn keep(self) -> io::Result<PathBuf> {
        Ok(self.part.keep()?)
    }

    /// The first of those that are there already: of a program that was killed, or that is still at work.
    #[must_use]
    pub fn unfinished(to: &Path) -> Option<PathBuf> {
        Some(part_path(&super::linked(to), 1)).filter(|part| part.exists())
    }
}

/// Marks a file as one at which a program is at work, for as long as it is open. Elsewhere than on Unix nobody else could read it
/// then.
fn lock(file: &File) {
    if cfg!(unix) {
        // A file system without locks: it stays without the mark.
        let _ = file.lock();
    }
}

/// Refuses a part at which a program is at work: whichever finished last would replace the other's file.
fn require_idle(part: &Path) -> io::Result<()> {
    if cfg!(unix)
        && let Ok(file) = File::open(part)
        && let Err(TryLockError::WouldBlock) = file.try_lock()
    {
        let sentence = format!("another program is writing it, as {}", part.display());
        return Err(io::Error::new(ErrorKind::ResourceBusy, sentence));
    }
    Ok(())
}

fn part_path(to: &Path, number: u32) -> PathBuf {
    let word = match number {
        1 => String::from("part"),
        number => format!("part{number}"),
    };
    match to.extension() {
        Some(extension) => {
            let mut ending = std::ffi::OsString::from(word + ".");
            ending.push(extension);
            to.with_extension(ending)
        }
        None => to.with_extension(word),
    }
}
