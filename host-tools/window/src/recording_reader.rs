//! A recording that is read, a part in each frame: the window goes on meanwhile.

use crate::files::FileKind;
use crate::recorded_leg::RecordedLeg;
use leg_base::failure::Failure;
use leg_recording::SignalReader;

/// Messages that are read in a frame: some milliseconds.
pub const MESSAGES_A_FRAME: usize = 200;

/// Messages from which on it is said how far it has come: less is read before anybody has seen that.
const MESSAGES_TOLD: usize = 4000;

/// A recording of which a part is read.
pub struct RecordingReader {
    name: String,
    reader: SignalReader,
}

impl RecordingReader {
    /// Of a file of which nothing is read yet.
    ///
    /// # Errors
    /// One that is too large.
    pub fn new(name: String, bytes: Vec<u8>) -> Result<Self, Failure> {
        match FileKind::Recording.too_large(&name, bytes.len() as f64) {
            Some(failure) => Err(failure),
            None => Ok(Self {
                reader: SignalReader::new(name.clone(), bytes),
                name,
            }),
        }
    }

    /// The file.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Reads the part of a frame. The leg once everything is read.
    ///
    /// # Errors
    /// As [`RecordedLeg::open`].
    pub fn read_on(&mut self) -> Option<Result<RecordedLeg, Failure>> {
        let read = self.reader.read_on(MESSAGES_A_FRAME)?;
        Some(read.and_then(|signals| RecordedLeg::new(&self.name, signals)))
    }

    /// How many messages were read.
    #[must_use]
    pub fn messages(&self) -> usize {
        self.reader.messages()
    }

    /// How far it has come, in words; none as long as nobody would read them.
    #[must_use]
    pub fn words(&self) -> Option<String> {
        let told = self.messages() >= MESSAGES_TOLD;
        told.then(|| {
            format!(
                "{} is read: {:.0} s of the leg's time until now.",
                self.name,
                self.reader.time_s()
            )
        })
    }
}
