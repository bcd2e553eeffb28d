//! THE precision table: how far the firmware's f32 may be from f64.
//!
//! It holds on the paper's rig over its workspace: any azimuth, tilts to 30°, payloads to 2 kg, pretensions that keep every
//! tension between 8 N and 150 N, tendons of 2e4 to 2e5 N/m, all supports. Both sides get the same arguments: those
//! that f32 can hold. Each bound is two to four times the worst of 100 000 random states, so that a loss of precision
//! shows at once.

mod layout;
mod table;

pub use layout::{Part, evaluation_parts, kernel_parts};
pub use table::TABLE;

use serde::Serialize;

/// What is compared. Each has one row in [`TABLE`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum CheckedQuantity {
    /// Lengths of the tendons.
    Lengths,
    /// The moment map A.
    MomentMap,
    /// Direction in which the pretension changes the tensions.
    PretensionDirection,
    /// Moment of the weights.
    LoadMoment,
    /// Tensions.
    Tensions,
    /// Lowest and highest pretension.
    PretensionRange,
    /// Stiffness.
    Stiffness,
    /// K₂, exact.
    K2Exact,
    /// K₂, as printed.
    K2Printed,
    /// Displacement of the tip on a support with two freedoms.
    Deviation,
    /// The same on a ball joint.
    DeviationBallJoint,
    /// Rotation under the load on a support with two freedoms.
    Rotation,
    /// The same on a ball joint.
    RotationBallJoint,
    /// Lengths of the tendons without tension.
    Unstretched,
    /// Torsion on a universal joint.
    Torsion,
    /// Torsion on a ball joint.
    TorsionBallJoint,
    /// Direction found by forward kinematics.
    Direction,
    /// What forward kinematics leaves over.
    Residual,
    /// Load that measured tensions balance.
    LoadEstimate,
    /// Rotation on a ball joint at the direction that forward kinematics found.
    TickRotation,
    /// The tip's displacement there.
    TickDisplacement,
    /// Moment of an elastic joint.
    JointMoment,
    /// Stiffness of an elastic joint.
    JointStiffness,
    /// Smallest and largest bending stiffness.
    Bending,
    /// How much longer joint and shaft become.
    AxialStretch,
    /// Elongation of a tendon with a curve.
    Elongation,
    /// Stiffness of a tendon with a curve.
    TendonStiffness,
    /// Pretension for a demanded stiffness.
    CommandedPretension,
    /// The stiffness that it gives.
    CommandedStiffness,
    /// Square root.
    SquareRoot,
    /// Sine and cosine.
    SinCos,
}

/// How a difference is measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Measure {
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
    pub measure: Measure,
    /// The unit of the bound; "relative" or "absolute" where there is none.
    pub unit: &'static str,
    /// The largest difference that is allowed.
    pub bound: f64,
    /// Why the bound is wider than that of its kind.
    pub exception: Option<&'static str>,
}

impl PrecisionRow {
    /// The row with a bound `factor` times as tight.
    #[must_use]
    pub fn tightened(self, factor: f64) -> Self {
        let bound = self.bound / factor;
        Self { bound, ..self }
    }

    /// How far an array is from its reference. What is missing or not a number is infinitely far.
    #[must_use]
    pub fn difference(&self, found: &[f64], expected: &[f64]) -> f64 {
        if found.len() != expected.len() {
            return f64::INFINITY;
        }
        let scale = match self.measure {
            Measure::Absolute => 1.0,
            Measure::Relative => largest(expected.iter().map(|entry| entry.abs())),
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
    use super::{CheckedQuantity, Measure, PrecisionRow, TABLE};

    const ROW: PrecisionRow = PrecisionRow {
        quantity: CheckedQuantity::Lengths,
        name: "",
        measure: Measure::Relative,
        unit: "",
        bound: 1.0,
        exception: None,
    };

    #[test]
    fn entries_are_judged_beside_the_largest() {
        assert_eq!(ROW.difference(&[0.5, -4.0], &[0.0, -4.0]), 0.125);
        let absolute = PrecisionRow {
            measure: Measure::Absolute,
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

    #[test]
    fn each_quantity_has_one_row() {
        for (i, row) in TABLE.iter().enumerate() {
            assert_eq!(row.quantity as usize, i, "{}", row.name);
        }
        assert_eq!(TABLE.len(), CheckedQuantity::SinCos as usize + 1);
    }
}
