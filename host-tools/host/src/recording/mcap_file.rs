//! A recording as MCAP on a disk. A reader that needs no summary reads it up to its last flush if this program is killed.

use super::{About, RecordingError};
use leg_firmware::settings::Settings;
use leg_recording::{CHUNK_BYTES, McapWriter, interim_end, wall_ns};
use std::fs::File;
use std::io::{BufWriter, Seek, SeekFrom, Write};

/// A file that is being written.
pub(super) struct McapFile {
    pub writer: McapWriter<BufWriter<File>>,
    /// The same file, at the same place.
    file: File,
    /// Bytes of the messages that the system has.
    flushed: u64,
}

impl McapFile {
    pub fn new(file: File, about: &About, settings: &Settings) -> Result<Self, RecordingError> {
        let mut file = Self {
            file: file.try_clone()?,
            writer: McapWriter::new(BufWriter::new(file), about, settings)?,
            flushed: 0,
        };
        file.flush()?;
        Ok(file)
    }

    /// A time of the day, s since 1970, in ns; where it is not known the one that this time of the leg, s, is given.
    pub fn time_ns(&self, wall_time_s: Option<f64>, time_s: f64) -> u64 {
        wall_time_s.map_or_else(|| self.writer.leg_time_ns(time_s), wall_ns)
    }

    /// Whether it is time to flush: a chunk that fills is written by itself, and leaves the file without an end.
    pub fn full(&self) -> bool {
        self.writer.bytes() - self.flushed > CHUNK_BYTES / 2
    }

    /// Lets the system have what was taken, with an end behind it, over which the next is written.
    pub fn flush(&mut self) -> Result<(), RecordingError> {
        self.writer.flush()?;
        let end = interim_end();
        self.file.write_all(&end)?;
        self.file.seek(SeekFrom::Current(-(end.len() as i64)))?;
        self.flushed = self.writer.bytes();
        Ok(())
    }

    pub fn finish(self) -> Result<(), RecordingError> {
        self.writer.finish()?;
        Ok(())
    }
}
