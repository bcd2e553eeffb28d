//! From a tensile test to the curve of a tendon.

mod branches;
mod fit;
mod hysteresis;
mod read;
#[cfg(test)]
mod tests;

pub use fit::Fit;
pub use hysteresis::Hysteresis;
pub use read::{Row, TensileTest, read};

use std::path::PathBuf;

/// Why a tensile test gives no curve.
#[derive(Debug, thiserror::Error)]
pub enum TensileError {
    /// The file cannot be read.
    #[error("cannot read {}: {error}", path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// What the reader says.
        error: csv::Error,
    },
    /// The header names a column that is not known.
    #[error(
        "line 1, column {column}: `{name}` is no known column; name force_n or force_kn, and elongation_mm, elongation_um or elongation_m"
    )]
    UnknownColumn {
        /// Which one, counted from 1.
        column: usize,
        /// What it is called.
        name: String,
    },
    /// A known quantity in a unit that is not known.
    #[error("line 1, column {column}: the unit of `{name}` is not known; give {units}")]
    UnknownUnit {
        /// Which one, counted from 1.
        column: usize,
        /// What it is called.
        name: String,
        /// The units that are.
        units: &'static str,
    },
    /// The header has not exactly one column for a quantity.
    #[error("line 1 names {found} columns for the {quantity}; give one")]
    Columns {
        /// Force or elongation.
        quantity: &'static str,
        /// How many.
        found: usize,
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
    /// Too few rows of the loading branch.
    #[error("the loading branch has {found} taut rows; give at least three, or a lower --taut-n")]
    TooFewRows {
        /// How many it has.
        found: usize,
    },
    /// The points make no curve.
    #[error("the rows make no curve: {0}; check the units of the header")]
    NoCurve(leg_model::Error),
}
