//! From a tensile test to the curve of a tendon.

mod branches;
mod fit;
mod hysteresis;
mod knots;
mod read;
mod spline;
#[cfg(test)]
mod tests;

pub use fit::Fit;
pub use hysteresis::Hysteresis;
pub use read::{Row, TensileTest, read};

/// Why a tensile test gives no curve.
#[derive(Debug, thiserror::Error)]
pub enum TensileError {
    /// The file cannot be read.
    #[error("cannot be read: {0}; give a CSV file in UTF-8")]
    Unreadable(#[from] std::io::Error),
    /// The text is no CSV.
    #[error("is no CSV: {0}")]
    NotCsv(#[from] csv::Error),
    /// Columns that are not separated by commas.
    #[error("line {line}: `{header}` is one column; separate columns by commas")]
    Separator {
        /// The line of the file.
        line: u64,
        /// What is there.
        header: String,
    },
    /// A row with more or fewer fields than the header.
    #[error(
        "line {line}: {found} fields under a header of {wanted}; give one each, with a point in decimals and no comma"
    )]
    Fields {
        /// The line of the file.
        line: u64,
        /// How many it has.
        found: u64,
        /// How many the header has.
        wanted: u64,
    },
    /// The header names a column that is not known.
    #[error(
        "line {line}, column {column}: `{name}` is no known column; leave it out, and name force_n or force_kn, and elongation_mm, elongation_um or elongation_m"
    )]
    UnknownColumn {
        /// The line of the file.
        line: u64,
        /// Which one, counted from 1.
        column: usize,
        /// What it is called.
        name: String,
    },
    /// A known quantity in a unit that is not known.
    #[error("line {line}, column {column}: the unit of `{name}` is not known; give {units}")]
    UnknownUnit {
        /// The line of the file.
        line: u64,
        /// Which one, counted from 1.
        column: usize,
        /// What it is called.
        name: String,
        /// The units that are.
        units: &'static str,
    },
    /// The header has not exactly one column for a quantity.
    #[error("line {line}: the header names {found} columns for the {quantity}; give one, {units}")]
    Columns {
        /// The line of the file.
        line: u64,
        /// Force or elongation.
        quantity: &'static str,
        /// How many.
        found: usize,
        /// The names that are known.
        units: &'static str,
    },
    /// An empty field.
    #[error(
        "line {line}, column {column}: nothing is there; give the value, or leave the whole row out"
    )]
    Hole {
        /// The line of the file.
        line: u64,
        /// The column, counted from 1.
        column: usize,
    },
    /// A field that is no finite number.
    #[error("line {line}, column {column}: `{text}` is no finite number; write one such as 12.5")]
    NotANumber {
        /// The line of the file.
        line: u64,
        /// The column, counted from 1.
        column: usize,
        /// What is there.
        text: String,
    },
    /// A field that overflows in SI units.
    #[error(
        "line {line}, column {column}: `{text}` is too large in newtons or metres; check it and the unit of its column"
    )]
    TooLarge {
        /// The line of the file.
        line: u64,
        /// The column, counted from 1.
        column: usize,
        /// What is there.
        text: String,
    },
    /// No row under tension, and some under compression.
    #[error(
        "no force is above zero, the first below is on line {line}: this is a test in compression, which a tendon does not bear, or its signs are reversed; give a pull as a positive force"
    )]
    Compression {
        /// The line of the file.
        line: u64,
    },
    /// Two rows of a branch at one force.
    #[error(
        "line {line}: the force is that of line {before}; keep one row for each force, for example their mean"
    )]
    SameForce {
        /// The line of the file.
        line: u64,
        /// The row before it.
        before: u64,
    },
    /// A row that goes backwards on its branch.
    #[error(
        "line {line}: the {quantity} goes backwards from line {before} while the tendon is {branch}; average rows until force and elongation change together"
    )]
    Backwards {
        /// The line of the file.
        line: u64,
        /// The row before it.
        before: u64,
        /// Force or elongation.
        quantity: &'static str,
        /// What the test does there.
        branch: &'static str,
    },
    /// A force that changes alone.
    #[error(
        "line {line}: the elongation is that of line {before} while the force changes; keep rows farther apart than the elongation is resolved"
    )]
    Standing {
        /// The line of the file.
        line: u64,
        /// The row before it.
        before: u64,
    },
    /// Too few rows of the loading branch.
    #[error("the loading branch has {found} taut rows; give at least three, or a lower --taut-n")]
    TooFewRows {
        /// How many it has.
        found: usize,
    },
    /// Rows that differ by next to nothing.
    #[error("the rows settle no curve; give rows whose forces are farther apart")]
    TooNear,
    /// The points make no curve.
    #[error("the rows make no curve: {0}; check the units of the header")]
    NoCurve(leg_model::Error),
}
