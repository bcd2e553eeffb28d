//! Recordings of a simulation: MCAP, which Foxglove and PlotJuggler open and `leg replay` reproduces, or CSV.

mod csv_file;
mod mcap_file;
mod replay;
mod telemetry_channel;
mod telemetry_file;
mod tick_record;

pub use replay::{Replay, ReplayError, replay};
pub use telemetry_file::{TelemetryFile, around_telemetry};

use csv_file::CsvFile;
use leg_base::atomic_file;
use leg_base::failure::Failure;
use leg_firmware::settings::Settings;
use leg_sim::simulation::Tick;
use mcap_file::McapFile;
use std::path::Path;

/// Something that takes every tick of a simulation.
pub enum Recorder {
    /// As MCAP.
    Mcap(Box<McapFile>),
    /// As CSV.
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
    /// A message has no form.
    #[error("a message cannot be written: {0}")]
    Form(String),
}

impl Recorder {
    fn create(file: &Path, format: Format, settings: &Settings) -> Result<Self, RecordingError> {
        Ok(match format {
            Format::Csv => Self::Csv(Box::new(CsvFile::create(file)?)),
            Format::Mcap => Self::Mcap(Box::new(McapFile::create(file, settings)?)),
        })
    }

    /// Takes a tick.
    ///
    /// # Errors
    /// A file that cannot be written.
    pub fn take(&mut self, tick: &Tick<'_>) -> Result<(), RecordingError> {
        match self {
            Self::Mcap(file) => file.take(tick),
            Self::Csv(file) => file.take(tick),
        }
    }

    fn finish(self) -> Result<(), RecordingError> {
        match self {
            Self::Mcap(mut file) => file.finish(),
            Self::Csv(mut file) => file.finish(),
        }
    }
}

/// Why a recorded work is not done.
enum Stopped {
    Recording(RecordingError),
    Work(Failure),
}

impl From<std::io::Error> for Stopped {
    fn from(error: std::io::Error) -> Self {
        Self::Recording(error.into())
    }
}

/// Does `work` while it is recorded in `file`, as its ending says. The file is put in its place, whole, when the work is
/// done.
///
/// # Errors
/// A [`Failure`]: another ending, a file that cannot be written, or that of the work.
pub fn around<T>(
    file: &Path,
    settings: &Settings,
    work: impl FnOnce(&mut Recorder) -> Result<T, Failure>,
) -> Result<T, Failure> {
    whole(
        file,
        |new, format| Recorder::create(new, format, settings),
        work,
        Recorder::finish,
    )
}

/// Makes a recorder, does the work and finishes the recorder; the file is then put in its place.
fn whole<R, T>(
    file: &Path,
    create: impl FnOnce(&Path, Format) -> Result<R, RecordingError>,
    work: impl FnOnce(&mut R) -> Result<T, Failure>,
    finish: impl FnOnce(R) -> Result<(), RecordingError>,
) -> Result<T, Failure> {
    let format = Format::of(file)?;
    let done = atomic_file::replace(file, |new| {
        let mut recorder = create(new, format).map_err(Stopped::Recording)?;
        let result = work(&mut recorder).map_err(Stopped::Work)?;
        finish(recorder).map_err(Stopped::Recording)?;
        Ok(result)
    });
    done.map_err(|stopped| match stopped {
        Stopped::Work(failure) => failure,
        Stopped::Recording(error) => Failure::refused(
            format!("cannot write {}: {error}", file.display()),
            "name a file in a directory that may be written",
        ),
    })
}

/// What a file is written as.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Format {
    Mcap,
    Csv,
}

impl Format {
    /// By the ending of the file's name.
    fn of(file: &Path) -> Result<Self, Failure> {
        match file.extension().and_then(|ending| ending.to_str()) {
            Some("mcap") => Ok(Self::Mcap),
            Some("csv") => Ok(Self::Csv),
            _ => {
                let sentence = format!("{} is no name of a recording", file.display());
                Err(Failure::refused(sentence, "end it with .mcap or .csv"))
            }
        }
    }
}

#[cfg(test)]
mod tests;
