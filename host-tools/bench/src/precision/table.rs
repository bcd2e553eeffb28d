//! The rows of the table.

use super::{CheckedQuantity, Measure, PrecisionRow};

/// All rows, one for each [`CheckedQuantity`], in its order.
pub const TABLE: [PrecisionRow; 31] = [
    absolute(CheckedQuantity::Lengths, "lengths", 2e-8, "m"),
    relative(CheckedQuantity::MomentMap, "moment map", 1.2e-6),
    relative(
        CheckedQuantity::PretensionDirection,
        "pretension direction",
        1e-6,
    ),
    relative(CheckedQuantity::LoadMoment, "load moment", 1e-6),
    relative(CheckedQuantity::Tensions, "tensions", 4e-6),
    relative(CheckedQuantity::PretensionRange, "pretension range", 2e-6),
    relative(CheckedQuantity::Stiffness, "stiffness", 2.5e-6),
    relative(CheckedQuantity::K2Exact, "K2, exact", 2e-6),
    relative(CheckedQuantity::K2Printed, "K2, printed", 2e-6),
    relative(CheckedQuantity::Deviation, "deviation", 2.5e-6),
    relative(
        CheckedQuantity::DeviationBallJoint,
        "deviation, ball joint",
        7e-6,
    ),
    relative(CheckedQuantity::Rotation, "rotation", 2.5e-6),
    relative(
        CheckedQuantity::RotationBallJoint,
        "rotation, ball joint",
        3e-5,
    )
    .because(SOFT_TORSION),
    absolute(
        CheckedQuantity::Unstretched,
        "unstretched lengths",
        2.5e-8,
        "m",
    )
    .because(ELONGATION),
    absolute(CheckedQuantity::Torsion, "torsion", 1e-7, "rad"),
    absolute(
        CheckedQuantity::TorsionBallJoint,
        "torsion, ball joint",
        3e-7,
        "rad",
    ),
    absolute(
        CheckedQuantity::Direction,
        "forward kinematics",
        1e-6,
        "rad",
    ),
    absolute(CheckedQuantity::Residual, "residual of it", 2.5e-8, "m").because(TWO_LENGTHS),
    absolute(CheckedQuantity::LoadEstimate, "load estimate", 6e-6, "N·m"),
    absolute(
        CheckedQuantity::TickRotation,
        "rotation, whole tick",
        3e-7,
        "rad",
    ),
    absolute(
        CheckedQuantity::TickDisplacement,
        "displacement, whole tick",
        5e-8,
        "m",
    )
    .because(NO_SAG),
    absolute(CheckedQuantity::JointMoment, "joint moment", 1.5e-6, "N·m"),
    relative(CheckedQuantity::JointStiffness, "joint stiffness", 2e-6),
    relative(CheckedQuantity::Bending, "bending stiffness", 2.5e-6),
    absolute(CheckedQuantity::AxialStretch, "axial stretch", 4e-11, "m"),
    relative(CheckedQuantity::Elongation, "elongation on a curve", 2.5e-7),
    relative(
        CheckedQuantity::TendonStiffness,
        "stiffness on a curve",
        8e-7,
    ),
    relative(
        CheckedQuantity::CommandedPretension,
        "commanded pretension",
        5e-4,
    )
    .because(SEARCH),
    relative(
        CheckedQuantity::CommandedStiffness,
        "commanded stiffness",
        2e-4,
    )
    .because(SEARCH),
    relative(CheckedQuantity::SquareRoot, "square root", 1.2e-7),
    absolute(CheckedQuantity::SinCos, "sine and cosine", 2e-7, "absolute"),
];

const SEARCH: &str = "the search ends within a ten-thousandth of the demanded stiffness, in f32 elsewhere than in f64";

const SOFT_TORSION: &str = "only the tendons hold a ball joint's torsion, up to 175 times more softly than the tilt, and \
     that magnifies rounding; the tip does not feel it";

const ELONGATION: &str =
    "a soft tendon's elongation of up to 7 mm adds its own rounding to that of the length";

const TWO_LENGTHS: &str =
    "it is the difference of measured and modelled lengths, each within 2e-8 m";

const NO_SAG: &str = "at the vertical the sag vanishes, so the rounding of the direction that forward kinematics found has no \
     sag to be relative to";

/// A row whose bound is a part of the largest entry.
const fn relative(quantity: CheckedQuantity, name: &'static str, bound: f64) -> PrecisionRow {
    PrecisionRow {
        quantity,
        name,
        measure: Measure::Relative,
        unit: "relative",
        bound,
        exception: None,
    }
}

/// A row whose bound has a unit.
const fn absolute(
    quantity: CheckedQuantity,
    name: &'static str,
    bound: f64,
    unit: &'static str,
) -> PrecisionRow {
    PrecisionRow {
        measure: Measure::Absolute,
        unit,
        ..relative(quantity, name, bound)
    }
}

impl PrecisionRow {
    const fn because(self, reason: &'static str) -> Self {
        Self {
            exception: Some(reason),
            ..self
        }
    }
}
