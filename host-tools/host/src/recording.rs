//! Recordings of a simulation or of a leg: MCAP, which Foxglove and PlotJuggler open and `leg replay` reproduces, or CSV.

mod csv_file;
mod mcap_file;
mod replay;
mod tick_record;

#[cfg(test)]
mod tests;

pub use replay::{Replay, ReplayError, TickDifference, replay};

use csv_file::CsvFile;
use leg_base::atomic_file;
use leg_base::failure::Failure;
use leg_base::tick_time::{seconds, tick_s};
use leg_firmware::settings::Settings;
use leg_firmware::telemetry::Telemetry;
use leg_sim::simulation::Tick;
use mcap_file::McapFile;
use serde_json::to_value;
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

/// Why a recording cannot be made.
#[derive(Debug, thiserror::Error)]
pub enum RecordingError {
    /// The system refused.
    #[error(transparent)]
    Io(#[from] std::io::Error),
    /// The MCAP file cannot be written.
    #[error(transparent)]
    Mcap(#[from] mcap::McapError),
    /// The CSV file cannot be written.
    #[error(transparent)]
    Csv(#[from] csv::Error),
    /// A message has no JSON.
    #[error("a message cannot be written: {0}")]
    Json(#[from] serde_json::Error),
    /// A message has no form in postcard's format.
    #[error("a message cannot be written: {0}")]
    Postcard(#[from] postcard::Error),
    /// More bytes came by the link in a tick than a controller takes.
    #[error("a message cannot be written: too many bytes from the link")]
    LinkBytes,
}

impl Recording {
    fn create(
        file: &Path,
        format: FileFormat,
        settings: Option<&Settings>,
    ) -> Result<Self, RecordingError> {
        let file = match format {
            FileFormat::Csv => RecordingFile::Csv(Box::new(CsvFile::create(file)?)),
            FileFormat::Mcap => RecordingFile::Mcap(Box::new(McapFile::create(file, settings)?)),
        };
        Ok(Self { file, count: 0 })
    }

    /// Takes a tick of a simulation.
    ///
    /// # Errors
    /// A file that cannot be written.
    pub fn take_tick(&mut self, tick: &Tick<'_>) -> Result<(), RecordingError> {
        match &mut self.file {
            RecordingFile::Mcap(file) => file.take_tick(self.count, tick)?,
            RecordingFile::Csv(file) if self.count.is_multiple_of(ROW_TICKS) => {
                let time_s = f64::from(self.count) * tick_s();
                file.write_row(
                    time_s,
                    &[&to_value(tick.telemetry)?, &to_value(tick.drive)?],
                )?;
            }
            RecordingFile::Csv(_) => {}
        }
        self.count += 1;
        Ok(())
    }

    /// Takes telemetry of a leg. Its time is that of the leg since its board started.
    ///
    /// # Errors
    /// A file that cannot be written.
    pub fn take_telemetry(&mut self, telemetry: &Telemetry<f32>) -> Result<(), RecordingError> {
        let time_s = seconds(telemetry.tick.into());
        match &mut self.file {
            RecordingFile::Mcap(file) => {
                let time_ns = (time_s * 1e9).round() as u64;
                file.write_telemetry(self.count, time_ns, telemetry)?;
            }
            RecordingFile::Csv(file) => file.write_row(time_s, &[&to_value(telemetry)?])?,
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

/// Why there is no recording of some work.
enum NotRecorded {
    File(RecordingError),
    Work(Failure),
}

impl<E: Into<RecordingError>> From<E> for NotRecorded {
    fn from(error: E) -> Self {
        Self::File(error.into())
    }
}

/// Records in `file`, by the extension of its name, while `work` is done; the file is put in its place, whole, when the work
/// is done. A simulation is recorded with its settings, so that it can be replayed; telemetry of a leg without.
///
/// # Errors
/// A [`Failure`]: another extension, a file that cannot be written, or that of the work.
pub fn record<T>(
    file: &Path,
    settings: Option<&Settings>,
    work: impl FnOnce(&mut Recording) -> Result<T, Failure>,
) -> Result<T, Failure> {
    let format = FileFormat::from_name(file)?;
    let done = atomic_file::replace(file, |new| {
        let mut recording = Recording::create(new, format, settings)?;
        let result = work(&mut recording).map_err(NotRecorded::Work)?;
        recording.finish()?;
        Ok(result)
    });
    done.map_err(|error| match error {
        NotRecorded::Work(failure) => failure,
        NotRecorded::File(error) => Failure::refused(
            format!("cannot write {}: {error}", file.display()),
            "name a file in a directory that may be written",
        ),
    })
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum FileFormat {
    Mcap,
    Csv,
}

impl FileFormat {
    fn from_name(file: &Path) -> Result<Self, Failure> {
        match file.extension().and_then(|extension| extension.to_str()) {
            Some("mcap") => Ok(Self::Mcap),
            Some("csv") => Ok(Self::Csv),
            _ => {
                let sentence = format!("{} is no name of a recording", file.display());
                Err(Failure::refused(sentence, "end it with .mcap or .csv"))
            }
        }
    }
}
