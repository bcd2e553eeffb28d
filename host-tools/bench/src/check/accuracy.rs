//! The worst difference of each quantity, and where it is.

use super::{CheckedState, Pose};
use crate::precision::{Part, PrecisionRow};
use serde::Serialize;

/// A row of the precision table, and whether it passed.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct RowReport {
    /// The row.
    #[serde(flatten)]
    pub row: PrecisionRow,
    /// The largest difference; infinite (in JSON null) where the firmware has no number.
    pub worst: f64,
    /// Where that is; none before anything was compared.
    pub at: Option<Pose>,
    /// Whether something was compared and all of it lay within the bound.
    pub passed: bool,
}

/// The worst so far.
#[derive(Clone, Debug)]
pub struct Accuracy(Vec<RowReport>);

impl Accuracy {
    /// Nothing compared yet.
    #[must_use]
    pub fn new(table: &[PrecisionRow]) -> Self {
        let report = |&row| RowReport {
            row,
            worst: 0.0,
            at: None,
            passed: false,
        };
        Self(table.iter().map(report).collect())
    }

    /// Compares the numbers of one reply, part by part.
    pub fn add(&mut self, parts: &[Part], found: &[f64], expected: &[f64], state: &CheckedState) {
        let mut first = 0;
        for &(quantity, count) in parts {
            let numbers = first..first + count;
            first += count;
            let rows = self.0.iter_mut();
            for report in rows.filter(|report| Some(report.row.quantity) == quantity) {
                // A refusal leaves no numbers, and is far from the reference's.
                let found = found.get(numbers.clone()).unwrap_or_default();
                let expected = expected.get(numbers.clone()).unwrap_or_default();
                report.add(report.row.difference(found, expected), state);
            }
        }
    }

    /// The rows.
    #[must_use]
    pub fn into_rows(self) -> Vec<RowReport> {
        self.0
    }
}

impl RowReport {
    fn add(&mut self, difference: f64, state: &CheckedState) {
        if self.at.is_none() || difference > self.worst {
            self.worst = difference;
            self.at = Some(state.pose());
        }
        self.passed = self.worst <= self.row.bound;
    }
}
