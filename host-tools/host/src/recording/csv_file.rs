//! A recording as CSV: the time, and each single value in a column of its own, units in the names of the columns. `csv`
//! itself writes no nested lists.

use super::RecordingError;
use crate::flat_json::flatten;
use serde_json::Value;
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

    pub fn write_row(&mut self, time_s: f64, objects: &[&Value]) -> Result<(), RecordingError> {
        let columns = || objects.iter().flat_map(|object| flatten(object, "_"));
        if !std::mem::replace(&mut self.named, true) {
            let names = columns().map(|(name, _)| name);
            self.writer
                .write_record(std::iter::once("time_s".into()).chain(names))?;
        }
        let texts = columns().map(|(_, value)| match value {
            Value::String(text) => text.clone(),
            Value::Null => String::new(),
            value => value.to_string(),
        });
        self.writer
            .write_record(std::iter::once(time_s.to_string()).chain(texts))?;
        Ok(())
    }

    pub fn flush(&mut self) -> Result<(), RecordingError> {
        Ok(self.writer.flush()?)
    }
}
