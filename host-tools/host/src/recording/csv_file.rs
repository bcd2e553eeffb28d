//! A recording as CSV: what the leg tells, a thousand rows a second, units in the names of the columns.

use super::RecordingError;
use leg_base::tick_time::tick_s;
use leg_sim::simulation::Tick;
use serde::Serialize;
use serde_json::Value;
use std::fs::File;
use std::path::Path;

/// Ticks between two rows.
const ROW_TICKS: u64 = 8;

/// A recording that is being written.
pub struct CsvFile {
    writer: csv::Writer<File>,
    count: u64,
}

impl CsvFile {
    pub(super) fn create(file: &Path) -> Result<Self, RecordingError> {
        Ok(Self {
            writer: csv::Writer::from_path(file)?,
            count: 0,
        })
    }

    pub(super) fn take(&mut self, tick: &Tick<'_>) -> Result<(), RecordingError> {
        if self.count.is_multiple_of(ROW_TICKS) {
            let columns = columns(self.count as f64 * tick_s(), tick)?;
            if self.count == 0 {
                self.writer
                    .write_record(columns.iter().map(|(name, _)| name))?;
            }
            self.writer
                .write_record(columns.iter().map(|(_, value)| value))?;
        }
        self.count += 1;
        Ok(())
    }

    pub(super) fn finish(&mut self) -> Result<(), RecordingError> {
        self.writer.flush()?;
        Ok(())
    }
}

/// Names and values of a row.
fn columns(time_s: f64, tick: &Tick<'_>) -> Result<Row, RecordingError> {
    let (telemetry, drive) = (value(tick.telemetry)?, value(tick.drive)?);
    Ok(row(time_s, &[&telemetry, &drive]))
}

/// Names and values.
pub(super) type Row = Vec<(String, String)>;

/// What something is in JSON.
pub(super) fn value<T: Serialize>(value: &T) -> Result<Value, RecordingError> {
    serde_json::to_value(value).map_err(|error| RecordingError::Form(error.to_string()))
}

/// The time and every value of some objects.
pub(super) fn row(time_s: f64, objects: &[&Value]) -> Row {
    let mut columns = vec![("time_s".into(), time_s.to_string())];
    for object in objects {
        if let Value::Object(map) = object {
            for (name, value) in map {
                flatten(name.clone(), value.clone(), &mut columns);
            }
        }
    }
    columns
}

/// The three of a list are counted from 1, as tendons are.
fn flatten(name: String, value: Value, columns: &mut Row) {
    match value {
        Value::Array(values) => {
            for (number, value) in (1..).zip(values) {
                flatten(format!("{name}_{number}"), value, columns);
            }
        }
        Value::String(text) => columns.push((name, text)),
        value => columns.push((name, value.to_string())),
    }
}
