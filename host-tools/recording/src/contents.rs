//! The messages of an MCAP file, as far as it goes.

use mcap::read::{self, LinearReader, Options};
use mcap::records::{Record, op};
use mcap::{MAGIC, McapError, Message, MessageStream};
use std::collections::BTreeMap;

/// Bytes with which a recording begins: those of what may have no end are looked at first.
#[must_use]
pub const fn begins() -> &'static [u8] {
    MAGIC
}

/// The end of a recording that may go on: other programs read what is before it as a whole file. What is recorded next is written
/// over it, and is longer.
#[must_use]
pub fn interim_end() -> Vec<u8> {
    const DATA_END: [u8; 4] = [0; 4];
    // Without a summary.
    const FOOTER: [u8; 20] = [0; 20];
    let record = |kind: u8, content: &[u8]| {
        [
            &[kind],
            (content.len() as u64).to_le_bytes().as_slice(),
            content,
        ]
        .concat()
    };
    [
        record(op::DATA_END, &DATA_END),
        record(op::FOOTER, &FOOTER),
        MAGIC.to_vec(),
    ]
    .concat()
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
        // What a program that was killed leaves is whole up to a place, and has no summary.
        let finished = read::footer(bytes).is_ok_and(|footer| footer.summary_start > 0);
        Ok(Self { bytes, finished })
    }

    fn options<T: FromIterator<Options>>(&self) -> T {
        let options = (!self.finished).then_some(Options::IgnoreEndMagic);
        options.into_iter().collect()
    }

    /// Takes each message in turn, until `take` wants no more.
    pub fn visit_messages(
        &self,
        mut take: impl FnMut(&Message<'_>) -> Result<bool, String>,
    ) -> Result<(), String> {
        for message in self.messages()? {
            if !take(&message?)? {
                break;
            }
        }
        Ok(())
    }

    /// The messages, one after the other. In a file that did not come to its end they go to the last whole one.
    pub fn messages(
        &self,
    ) -> Result<impl Iterator<Item = Result<Message<'a>, String>> + use<'a>, String> {
        let finished = self.finished;
        let messages = MessageStream::new_with_options(self.bytes, self.options());
        let messages = messages.map_err(not_whole)?.enumerate();
        let cut_off = move |(_, message): &(usize, Result<Message<'a>, McapError>)| {
            let ends = matches!(
                message,
                Err(McapError::UnexpectedEof | McapError::UnexpectedEoc)
            );
            ends && !finished
        };
        let whole = messages.take_while(move |message| !cut_off(message));
        Ok(whole.map(|(count, message)| message.map_err(|error| not_whole_after(count, error))))
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
    format!("is no whole MCAP file: {}", words(error))
}

fn not_whole_after(messages: usize, error: McapError) -> String {
    match messages {
        0 => not_whole(error),
        _ => format!(
            "is no whole MCAP file: {}, after {messages} messages",
            words(error)
        ),
    }
}

/// What is wrong with a file.
fn words(error: McapError) -> String {
    match error {
        McapError::BadChunkCrc { saved, calculated } => {
            format!("a part is damaged (its checksum is {calculated:08X}, not {saved:08X})")
        }
        error => error.to_string(),
    }
}
