//! Everything the model can refuse, each refusal with a name.

use core::fmt;

/// A quantity that a caller hands to the model.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize, postcard_schema::Schema)
)]
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
    /// Level of pretension, N.
    Level,
    /// Lowest tension allowed, N.
    TensionFloor,
    /// Highest tension allowed, N.
    TensionCeiling,
    /// Stiffness of a tendon, N/m.
    TendonStiffness,
    /// Tendon length, m.
    TendonLength,
    /// A unit vector along the leg.
    Direction,
    /// Tension of a tendon, N.
    Tension,
}

/// What is wrong with a refused quantity.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize, postcard_schema::Schema)
)]
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
    AboveCeiling,
}

/// Why the model gives no result.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize, postcard_schema::Schema)
)]
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
            Self::AboveCeiling => "must not be above the highest tension",
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
            Self::Unstable => f.write_str("the stiffness is not positive: the leg would buckle"),
            Self::NotConverged => f.write_str("the iteration ended without a solution"),
        }
    }
}

impl core::error::Error for Error {}
