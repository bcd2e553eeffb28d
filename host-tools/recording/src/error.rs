//! Why something cannot be recorded.

use mcap::McapError;
use std::fmt::{self, Display};
use std::io;

/// Why something cannot be recorded.
#[derive(Debug)]
pub enum WriteError {
    /// What it is written to takes no more.
    Io(io::Error),
    /// A message has no form in a recording.
    Message(String),
}

impl WriteError {
    pub(crate) fn message(error: impl Display) -> Self {
        Self::Message(error.to_string())
    }
}

impl Display for WriteError {
    fn fmt(&self, to: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Io(error) => error.fmt(to),
            Self::Message(reason) => to.write_str(reason),
        }
    }
}

impl std::error::Error for WriteError {}

impl From<McapError> for WriteError {
    fn from(error: McapError) -> Self {
        match error {
            McapError::Io(error) => Self::Io(error),
            other => Self::message(other),
        }
    }
}
