//! The rows of the table.

use super::{Quantity, Row};
use crate::precision::Measure;

/// All rows, one for each [`Quantity`], in its order.
pub const TABLE: [Row; 23] = [
    absolute(Quantity::Lengths, "lengths", 2e-8, "m"),
    relative(Quantity::MomentMap, "moment map", 1e-6),
    relative(Quantity::PretensionDirection, "pretension direction", 1e-6),
    relative(Quantity::LoadMoment, "load moment", 1e-6),
    relative(Quantity::Tensions, "tensions", 1e-5),
    relative(Quantity::LevelRange, "level range", 1e-5),
    relative(Quantity::Stiffness, "stiffness", 1e-5),
    relative(Quantity::K2Exact, "exact K2", 1e-5),
    relative(Quantity::K2Printed, "printed K2", 1e-5),
    relative(Quantity::Deviation, "deviation", 1e-5),
    relative(Quantity::DeviationBallJoint, "deviation, ball joint", 1e-5),
    relative(Quantity::Rotation, "rotation", 1e-5),
    relative(Quantity::RotationBallJoint, "rotation, ball joint", 1e-5),
    absolute(Quantity::Unstretched, "unstretched lengths", 2e-8, "m"),
    absolute(Quantity::Torsion, "torsion", 1e-6, "rad"),
    absolute(
        Quantity::TorsionBallJoint,
        "torsion, ball joint",
        1e-6,
        "rad",
    ),
    absolute(Quantity::Direction, "forward kinematics", 1e-6, "rad"),
    absolute(Quantity::Residual, "its residual", 2e-8, "m"),
    absolute(Quantity::LoadEstimate, "load estimate", 1e-5, "N·m"),
    absolute(Quantity::TickRotation, "rotation, whole tick", 1e-6, "rad"),
    absolute(
        Quantity::TickDisplacement,
        "displacement, whole tick",
        1e-6,
        "m",
    ),
    relative(Quantity::SquareRoot, "square root", 1e-7),
    absolute(Quantity::SinCos, "sine and cosine", 1e-7, "1"),
];

/// A row whose bound is a part of the largest entry.
const fn relative(quantity: Quantity, name: &'static str, bound: f64) -> Row {
    Row {
        quantity,
        name,
        measure: Measure::Relative,
        unit: "relative",
        bound,
        exception: None,
    }
}

/// A row whose bound has a unit.
const fn absolute(quantity: Quantity, name: &'static str, bound: f64, unit: &'static str) -> Row {
    Row {
        measure: Measure::Absolute,
        unit,
        ..relative(quantity, name, bound)
    }
}
