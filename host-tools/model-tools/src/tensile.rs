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
pub use read::{TestRow, read};

/// Why a tensile test gives no curve.
#[derive(Debug, thiserror::Error)]
pub enum TensileError {
    /// The file cannot be read.
    #[error("cannot be read: {0}; give a CSV file in UTF-8")]
    Unreadable(#[from] std::io::Error),
    /// The text is no CSV.
    #[error("is no CSV: {0}")]
    NotCsv(#[from] csv::Error),
    /// A line of the file is wrong.
    #[error("line {line}{}: {problem}", column.map_or_else(String::new, |column| format!(", column {column}")))]
    Faulty {
        /// The line of the file.
        line: u64,
        /// The column, counted from 1, if one of them is at fault.
        column: Option<usize>,
        /// What is wrong, and what to do.
        problem: String,
    },
    /// No row under tension, and some under compression, the first on this line.
    #[error(
        "no force is above zero, the first below is on line {0}: this is a test in compression, which a tendon does not bear, or its signs are reversed; give a pull as a positive force"
    )]
    Compression(u64),
    /// The loading branch has too few rows: so many.
    #[error("the loading branch has {0} taut rows; give at least three, or a lower --taut-n")]
    TooFewRows(usize),
    /// Rows that differ by next to nothing.
    #[error("the rows settle no curve; give rows whose forces are farther apart")]
    TooNear,
    /// The points make no curve.
    #[error("the rows make no curve: {0}; check the units of the header")]
    NoCurve(leg_model::Error),
}

/// A line that is wrong.
fn faulty(line: u64, column: Option<usize>, problem: String) -> TensileError {
    TensileError::Faulty {
        line,
        column,
        problem,
    }
}
