//! The rows of a tensile test, from a CSV file whose header names the units.

use super::{TensileError, faulty};
use csv::{ErrorKind, Position, ReaderBuilder, StringRecord, Trim};
use leg_base::text_input;
use std::path::Path;

/// The longest file: an hour at 400 rows a second.
const BYTES_MAX: u64 = 32 << 20;

/// A measured quantity and the units it may have in the header.
struct Known {
    quantity: &'static str,
    /// The columns' names with their units in SI.
    columns: &'static [(&'static str, f64)],
    /// The names in words.
    names: &'static str,
}

const FORCE: Known = Known {
    quantity: "force",
    columns: &[("force_n", 1.0), ("force_kn", 1e3)],
    names: "force_n or force_kn",
};

const ELONGATION: Known = Known {
    quantity: "elongation",
    columns: &[
        ("elongation_mm", 1e-3),
        ("elongation_um", 1e-6),
        ("elongation_m", 1.0),
    ],
    names: "elongation_mm, elongation_um or elongation_m",
};

/// A row of a test.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TestRow {
    /// Its line in the file.
    pub line: u64,
    /// N.
    pub force_n: f64,
    /// m.
    pub elongation_m: f64,
}

/// Where a quantity is, and what its unit is in SI.
#[derive(Clone, Copy)]
struct Column {
    index: usize,
    scale: f64,
}

/// Reads the rows of a file, in their order. Lines that begin with `#` are comments.
///
/// # Errors
/// A [`TensileError`] with line and column.
pub fn read(path: &Path) -> Result<Vec<TestRow>, TensileError> {
    let text = text_input::read_file(path, BYTES_MAX)?;
    let (data, lines) = data_lines(&text);
    let mut reader = ReaderBuilder::new()
        .trim(Trim::All)
        .from_reader(data.as_bytes());
    let header = reader.headers()?;
    let [force, elongation] = columns(header, lines.number(header.position()))?;
    let mut rows = Vec::new();
    for record in reader.records() {
        let record = record.map_err(|error| lines.place_error(error))?;
        let line = lines.number(record.position());
        rows.push(TestRow {
            line,
            force_n: number(&record, line, force)?,
            elongation_m: number(&record, line, elongation)?,
        });
    }
    Ok(rows)
}

/// The lines of the file that hold data, and where each of them is: the CSV reader's own count is off after a comment.
fn data_lines(text: &str) -> (String, LineNumbers) {
    let text = text.trim_start_matches('\u{feff}');
    let data = (1..)
        .zip(text.lines())
        .filter(|(_, line)| !line.trim().is_empty() && !line.starts_with('#'));
    let (numbers, lines): (Vec<u64>, Vec<&str>) = data.unzip();
    (lines.join("\n"), LineNumbers(numbers))
}

/// The file's line numbers of the lines that are read.
struct LineNumbers(Vec<u64>);

impl LineNumbers {
    fn number(&self, place: Option<&Position>) -> u64 {
        let index = place.map_or(0, |place| place.line().saturating_sub(1) as usize);
        self.0.get(index).copied().unwrap_or(1)
    }

    fn place_error(&self, error: csv::Error) -> TensileError {
        match error.kind() {
            ErrorKind::UnequalLengths {
                pos,
                expected_len,
                len,
            } => {
                let problem = format!(
                    "{len} fields under a header of {expected_len}; give one each, with a point in decimals and no comma"
                );
                faulty(self.number(pos.as_ref()), None, problem)
            }
            _ => error.into(),
        }
    }
}

fn columns(header: &StringRecord, line: u64) -> Result<[Column; 2], TensileError> {
    let mut found = [FORCE, ELONGATION].map(|known| (known, Vec::new()));
    for (index, name) in header.iter().enumerate() {
        let column = found.iter_mut().find_map(|(known, columns)| {
            let &(_, scale) = known.columns.iter().find(|(unit, _)| *unit == name)?;
            Some((columns, Column { index, scale }))
        });
        match column {
            Some((columns, column)) => columns.push(column),
            None => return Err(unknown(line, index + 1, name)),
        }
    }
    let [force, elongation] = found.map(|(known, columns)| match columns[..] {
        [column] => Ok(column),
        _ => {
            let (found, quantity, names) = (columns.len(), known.quantity, known.names);
            let problem =
                format!("the header names {found} columns for the {quantity}; give one, {names}");
            Err(faulty(line, None, problem))
        }
    });
    Ok([force?, elongation?])
}

fn unknown(line: u64, column: usize, name: &str) -> TensileError {
    if name.contains([';', '\t']) {
        let problem = format!("`{name}` is one column; separate columns by commas");
        return faulty(line, None, problem);
    }
    let quantity = name.split('_').next().unwrap_or_default();
    let mut known = [FORCE, ELONGATION].into_iter();
    let problem = match known.find(|known| known.quantity == quantity) {
        None => format!(
            "`{name}` is no known column; leave it out, and name {}, and {}",
            FORCE.names, ELONGATION.names
        ),
        Some(known) => format!("the unit of `{name}` is not known; give {}", known.names),
    };
    faulty(line, Some(column), problem)
}

fn number(record: &StringRecord, line: u64, column: Column) -> Result<f64, TensileError> {
    let text = record.get(column.index).unwrap_or_default();
    let number = text.parse::<f64>().ok().filter(|number| number.is_finite());
    let problem = match number.map(|number| number * column.scale) {
        Some(number) if number.is_finite() => return Ok(number),
        Some(_) => format!(
            "`{text}` is too large in newtons or metres; check it and the unit of its column"
        ),
        None if text.is_empty() => {
            "nothing is there; give the value, or leave the whole row out".into()
        }
        None => format!("`{text}` is no finite number; write one such as 12.5"),
    };
    Err(faulty(line, Some(column.index + 1), problem))
}
