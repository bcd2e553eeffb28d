//! What a leg tells over its line, as MCAP or CSV.

use super::csv_file::{row, value};
use super::telemetry_channel::TelemetryChannel;
use super::{Format, RecordingError, whole};
use leg_base::failure::Failure;
use leg_base::tick_time::seconds;
use leg_firmware::telemetry::Telemetry;
use mcap::{WriteOptions, Writer};
use std::fs::File;
use std::io::BufWriter;
use std::path::Path;

/// A recording of telemetry that is being written.
pub struct TelemetryFile {
    sink: Sink,
    count: u32,
}

enum Sink {
    Mcap(Box<Writer<BufWriter<File>>>, TelemetryChannel),
    Csv(Box<csv::Writer<File>>),
}

impl TelemetryFile {
    fn create(file: &Path, format: Format) -> Result<Self, RecordingError> {
        let sink = match format {
            Format::Csv => Sink::Csv(Box::new(csv::Writer::from_path(file)?)),
            Format::Mcap => {
                let options = WriteOptions::new().compression(None).library("leg");
                let writer = options.create(BufWriter::new(File::create(file)?))?;
                Sink::Mcap(Box::new(writer), TelemetryChannel::default())
            }
        };
        Ok(Self { sink, count: 0 })
    }

    /// Takes what the leg tells. Its time is that of the leg since its board started.
    ///
    /// # Errors
    /// A file that cannot be written.
    pub fn take(&mut self, telemetry: &Telemetry<f32>) -> Result<(), RecordingError> {
        let time_s = seconds(telemetry.tick.into());
        match &mut self.sink {
            Sink::Mcap(writer, channel) => {
                let time_ns = (time_s * 1e9).round() as u64;
                channel.write(writer, self.count, time_ns, telemetry)?;
            }
            Sink::Csv(writer) => {
                let columns = row(time_s, &[&value(telemetry)?]);
                if self.count == 0 {
                    writer.write_record(columns.iter().map(|(name, _)| name))?;
                }
                writer.write_record(columns.iter().map(|(_, value)| value))?;
            }
        }
        self.count += 1;
        Ok(())
    }

    fn finish(self) -> Result<(), RecordingError> {
        match self.sink {
            Sink::Mcap(mut writer, _) => {
                writer.finish()?;
            }
            Sink::Csv(mut writer) => writer.flush()?,
        }
        Ok(())
    }
}

/// Does `work` while it writes telemetry to `file`, as its ending says. The file is put in its place, whole, when the work
/// is done.
///
/// # Errors
/// A [`Failure`]: another ending, a file that cannot be written, or that of the work.
pub fn around_telemetry<T>(
    file: &Path,
    work: impl FnOnce(&mut TelemetryFile) -> Result<T, Failure>,
) -> Result<T, Failure> {
    whole(file, TelemetryFile::create, work, TelemetryFile::finish)
}
