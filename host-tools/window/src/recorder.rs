//! What the window records of the leg that it shows: MCAP in memory, as `leg log` writes it, until it is saved.

use crate::files::RECORDING_BYTES_MAX;
use crate::history::Snapshot;
use leg_firmware::settings::Settings;
use leg_recording::{About, McapWriter, WriteError};
use std::io::Cursor;

/// The largest one: with its index it can still be opened here.
const BYTES_MAX: u64 = RECORDING_BYTES_MAX / 16 * 15;

/// A recording that is being made.
pub struct Recorder {
    /// None once it has come to its end.
    writer: Option<Box<McapWriter<Cursor<Vec<u8>>>>>,
    /// When it began, s of the leg; none before the first message.
    began_s: Option<f64>,
    last_s: f64,
    /// Messages so far.
    count: u32,
    /// Why it goes on no more.
    ended: Option<String>,
}

impl Recorder {
    /// Of a leg of that name with these settings. `begin_wall_time_s` is the time of the day that it has at its beginning, s since
    /// 1970: for a simulated leg, at the zero of its own time; none if it is not known.
    ///
    /// # Errors
    /// What has no form in a recording.
    pub fn new(
        leg: &str,
        settings: &Settings,
        begin_wall_time_s: Option<f64>,
    ) -> Result<Self, WriteError> {
        let about = About {
            rig: Some(leg.into()),
            // Whole milliseconds are short in words.
            begin_wall_time_s: begin_wall_time_s.map(|time_s| (time_s * 1e3).floor() / 1e3),
            ..About::log(&format!("{leg} in the window"))
        };
        let writer = McapWriter::new(Cursor::new(Vec::new()), &about, settings)?;
        Ok(Self {
            writer: Some(Box::new(writer)),
            began_s: None,
            last_s: 0.0,
            count: 0,
            ended: None,
        })
    }

    /// Takes the leg as it is at a time of its own, s; received at a time of the day, s since 1970, if that is known.
    pub fn take(&mut self, time_s: f64, tick: u32, wall_time_s: Option<f64>, at: &Snapshot) {
        let Some(writer) = &mut self.writer else {
            return;
        };
        let written = match &at.simulated {
            // Its number is that of its tick from 0 on, as in a recording of `leg run`.
            Some(simulated) => {
                let number = tick.saturating_sub(1);
                writer.write_simulation(number, &(at.report, *simulated))
            }
            None => {
                let time_ns = (wall_time_s.unwrap_or(time_s) * 1e9).round() as u64;
                writer.write_report(self.count, time_ns, &at.report)
            }
        };
        self.began_s.get_or_insert(time_s);
        self.last_s = time_s;
        self.count += 1;
        self.ended = match written {
            Err(error) => Some(error.to_string()),
            Ok(()) if writer.bytes() >= BYTES_MAX => {
                Some(format!("it has reached {} MiB", BYTES_MAX >> 20))
            }
            Ok(()) => None,
        };
    }

    /// Time that it has, s of the leg. A board that has started anew begins its time again.
    #[must_use]
    pub fn time_s(&self) -> f64 {
        (self.last_s - self.began_s.unwrap_or(self.last_s)).max(0.0)
    }

    /// About how large it is, bytes.
    #[must_use]
    pub fn bytes(&self) -> u64 {
        self.writer.as_ref().map_or(0, |writer| writer.bytes())
    }

    /// Why it cannot go on: it is to be saved.
    #[must_use]
    pub fn ended(&self) -> Option<&str> {
        self.ended.as_deref()
    }

    /// Ends it, and gives it as a file.
    ///
    /// # Errors
    /// What cannot be written; a recording without a message.
    pub fn finish(mut self) -> Result<Vec<u8>, String> {
        let nothing = "nothing was recorded yet: the leg has reported nothing";
        let writer = self.writer.take().ok_or(nothing)?;
        let bytes = writer.finish().map_err(|error| error.to_string())?;
        if self.count == 0 {
            return Err(nothing.into());
        }
        Ok(bytes.into_inner())
    }
}

impl Drop for Recorder {
    fn drop(&mut self) {
        // A writer that is dropped unfinished keeps its memory.
        if let Some(writer) = self.writer.take() {
            let _ = writer.finish();
        }
    }
}
