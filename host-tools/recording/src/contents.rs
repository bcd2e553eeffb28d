//! The messages of an MCAP file, as far as it goes.

use mcap::read::{LinearReader, Options};
use mcap::records::Record;
use mcap::{MAGIC, McapError, Message, MessageStream};
use std::collections::BTreeMap;

/// Bytes with which a recording begins: those of what may have no end are looked at first.
#[must_use]
pub const fn begins() -> &'static [u8] {
    MAGIC
}

/// A file in memory.
pub(crate) struct Contents<'a> {
    bytes: &'a [u8],
    /// Whether it came to its end.
    pub finished: bool,
}

impl<'a> Contents<'a> {
    /// All of a file that begins as a recording.
    pub fn new(bytes: &'a [u8]) -> Result<Self, String> {
        if !bytes.starts_with(MAGIC) {
            return Err(not_whole(McapError::BadMagic));
        }
        // What a program that was killed leaves is whole up to a place.
        let finished = bytes.len() > MAGIC.len() && bytes.ends_with(MAGIC);
        Ok(Self { bytes, finished })
    }

    fn options<T: FromIterator<Options>>(&self) -> T {
        let options = (!self.finished).then_some(Options::IgnoreEndMagic);
        options.into_iter().collect()
    }

    /// Takes each message in turn, until `take` wants no more.
    pub fn for_each_message(
        &self,
        mut take: impl FnMut(&Message<'_>) -> Result<bool, String>,
    ) -> Result<(), String> {
        let messages = MessageStream::new_with_options(self.bytes, self.options());
        for (count, message) in messages.map_err(not_whole)?.enumerate() {
            let message = match message {
                Err(McapError::UnexpectedEof | McapError::UnexpectedEoc) if !self.finished => break,
                message => message.map_err(|error| not_whole_after(count, error))?,
            };
            if !take(&message)? {
                break;
            }
        }
        Ok(())
    }

    /// The metadata of a name that stands before the first message.
    pub fn metadata(&self, name: &str) -> Option<BTreeMap<String, String>> {
        let records = LinearReader::new_with_options(self.bytes, self.options()).ok()?;
        for record in records {
            match record.ok()? {
                Record::Metadata(found) if found.name == name => return Some(found.metadata),
                Record::Chunk { .. } | Record::Message { .. } => return None,
                _ => {}
            }
        }
        None
    }
}

fn not_whole(error: McapError) -> String {
    format!("is no whole MCAP file: {error}")
}

fn not_whole_after(messages: usize, error: McapError) -> String {
    match messages {
        0 => not_whole(error),
        _ => format!("is no whole MCAP file: {error}, after {messages} messages"),
    }
}
