//! Everything the model can refuse, each refusal with a name.

use core::fmt;

/// A quantity that a caller hands to the model.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "schema", derive(postcard_schema::Schema))]
#[non_exhaustive]
pub enum Quantity {
    /// Anchors on the base plate, m.
    BaseAnchors,
    /// Anchors on the leg's plate, m.
    LegAnchors,
    /// From the base plate down to the joint centre, m.
    UpperLength,
    /// From the joint centre down to the leg's plate, m.
    JointLength,
    /// From the leg's plate down to the tip, m.
    LegLength,
    /// Mass of the leg, kg.
    LegMass,
    /// From the joint centre down to the leg's centroid, m.
    LegCentroid,
    /// Gravity, m/s².
    Gravity,
    /// Azimuth, rad.
    Azimuth,
    /// Tilt, rad.
    Tilt,
    /// Payload at the tip, kg.
    Payload,
    /// Pretension, N.
    Pretension,
    /// Lowest tension allowed, N.
    TensionMin,
    /// Highest tension allowed, N.
    TensionMax,
    /// Stiffness of a tendon, N/m.
    TendonStiffness,
    /// Tendon length, m.
    TendonLength,
    /// A unit vector along the leg.
    Direction,
    /// Tension of a tendon, N.
    Tension,
    /// Elongation of a tendon, m.
    Elongation,
    /// The points of a tendon's curve.
    TendonCurve,
    /// Bending stiffness of the joint, N·m/rad.
    JointBending,
    /// Torsion stiffness of the joint, N·m/rad.
    JointTorsion,
    /// Axial compliance of joint and shaft, m/N.
    AxialCompliance,
    /// A demanded bending stiffness of the leg, N·m/rad.
    BendingStiffness,
    /// Azimuth of a demanded bending stiffness, rad.
    DemandAzimuth,
    /// Free length of a flexure, m.
    FlexureLength,
    /// Width of a flexure, m.
    FlexureWidth,
    /// Thickness or diameter of a flexure, m.
    FlexureThickness,
    /// Radius of a notch, m.
    NotchRadius,
    /// Distance between the two flexures of a pair, m.
    FlexureSpacing,
    /// Young's modulus of a flexure, Pa.
    YoungsModulus,
    /// Shear modulus of a flexure, Pa.
    ShearModulus,
    /// The strain to which a flexure's material is linear.
    StrainLimit,
}

/// What is wrong with a refused quantity.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "schema", derive(postcard_schema::Schema))]
#[non_exhaustive]
pub enum Reason {
    /// It is infinite or not a number.
    NotFinite,
    /// It has to be greater than zero.
    NotPositive,
    /// It must not be below zero.
    Negative,
    /// It is beyond the range in which the model holds.
    OutOfRange,
    /// The points lie on one line, so they cannot hold the leg.
    Collinear,
    /// The lowest allowed value is above the highest.
    AboveMax,
    /// It is below the lowest allowed tension or above the highest.
    OutsideBounds,
    /// It is beyond what the tendon's curve knows.
    BeyondCurve,
    /// Its first point is not at zero tension and zero elongation.
    NotFromZero,
    /// A point has not both more tension and more elongation than the one before.
    NotRising,
    /// Between two points it would turn back.
    NotMonotone,
    /// It has too few points.
    TooFew,
    /// It has too many points.
    TooMany,
    /// The support allows no such motion.
    Blocked,
    /// It is too small beside the flexure's thickness for the formulas of slender beams.
    NotSlender,
    /// It is outside the range in which the formula has been confirmed.
    OutsideFormula,
    /// At the greatest tilt the flexure is strained beyond it.
    Exceeded,
}

/// Why the model gives no result.
///
/// Only one variant has fields, so that an error takes two bytes: the fast path writes one at every exit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "schema", derive(postcard_schema::Schema))]
#[non_exhaustive]
pub enum Error {
    /// An argument is refused.
    Refused {
        /// Which one.
        quantity: Quantity,
        /// What is wrong with it.
        reason: Reason,
    },
    /// A tendon has no length at this pose: its two anchors meet.
    TendonCollapsed,
    /// The tendons cannot turn the leg about both of its free axes (under a load that is finite).
    Singular,
    /// No pretension keeps every tension inside its bounds at this pose under this load.
    Infeasible,
    /// The stiffness is not positive: the leg would buckle at this pose under this load.
    Unstable,
    /// An iteration ended without a solution.
    NotConverged,
}

impl Error {
    pub(crate) const fn refused(quantity: Quantity, reason: Reason) -> Self {
        Self::Refused { quantity, reason }
    }
}

impl fmt::Display for Reason {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::NotFinite => "must be a finite number",
            Self::NotPositive => "must be greater than zero",
            Self::Negative => "must not be negative",
            Self::OutOfRange => "is beyond the range in which the model holds",
            Self::Collinear => "must not lie on one line",
            Self::OutsideBounds => "must be from the lowest tension allowed to the highest",
            Self::AboveMax => "must not be above the highest tension",
            Self::BeyondCurve => "is beyond the last point of the tendon's curve",
            Self::NotFromZero => "must start at zero tension and zero elongation",
            Self::NotRising => "must rise in tension and in elongation from point to point",
            Self::NotMonotone => {
                "must not turn back between two points: the stiffness at one of them is less than a third of the average between them"
            }
            Self::TooFew => "must have at least two points",
            Self::TooMany => "must have at most 16 points",
            Self::NotSlender => "is too small beside the thickness for the formulas of slender beams",
            Self::OutsideFormula => "is outside the formula's range",
            Self::Exceeded => "is exceeded when the flexure is bent to the greatest tilt",
            Self::Blocked => "must be zero: this support allows no such motion",
        })
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Refused { quantity, reason } => write!(f, "{quantity:?} {reason}"),
            Self::TendonCollapsed => f.write_str("a tendon has no length at this pose"),
            Self::Singular => {
                f.write_str("the tendons cannot turn the leg about both of its free axes")
            }
            Self::Infeasible => f.write_str("no pretension keeps every tension inside its bounds"),
            Self::Unstable => f.write_str("the stiffness is not positive: the leg would buckle"),
            Self::NotConverged => f.write_str("the iteration ended without a solution"),
        }
    }
}

impl core::error::Error for Error {}
