//! The path of a file, with the line of each of its rows.

use leg_base::failure::Failure;
use leg_base::refusal::point_description;
use leg_base::timed_path::TimedPath;
use leg_host::operator::OperatorError;
use leg_host::path_reader::PathReader;
use std::fs::File;
use std::io::BufReader;
use std::path::Path;

/// The most rows of a path that is checked as a whole: an hour and more at 200 Hz.
const ROWS_MAX: usize = 1_000_000;

/// A path that is known to its end.
pub(super) struct PathFile {
    name: String,
    path: TimedPath,
    /// The line of each of its points.
    lines: Vec<u64>,
}

impl PathFile {
    pub(super) fn read(path: &Path) -> Result<Self, Failure> {
        let name = path.display().to_string();
        let file = File::open(path).map_err(|error| {
            let sentence = format!("cannot read the path {name}: {error}");
            Failure::refused(sentence, "give a file that exists, or - for standard input")
        })?;
        let mut reader = PathReader::new(BufReader::new(file), &name);
        let (mut rows, mut lines) = (Vec::new(), Vec::new());
        while let Some(row) = reader.next_row()? {
            rows.push(row);
            lines.push(reader.line());
            if rows.len() > ROWS_MAX {
                return Err(Failure::refused(
                    format!("the path {name} has more than {ROWS_MAX} rows"),
                    "stream it: `leg follow - < FILE`",
                ));
            }
        }
        if rows.is_empty() {
            return Err(Failure::refused(
                format!("the path {name} has no rows"),
                "give one or more, below a line with the names of the columns",
            ));
        }
        let path = TimedPath::new(&rows);
        Ok(Self { name, path, lines })
    }

    pub(super) const fn path(&self) -> &TimedPath {
        &self.path
    }

    /// The same error; that of a point with the line of the row to which it leads.
    pub(super) fn placed(&self, error: OperatorError) -> OperatorError {
        let OperatorError::Point(time_s, refusal) = error else {
            return error;
        };
        let points = self.path.points();
        let row = points.partition_point(|point| point.time_s < time_s);
        let Some(line) = self.lines.get(row).or(self.lines.last()) else {
            return error;
        };
        let [reason, remedy] = point_description(time_s, refusal);
        let sentence = format!("{}, line {line}: {reason}", self.name);
        OperatorError::Path(Failure::refused(sentence, remedy))
    }
}
