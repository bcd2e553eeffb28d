//! Paths as rows of text: `time_s,azimuth_deg,tilt_deg`, with `pretension_n` or `stiffness_nm_per_rad` where that changes, from a file or a
//! program.

use csv::{ReaderBuilder, StringRecord};
use leg_base::failure::Failure;
use leg_base::text_input::{Line, next_line, too_long};
use leg_base::timed_path::{PathBuilder, PathRow, TimedPoint};
use leg_firmware::set_point::StreamTension;
use serde::Deserialize;
use std::collections::VecDeque;
use std::io::{BufRead, ErrorKind};
use std::sync::mpsc::{Receiver, TryRecvError, sync_channel};
use std::thread;

/// Rows of a program that wait to be followed.
const ROWS_MAX: usize = 1024;

/// The longest path, s: within half of the leg's count of ticks.
const LONGEST_S: f64 = 2e5;

/// What is said of a path that is refused.
const HELP: &str = "give rows as `0.01,45,20` under the header `time_s,azimuth_deg,tilt_deg`, the times rising; `pretension_n` and \
     `stiffness_nm_per_rad` may be further columns";

/// What a header may name; the first three it has to.
const COLUMNS: [&str; 5] = [
    "time_s",
    "azimuth_deg",
    "tilt_deg",
    "pretension_n",
    "stiffness_nm_per_rad",
];

/// A row as it is written.
#[derive(Debug, Deserialize)]
struct RowText {
    time_s: f64,
    azimuth_deg: f64,
    tilt_deg: f64,
    pretension_n: Option<f64>,
    stiffness_nm_per_rad: Option<f64>,
}

impl RowText {
    /// What it asks of the tendons; the values are checked already.
    fn tension(&self) -> Option<StreamTension> {
        let pretension = |value| StreamTension::Pretension(value as f32);
        let stiffness = |value| StreamTension::Stiffness(value as f32);
        let asked = self.pretension_n.map(pretension);
        asked.or(self.stiffness_nm_per_rad.map(stiffness))
    }
}

/// What is read of these, N and N·m/rad: the leg says what it can reach.
const PRETENSION_N: [f64; 2] = [0.0, 1e5];
const STIFFNESS_NM_PER_RAD: [f64; 2] = [1e-3, 1e6];

/// Reads a path row by row.
pub struct PathReader<R> {
    input: R,
    name: String,
    /// None before the first line.
    header: Option<StringRecord>,
    line: u64,
    first_s: Option<f64>,
    last_s: f64,
}

impl<R: BufRead> PathReader<R> {
    /// A path from the first line on; `name` is what messages call it.
    pub fn new(input: R, name: &str) -> Self {
        Self {
            input,
            name: name.into(),
            header: None,
            line: 0,
            first_s: None,
            last_s: f64::NEG_INFINITY,
        }
    }

    /// The next row; none at the end.
    ///
    /// # Errors
    /// What is wrong with its line.
    pub fn next_row(&mut self) -> Result<Option<PathRow>, Failure> {
        while let Some(record) = self.next_record()? {
            let Some(header) = &self.header else {
                self.check_header(&record)?;
                self.header = Some(record);
                continue;
            };
            if record.len() != header.len() {
                let counts = (record.len(), header.len());
                let what = format!("{} columns, and the header has {}", counts.0, counts.1);
                return Err(self.refused(&what));
            }
            let row = record.deserialize(Some(header));
            let row = row.map_err(|error| self.refused(&row_error(&error, header, &record)))?;
            return self.row(row).map(Some);
        }
        Ok(None)
    }

    /// The next line that is not empty.
    fn next_record(&mut self) -> Result<Option<StringRecord>, Failure> {
        loop {
            let line = next_line(&mut self.input).map_err(|error| {
                let (name, number) = (&self.name, self.line + 1);
                match error.kind() {
                    ErrorKind::InvalidData => Failure::refused(
                        format!("cannot read line {number} of {name}: {error}"),
                        "give a point in each line, ended by a newline",
                    ),
                    _ => Failure::refused(
                        format!("cannot read {name}: {error}"),
                        "give a file that may be read",
                    ),
                }
            })?;
            self.line += 1;
            let line = match line {
                None => return Ok(None),
                Some(Line::TooLong) => return Err(self.refused(&too_long())),
                Some(Line::Whole(line)) => line,
            };
            let mut reader = ReaderBuilder::new()
                .has_headers(false)
                .trim(csv::Trim::All)
                .from_reader(line.as_slice());
            match reader.records().next() {
                None => {}
                Some(record) => {
                    return record
                        .map(Some)
                        .map_err(|error| self.refused(&text_error(&error)));
                }
            }
        }
    }

    fn check_header(&self, header: &StringRecord) -> Result<(), Failure> {
        for column in &COLUMNS[..3] {
            if !header.iter().any(|name| name == *column) {
                return Err(self.refused(&format!("the header has no column {column}")));
            }
        }
        for (i, name) in header.iter().enumerate() {
            let number = i + 1;
            if !COLUMNS.contains(&name) {
                return Err(self.refused(&format!("column {number}, `{name}`, is not known")));
            }
            if header.iter().take(i).any(|before| before == name) {
                return Err(self.refused(&format!("column {number}, {name}, is there twice")));
            }
        }
        Ok(())
    }

    /// The number of the last line that was read, from 1.
    #[must_use]
    pub const fn line(&self) -> u64 {
        self.line
    }

    fn row(&mut self, text: RowText) -> Result<PathRow, Failure> {
        let tension = text.tension();
        let RowText {
            time_s,
            azimuth_deg,
            tilt_deg,
            pretension_n,
            stiffness_nm_per_rad,
        } = text;
        if pretension_n.is_some() && stiffness_nm_per_rad.is_some() {
            return Err(self
                .refused("it gives both pretension_n and stiffness_nm_per_rad; give one of them"));
        }
        for (name, value, [least, most]) in [
            ("time_s", Some(time_s), [-1e9, 1e9]),
            ("azimuth_deg", Some(azimuth_deg), [-1e6, 1e6]),
            ("tilt_deg", Some(tilt_deg), [-90.0, 90.0]),
            ("pretension_n", pretension_n, PRETENSION_N),
            (
                "stiffness_nm_per_rad",
                stiffness_nm_per_rad,
                STIFFNESS_NM_PER_RAD,
            ),
        ] {
            if let Some(value) = value
                && !(least..=most).contains(&value)
            {
                return Err(
                    self.refused(&format!("{name} = {value} is not from {least} to {most}"))
                );
            }
        }
        let first_s = *self.first_s.get_or_insert(time_s);
        if time_s - first_s > LONGEST_S {
            return Err(self.refused(&format!("the path is longer than {LONGEST_S} s")));
        }
        if time_s <= self.last_s {
            let sentence = format!("time_s = {time_s} is not after {}", self.last_s);
            return Err(self.refused(&sentence));
        }
        self.last_s = time_s;
        Ok(PathRow {
            tension,
            ..PathRow::from_angles(time_s, azimuth_deg, tilt_deg)
        })
    }

    fn refused(&self, what: &str) -> Failure {
        Failure::refused(format!("{}, line {}: {what}", self.name, self.line), HELP)
    }
}

/// What is wrong with a line as a text, with the column.
fn text_error(error: &csv::Error) -> String {
    match error.kind() {
        csv::ErrorKind::Utf8 { err, .. } => format!("column {} is no UTF-8", err.field() + 1),
        _ => error.to_string(),
    }
}

/// What is wrong with a row of numbers, with the column.
fn row_error(error: &csv::Error, header: &StringRecord, row: &StringRecord) -> String {
    let field = match error.kind() {
        csv::ErrorKind::Deserialize { err, .. } => err.field(),
        _ => None,
    };
    let column = field.and_then(|field| usize::try_from(field).ok());
    let cell = column.and_then(|column| Some((column, header.get(column)?, row.get(column)?)));
    match cell {
        Some((column, name, text)) => {
            format!("column {}, {name}: `{text}` is no number", column + 1)
        }
        None => error.to_string(),
    }
}

/// What there is next of a path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PathStep {
    /// A point.
    Point(TimedPoint),
    /// None yet.
    Wait,
    /// None any more.
    End,
}

/// A path whose points come one after the other.
pub struct PathSource {
    points: VecDeque<TimedPoint>,
    live: Option<(PathBuilder, Receiver<Result<PathRow, Failure>>)>,
}

impl PathSource {
    /// Points that are all known.
    pub fn whole(points: Vec<TimedPoint>) -> Self {
        Self {
            points: points.into(),
            live: None,
        }
    }

    /// Rows as a program writes them. They are read by a thread of its own: the leg hears from its host meanwhile.
    pub fn live<R: BufRead + Send + 'static>(mut reader: PathReader<R>) -> Self {
        let (sender, receiver) = sync_channel(ROWS_MAX);
        thread::spawn(move || {
            while let Some(row) = reader.next_row().transpose() {
                let failed = row.is_err();
                if sender.send(row).is_err() || failed {
                    break;
                }
            }
        });
        Self {
            points: VecDeque::new(),
            live: Some((PathBuilder::default(), receiver)),
        }
    }

    /// The next point.
    ///
    /// # Errors
    /// A row that is refused.
    pub fn next_step(&mut self) -> Result<PathStep, Failure> {
        loop {
            if let Some(point) = self.points.pop_front() {
                return Ok(PathStep::Point(point));
            }
            let Some((builder, rows)) = &mut self.live else {
                return Ok(PathStep::End);
            };
            match rows.try_recv() {
                Ok(row) => self.points.extend(builder.push(row?)),
                Err(TryRecvError::Empty) => return Ok(PathStep::Wait),
                Err(TryRecvError::Disconnected) => {
                    self.points.extend(builder.finish());
                    self.live = None;
                }
            }
        }
    }
}

#[cfg(test)]
mod tests;
