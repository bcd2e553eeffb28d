//! Recordings of a simulation or of a leg: MCAP, which Foxglove and PlotJuggler open and `leg replay` reproduces, or CSV.

mod csv_file;
mod error;
mod mcap_file;
mod replay;
mod tick_record;

#[cfg(test)]
mod tests;

pub use error::RecordingError;
pub use replay::{Replay, TickDifference, replay};

use csv_file::CsvFile;
use leg_base::atomic_file;
use leg_base::failure::Failure;
use leg_base::tick_time::{seconds, tick_s};
use leg_firmware::settings::Settings;
use leg_firmware::telemetry::Telemetry;
use leg_sim::simulation::Tick;
use mcap_file::McapFile;
use serde::Serialize;
use serde_json::Value;
use std::ffi::OsStr;
use std::path::Path;

/// Ticks of a simulation between two rows of a table: a row a millisecond.
const ROW_TICKS: u32 = 8;

/// A recording that is being written.
pub struct Recording {
    file: RecordingFile,
    /// What was taken so far.
    count: u32,
}

enum RecordingFile {
    Mcap(Box<McapFile>),
    Csv(Box<CsvFile>),
}

/// A message as JSON.
fn to_json(message: &impl Serialize) -> Result<Value, RecordingError> {
    serde_json::to_value(message).map_err(RecordingError::message)
}

impl Recording {
    /// Takes a tick of a simulation.
    pub fn take_tick(&mut self, tick: &Tick<'_>) -> Result<(), RecordingError> {
        match &mut self.file {
            RecordingFile::Mcap(file) => file.take_tick(self.count, tick)?,
            RecordingFile::Csv(file) if self.count.is_multiple_of(ROW_TICKS) => {
                let time_s = f64::from(self.count) * tick_s();
                file.write_row(time_s, &[&to_json(tick.telemetry)?, &to_json(tick.drive)?])?;
            }
            RecordingFile::Csv(_) => {}
        }
        self.count += 1;
        Ok(())
    }

    /// Takes telemetry of a leg. Its time is that of the leg since its board started.
    pub fn take_telemetry(&mut self, telemetry: &Telemetry<f32>) -> Result<(), RecordingError> {
        let time_s = seconds(telemetry.tick.into());
        match &mut self.file {
            RecordingFile::Mcap(file) => {
                let time_ns = (time_s * 1e9).round() as u64;
                file.write_telemetry(self.count, time_ns, telemetry)?;
            }
            RecordingFile::Csv(file) => file.write_row(time_s, &[&to_json(telemetry)?])?,
        }
        self.count += 1;
        Ok(())
    }

    fn finish(self) -> Result<(), RecordingError> {
        match self.file {
            RecordingFile::Mcap(mut file) => file.finish(),
            RecordingFile::Csv(mut file) => file.finish(),
        }
    }
}

/// Records in `file`, by the extension of its name, while `work` is done; the file is put in its place, whole, when the work
/// is done. A simulation is recorded with its settings, so that it can be replayed; telemetry of a leg without.
///
/// # Errors
/// A [`Failure`]: another extension and a file that cannot be written are refused (exit code 2); that of the work is passed
/// on as it is.
pub fn record<T>(
    file: &Path,
    settings: Option<&Settings>,
    work: impl FnOnce(&mut Recording) -> Result<T, RecordingError>,
) -> Result<T, Failure> {
    let extension = file.extension().and_then(OsStr::to_str);
    if !matches!(extension, Some("mcap" | "csv")) {
        let sentence = format!("{} is no name of a recording", file.display());
        return Err(Failure::refused(sentence, "end it with .mcap or .csv"));
    }
    let done = atomic_file::replace(file, |new| {
        let file = if extension == Some("csv") {
            RecordingFile::Csv(Box::new(CsvFile::create(new)?))
        } else {
            RecordingFile::Mcap(Box::new(McapFile::create(new, settings)?))
        };
        let mut recording = Recording { file, count: 0 };
        let result = work(&mut recording)?;
        recording.finish()?;
        Ok(result)
    });
    done.map_err(|error: RecordingError| error.failure(file))
}
