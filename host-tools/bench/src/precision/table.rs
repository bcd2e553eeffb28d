//! The rows of the table.

use super::{DifferenceMeasure, PrecisionRow};
use serde::Serialize;

/// Writes the quantities and their table from one list, so that each quantity has one row, at its own place.
macro_rules! precision_table {
    ($($(#[$doc:meta])* $quantity:ident $name:literal $measure:ident $bound:literal $unit:literal $($reason:expr)?;)*) => {
        /// What is compared. Each has one row in [`TABLE`].
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
        #[serde(rename_all = "snake_case")]
        pub enum CheckedQuantity { $($(#[$doc])* $quantity,)* }

        /// All rows, one for each [`CheckedQuantity`], in its order.
        pub const TABLE: [PrecisionRow; [$(CheckedQuantity::$quantity),*].len()] = [$(PrecisionRow {
            quantity: CheckedQuantity::$quantity,
            name: $name,
            measure: DifferenceMeasure::$measure,
            unit: $unit,
            bound: $bound,
            exception: precision_table!(@exception $($reason)?),
        }),*];
    };
    (@exception) => { None };
    (@exception $reason:expr) => { Some($reason) };
}

precision_table! {
    /// Lengths of the tendons.
    Lengths "lengths" Absolute 2e-8 "m";
    /// The moment map A.
    MomentMap "moment map" Relative 1.2e-6 "relative";
    /// Direction in which the pretension changes the tensions.
    PretensionDirection "pretension direction" Relative 1e-6 "relative";
    /// Moment of the weights.
    LoadMoment "load moment" Relative 1e-6 "relative";
    /// Tensions.
    Tensions "tensions" Relative 4e-6 "relative";
    /// Lowest and highest pretension.
    PretensionRange "pretension range" Relative 2e-6 "relative";
    /// Stiffness.
    Stiffness "stiffness" Relative 2.5e-6 "relative";
    /// K₂, exact.
    K2Exact "K2, exact" Relative 2e-6 "relative";
    /// K₂, as printed.
    K2Printed "K2, printed" Relative 2e-6 "relative";
    /// Displacement of the tip on a support with two freedoms.
    Deviation "deviation" Relative 2.5e-6 "relative";
    /// The same on a ball joint.
    DeviationBallJoint "deviation, ball joint" Relative 7e-6 "relative";
    /// Rotation under the load on a support with two freedoms.
    Rotation "rotation" Relative 2.5e-6 "relative";
    /// The same on a ball joint.
    RotationBallJoint "rotation, ball joint" Relative 3e-5 "relative" SOFT_TORSION;
    /// Lengths of the tendons without tension.
    Unstretched "unstretched lengths" Absolute 2.5e-8 "m" ELONGATION;
    /// Torsion on a universal joint.
    Torsion "torsion" Absolute 1e-7 "rad";
    /// Torsion on a ball joint.
    TorsionBallJoint "torsion, ball joint" Absolute 3e-7 "rad";
    /// Direction found by forward kinematics.
    Direction "forward kinematics" Absolute 1e-6 "rad";
    /// What forward kinematics leaves over.
    Residual "residual of it" Absolute 2.5e-8 "m" TWO_LENGTHS;
    /// Load that measured tensions balance.
    LoadEstimate "load estimate" Absolute 6e-6 "N·m";
    /// Rotation on a ball joint at the direction that forward kinematics found.
    TickRotation "rotation, whole tick" Absolute 3e-7 "rad";
    /// The tip's displacement there.
    TickDisplacement "displacement, whole tick" Absolute 5e-8 "m" NO_SAG;
    /// Moment of an elastic joint.
    JointMoment "joint moment" Absolute 1.5e-6 "N·m";
    /// Stiffness of an elastic joint.
    JointStiffness "joint stiffness" Relative 2e-6 "relative";
    /// Smallest and largest bending stiffness.
    Bending "bending stiffness" Relative 2.5e-6 "relative";
    /// How much longer joint and shaft become.
    AxialStretch "axial stretch" Absolute 4e-11 "m";
    /// Elongation of a tendon with a curve.
    Elongation "elongation on a curve" Relative 2.5e-7 "relative";
    /// Stiffness of a tendon with a curve.
    TendonStiffness "stiffness on a curve" Relative 8e-7 "relative";
    /// Pretension for a demanded stiffness.
    CommandedPretension "commanded pretension" Relative 5e-4 "relative" SEARCH;
    /// The stiffness that it gives.
    CommandedStiffness "commanded stiffness" Relative 2e-4 "relative" SEARCH;
    /// Square root.
    SquareRoot "square root" Relative 1.2e-7 "relative";
    /// Sine and cosine.
    SinCos "sine and cosine" Absolute 2e-7 "absolute";
}

const SEARCH: &str = "the search ends within a ten-thousandth of the demanded stiffness, in f32 elsewhere than in f64";

const SOFT_TORSION: &str = "only the tendons hold a ball joint's torsion, up to 175 times more softly than the tilt, and \
     that magnifies rounding; the tip does not feel it";

const ELONGATION: &str =
    "a soft tendon's elongation of up to 7 mm adds its own rounding to that of the length";

const TWO_LENGTHS: &str =
    "it is the difference of measured and modelled lengths, each within 2e-8 m";

const NO_SAG: &str = "at the vertical the sag vanishes, so the rounding of the direction that forward kinematics found has no \
     sag to be relative to";
