//! Why there is no recording.

use leg_base::disk::help_for;
use leg_base::failure::Failure;
use leg_recording::WriteError;
use std::io;
use std::path::{Path, PathBuf};

/// Why there is no recording.
#[derive(Debug)]
pub enum RecordingError {
    /// Its file cannot be written.
    File(io::Error),
    /// A message has no form in its format: another file name would not help.
    Message(String),
    /// The recorded work failed.
    Work(Failure),
}

impl RecordingError {
    /// What is wrong with the recording in this file, and what to do about it. `part` is what was recorded until then, if it
    /// is kept.
    pub(super) fn failure(self, file: &Path, part: Option<PathBuf>) -> Failure {
        let file = file.display();
        match self {
            Self::File(error) => {
                let kept = part.map_or_else(String::new, |part| {
                    format!("; what was recorded until then is {}", part.display())
                });
                Failure::refused(
                    format!("cannot write {file}: {error}{kept}"),
                    help_for(&error, "name a file in a directory that may be written"),
                )
            }
            Self::Message(reason) => Failure::refused(
                format!("a message cannot be written to {file}: {reason}"),
                "report this as an error of the program",
            ),
            Self::Work(failure) => failure,
        }
    }
}

impl From<io::Error> for RecordingError {
    fn from(error: io::Error) -> Self {
        Self::File(error)
    }
}

impl From<WriteError> for RecordingError {
    fn from(error: WriteError) -> Self {
        match error {
            WriteError::Io(error) => Self::File(error),
            WriteError::Message(reason) => Self::Message(reason),
        }
    }
}

impl From<csv::Error> for RecordingError {
    fn from(error: csv::Error) -> Self {
        let reason = error.to_string();
        match error.into_kind() {
            csv::ErrorKind::Io(error) => Self::File(error),
            _ => Self::Message(reason),
        }
    }
}

impl From<Failure> for RecordingError {
    fn from(failure: Failure) -> Self {
        Self::Work(failure)
    }
}
