//! The rows of a tensile test, from a CSV file whose header names the units.

use super::TensileError;
use csv::{ReaderBuilder, StringRecord, Trim};
use std::path::Path;

const FORCES: [(&str, f64); 2] = [("force_n", 1.0), ("force_kn", 1e3)];
const ELONGATIONS: [(&str, f64); 3] = [
    ("elongation_mm", 1e-3),
    ("elongation_um", 1e-6),
    ("elongation_m", 1.0),
];

/// A row of a test.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Row {
    /// Its line in the file.
    pub line: u64,
    /// N.
    pub force_n: f64,
    /// m.
    pub elongation_m: f64,
}

/// The rows of a test, in their order.
#[derive(Clone, Debug, PartialEq)]
pub struct TensileTest {
    /// All rows.
    pub rows: Vec<Row>,
}

/// Where a quantity is, and what its unit is in SI.
#[derive(Clone, Copy)]
struct Column {
    index: usize,
    scale: f64,
}

/// Reads a file. Lines that begin with `#` are comments.
///
/// # Errors
/// A [`TensileError`] with line and column.
pub fn read(path: &Path) -> Result<TensileTest, TensileError> {
    let unreadable = |error| TensileError::Unreadable {
        path: path.into(),
        error,
    };
    let mut reader = ReaderBuilder::new()
        .comment(Some(b'#'))
        .trim(Trim::All)
        .from_path(path)
        .map_err(unreadable)?;
    let header = reader.headers().map_err(unreadable)?;
    let (force, elongation) = columns(header)?;
    let mut rows = Vec::new();
    for record in reader.records() {
        let record = record.map_err(unreadable)?;
        let line = record.position().map_or(0, csv::Position::line);
        rows.push(Row {
            line,
            force_n: number(&record, line, force)?,
            elongation_m: number(&record, line, elongation)?,
        });
    }
    Ok(TensileTest { rows })
}

fn columns(header: &StringRecord) -> Result<(Column, Column), TensileError> {
    let (mut forces, mut elongations) = (Vec::new(), Vec::new());
    for (index, name) in header.iter().enumerate() {
        let known = |units: &[(&str, f64)]| {
            let unit = units.iter().find(|(known, _)| *known == name);
            unit.map(|&(_, scale)| Column { index, scale })
        };
        match (known(&FORCES), known(&ELONGATIONS)) {
            (Some(force), _) => forces.push(force),
            (_, Some(elongation)) => elongations.push(elongation),
            _ => return Err(unknown(index + 1, name)),
        }
    }
    Ok((one("force", &forces)?, one("elongation", &elongations)?))
}

fn unknown(column: usize, name: &str) -> TensileError {
    let name = name.to_owned();
    let quantity = name.split('_').next().unwrap_or_default();
    let units = match quantity {
        "force" => "force_n or force_kn",
        "elongation" => "elongation_mm, elongation_um or elongation_m",
        _ => return TensileError::UnknownColumn { column, name },
    };
    TensileError::UnknownUnit {
        column,
        name,
        units,
    }
}

fn one(quantity: &'static str, columns: &[Column]) -> Result<Column, TensileError> {
    match columns {
        [column] => Ok(*column),
        _ => Err(TensileError::Columns {
            quantity,
            found: columns.len(),
        }),
    }
}

fn number(record: &StringRecord, line: u64, column: Column) -> Result<f64, TensileError> {
    let text = record.get(column.index).unwrap_or_default();
    let place = column.index + 1;
    if text.is_empty() {
        return Err(TensileError::Hole {
            line,
            column: place,
        });
    }
    match text.parse::<f64>() {
        Ok(number) if number.is_finite() => Ok(number * column.scale),
        _ => Err(TensileError::NotANumber {
            line,
            column: place,
            text: text.into(),
        }),
    }
}
