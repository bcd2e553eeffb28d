//! The precision table: how far the firmware's f32 may be from f64.
//!
//! It holds on the paper's rig over its workspace: any azimuth, tilts to 30°, payloads to 2 kg, pretensions that keep every
//! tension between 8 N and 150 N, tendons of 2e4 to 2e5 N/m, all supports. Both sides get the same arguments: those
//! that f32 can hold. Each bound is two to four times the worst of 100 000 random states, so that a loss of precision
//! shows at once.

mod layout;
mod table;

pub use layout::{Part, evaluation_parts, kernel_parts};
pub use table::{CheckedQuantity, TABLE};

use serde::Serialize;

/// How a difference is measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum DifferenceMeasure {
    /// The largest difference of an entry, in the quantity's unit.
    Absolute,
    /// The largest difference of an entry, divided by the largest entry of its array.
    Relative,
}

/// A row of the table.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct PrecisionRow {
    /// What is compared.
    pub quantity: CheckedQuantity,
    /// Its name for people.
    pub name: &'static str,
    /// How it is compared.
    pub measure: DifferenceMeasure,
    /// The unit of the bound; "relative" or "absolute" where there is none.
    pub unit: &'static str,
    /// The largest difference that is allowed.
    pub bound: f64,
    /// Why the bound is wider than that of its kind.
    pub exception: Option<&'static str>,
}

impl PrecisionRow {
    /// How far an array is from its reference. What is missing or not a number is infinitely far.
    #[must_use]
    pub fn difference(&self, found: &[f64], expected: &[f64]) -> f64 {
        if found.len() != expected.len() {
            return f64::INFINITY;
        }
        let scale = match self.measure {
            DifferenceMeasure::Absolute => 1.0,
            DifferenceMeasure::Relative => largest(expected.iter().map(|entry| entry.abs())),
        };
        let largest = largest(found.iter().zip(expected).map(|(a, b)| (a - b).abs()));
        if largest == 0.0 { 0.0 } else { largest / scale }
    }
}

/// The largest of some magnitudes; infinite if one is not a number.
fn largest(magnitudes: impl Iterator<Item = f64>) -> f64 {
    magnitudes.fold(0.0, |largest, next| {
        if next.is_nan() {
            f64::INFINITY
        } else {
            largest.max(next)
        }
    })
}

#[cfg(test)]
mod tests {
    use super::{CheckedQuantity, DifferenceMeasure, PrecisionRow};

    const ROW: PrecisionRow = PrecisionRow {
        quantity: CheckedQuantity::Lengths,
        name: "",
        measure: DifferenceMeasure::Relative,
        unit: "",
        bound: 1.0,
        exception: None,
    };

    #[test]
    fn entries_are_judged_beside_the_largest() {
        assert_eq!(ROW.difference(&[0.5, -4.0], &[0.0, -4.0]), 0.125);
        let absolute = PrecisionRow {
            measure: DifferenceMeasure::Absolute,
            ..ROW
        };
        assert_eq!(absolute.difference(&[0.5, -4.0], &[0.0, -4.0]), 0.5);
    }

    #[test]
    fn what_vanishes_on_both_sides_is_equal_and_what_is_missing_is_far() {
        assert_eq!(ROW.difference(&[0.0], &[0.0]), 0.0);
        assert_eq!(ROW.difference(&[1.0], &[0.0]), f64::INFINITY);
        assert_eq!(ROW.difference(&[f64::NAN], &[1.0]), f64::INFINITY);
        assert_eq!(ROW.difference(&[], &[1.0]), f64::INFINITY);
    }
}
