//! Recordings of a simulation or of a leg: MCAP, which Foxglove and PlotJuggler open and `leg replay` reproduces, or CSV.

mod csv_file;
mod error;
mod mcap_bytes;
mod mcap_file;

#[cfg(test)]
mod tests;

pub use error::RecordingError;
pub use leg_recording::{About, Recorded, Replay, Samples, TickDifference};

use crate::signals::{LegConstants, Report};
use csv_file::CsvFile;
use leg_base::atomic_file::PartFile;
use leg_base::failure::Failure;
use leg_base::recorder_rows::RecorderRow;
use leg_base::tick_time::{seconds, tick_s};
use leg_firmware::settings::Settings;
use leg_firmware::telemetry::Telemetry;
use leg_recording::{REPLAY_HELP, SAMPLES_HELP};
use leg_sim::simulation::{SAMPLE_TICKS, Tick};
use mcap_file::McapFile;
use std::ffi::OsStr;
use std::path::{Path, PathBuf};

/// Ticks of a simulation between two rows of a table: a row a millisecond.
const ROW_TICKS: u32 = 8;

/// From one time at which a recording is on the disk to the next, s of the recording.
const FLUSH_S: f64 = 1.0;

/// A recording that is being written.
pub struct Recording {
    file: RecordingFile,
    leg: LegConstants,
    /// What was taken so far.
    count: u32,
    /// Up to when the file is on the disk, s of the recording.
    flushed_s: f64,
}

enum RecordingFile {
    Mcap(Box<McapFile>),
    Csv(Box<CsvFile>),
}

impl Recording {
    /// Takes a tick of a simulation.
    pub fn take_tick(&mut self, tick: &Tick<'_>) -> Result<(), RecordingError> {
        match &mut self.file {
            RecordingFile::Mcap(file) => {
                file.writer.write_tick(self.count, tick)?;
                if self.count.is_multiple_of(SAMPLE_TICKS) {
                    let writer = &mut file.writer;
                    writer.write_simulation(self.count, &tick.signals(&self.leg))?;
                }
            }
            RecordingFile::Csv(file) if self.count.is_multiple_of(ROW_TICKS) => {
                file.write_simulation(&tick.signals(&self.leg))?;
            }
            RecordingFile::Csv(_) => {}
        }
        self.taken(f64::from(self.count) * tick_s())
    }

    /// Takes telemetry of a leg, received at a time of the day, s since 1970, if that is known, over a line that has damaged so
    /// many frames. Its own time is that of the leg since its board started.
    pub fn take_telemetry(
        &mut self,
        telemetry: &Telemetry<f32>,
        wall_time_s: Option<f64>,
        damaged_frames: u64,
    ) -> Result<(), RecordingError> {
        let time_s = seconds(telemetry.tick.into());
        let report = Report::new(telemetry, &self.leg);
        let report = report.received(wall_time_s.unwrap_or(f64::NAN), damaged_frames);
        match &mut self.file {
            RecordingFile::Mcap(file) => {
                let time_ns = file.time_ns(wall_time_s, time_s);
                file.writer.write_report(self.count, time_ns, &report)?;
            }
            RecordingFile::Csv(file) => file.write_report(&report)?,
        }
        self.taken(time_s)
    }

    /// Takes a row of a board's recorder, whose tick was at a time of the day, s since 1970, if that is known.
    pub fn take_recorder_row(
        &mut self,
        row: &RecorderRow,
        wall_time_s: Option<f64>,
    ) -> Result<(), RecordingError> {
        let time_s = seconds(row.tick.into());
        match &mut self.file {
            RecordingFile::Mcap(file) => {
                let time_ns = file.time_ns(wall_time_s, time_s);
                file.writer.write_recorder_row(self.count, time_ns, row)?;
            }
            RecordingFile::Csv(file) => file.write_recorder_row(row)?,
        }
        self.taken(time_s)
    }

    /// Counts it, and lets the system have what is older than a second: a program that is killed loses no more.
    fn taken(&mut self, time_s: f64) -> Result<(), RecordingError> {
        self.count += 1;
        let full = matches!(&self.file, RecordingFile::Mcap(file) if file.full());
        // The leg's time may begin again.
        if !full && (0.0..FLUSH_S).contains(&(time_s - self.flushed_s)) {
            return Ok(());
        }
        self.flushed_s = time_s;
        match &mut self.file {
            RecordingFile::Mcap(file) => file.flush(),
            RecordingFile::Csv(file) => file.flush(),
        }
    }

    fn finish(self) -> Result<(), RecordingError> {
        match self.file {
            RecordingFile::Mcap(file) => file.finish(),
            RecordingFile::Csv(mut file) => file.flush(),
        }
    }
}

/// The extension of a recording's name, `mcap` or `csv`.
///
/// # Errors
/// Any other is refused: a [`Failure`] with exit code 2.
pub fn extension(file: &Path) -> Result<&str, Failure> {
    let extension = file.extension().and_then(OsStr::to_str);
    extension
        .filter(|extension| ["mcap", "csv"].contains(extension))
        .ok_or_else(|| {
            let sentence = format!("{} is no name of a recording", file.display());
            Failure::refused(sentence, "end it with .mcap or .csv")
        })
}

/// Records in `file`, by the extension of its name, while `work` is done. Until the work is done the recording is beside it,
/// as `leg.part.mcap`, and can be read: up to its last second, whatever becomes of this program. The leg has these settings.
///
/// # Errors
/// A [`Failure`]: another extension and a file that cannot be written are refused (exit code 2), what was recorded until
/// then is kept; that of the work is passed on as it is, and nothing is kept.
pub fn record<T>(
    file: &Path,
    about: &About,
    settings: &Settings,
    work: impl FnOnce(&mut Recording) -> Result<T, RecordingError>,
) -> Result<T, Failure> {
    let extension = extension(file)?;
    let (part, new) =
        PartFile::create(file).map_err(|error| RecordingError::File(error).failure(file, None))?;
    let done = (|| {
        let file = if extension == "csv" {
            RecordingFile::Csv(Box::new(CsvFile::new(new)))
        } else {
            RecordingFile::Mcap(Box::new(McapFile::new(new, about, settings)?))
        };
        let mut recording = Recording {
            file,
            leg: LegConstants::new(settings),
            count: 0,
            flushed_s: 0.0,
        };
        let result = work(&mut recording)?;
        recording.finish()?;
        Ok(result)
    })();
    match done {
        Ok(result) => {
            let committed = part.commit().map_err(RecordingError::File);
            committed.map_err(|error| error.failure(file, None))?;
            Ok(result)
        }
        Err(error @ RecordingError::File(_)) => Err(error.failure(file, part.keep().ok())),
        Err(error) => Err(error.failure(file, None)),
    }
}

/// Reads a recording, as far as it goes.
///
/// # Errors
/// A file that is no MCAP file of `leg` is refused (exit code 2).
pub fn read_samples(file: &Path) -> Result<Recorded, Failure> {
    leg_recording::read_samples(
        &file.display().to_string(),
        &mcap_bytes::read(file, SAMPLES_HELP)?,
    )
}

/// Replays a recording.
///
/// # Errors
/// One that is no recording of `leg run`, or of other sources, is refused (exit code 2).
pub fn replay(file: &Path) -> Result<Replay, Failure> {
    leg_recording::replay(
        &file.display().to_string(),
        &mcap_bytes::read(file, REPLAY_HELP)?,
    )
}

/// A recording of that name which did not come to its end, or not yet.
#[must_use]
pub fn unfinished(file: &Path) -> Option<PathBuf> {
    PartFile::unfinished(file)
}
