//! The messages of an MCAP file, as far as it goes.

use mcap::read::Options;
use mcap::{MAGIC, McapError, Message, MessageStream};
use std::fs::File;
use std::io::{self, Read};
use std::path::Path;

/// A file in memory.
pub(super) struct Contents {
    bytes: Vec<u8>,
    /// Whether it came to its end.
    pub finished: bool,
}

impl Contents {
    /// All of a file that begins as a recording: another one may have no end.
    pub fn read(file: &Path) -> Result<Self, String> {
        let unreadable = |error: io::Error| format!("cannot be read: {error}");
        let mut bytes = vec![0; MAGIC.len()];
        let mut file = File::open(file).map_err(unreadable)?;
        match file.read_exact(&mut bytes) {
            Err(error) if error.kind() != io::ErrorKind::UnexpectedEof => {
                return Err(unreadable(error));
            }
            Ok(()) if bytes == MAGIC => {}
            _ => return Err(not_whole(McapError::BadMagic)),
        }
        file.read_to_end(&mut bytes).map_err(unreadable)?;
        // What a program that was killed leaves is whole up to a place.
        let finished = bytes.len() > MAGIC.len() && bytes.ends_with(MAGIC);
        Ok(Self { bytes, finished })
    }

    /// Takes each message in turn, until `take` wants no more.
    pub fn each(
        &self,
        mut take: impl FnMut(&Message<'_>) -> Result<bool, String>,
    ) -> Result<(), String> {
        let options = (!self.finished).then_some(Options::IgnoreEndMagic);
        let options = options.into_iter().collect();
        let messages = MessageStream::new_with_options(&self.bytes, options);
        for message in messages.map_err(not_whole)? {
            let message = match message {
                Err(McapError::UnexpectedEof | McapError::UnexpectedEoc) if !self.finished => break,
                message => message.map_err(not_whole)?,
            };
            if !take(&message)? {
                break;
            }
        }
        Ok(())
    }
}

fn not_whole(error: McapError) -> String {
    format!("is no whole MCAP file: {error}")
}
