//! A recording as CSV: the signals, each single number in a column of its own.

use super::RecordingError;
use crate::signals::{
    RECORDER_SIGNALS, REPORT_SIGNALS, Report, SIMULATED_SIGNALS, Simulated, columns, row,
};
use leg_base::recorder_rows::RecorderRow;
use std::fs::File;

/// A table that is being written; its first row names the columns.
pub(super) struct CsvFile {
    writer: csv::Writer<File>,
    named: bool,
}

impl CsvFile {
    pub fn new(file: File) -> Self {
        Self {
            writer: csv::Writer::from_writer(file),
            named: false,
        }
    }

    pub fn write_report(&mut self, report: &Report) -> Result<(), RecordingError> {
        if !std::mem::replace(&mut self.named, true) {
            self.writer.write_record(columns(REPORT_SIGNALS))?;
        }
        Ok(self.writer.write_record(row(REPORT_SIGNALS, report))?)
    }

    pub fn write_simulation(
        &mut self,
        (report, simulated): &(Report, Simulated),
    ) -> Result<(), RecordingError> {
        if !std::mem::replace(&mut self.named, true) {
            let names = columns(REPORT_SIGNALS).chain(columns(SIMULATED_SIGNALS));
            self.writer.write_record(names)?;
        }
        let cells = row(REPORT_SIGNALS, report).chain(row(SIMULATED_SIGNALS, simulated));
        Ok(self.writer.write_record(cells)?)
    }

    pub fn write_recorder_row(&mut self, row_of: &RecorderRow) -> Result<(), RecordingError> {
        if !std::mem::replace(&mut self.named, true) {
            self.writer.write_record(columns(RECORDER_SIGNALS))?;
        }
        Ok(self.writer.write_record(row(RECORDER_SIGNALS, row_of))?)
    }

    pub fn flush(&mut self) -> Result<(), RecordingError> {
        Ok(self.writer.flush()?)
    }
}
