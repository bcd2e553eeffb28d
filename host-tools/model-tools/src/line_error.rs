//! Why a line of `leg eval`'s input has no result, in words.

use leg_model::{Error, Quantity, Reason};
use leg_rig::support_name::UnknownSupport;

/// Why a line has no result.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum LineError {
    /// It is not one JSON object.
    #[error("not a JSON object: {0}; `leg eval --help` lists the keys of one")]
    NotAnObject(String),
    /// It is too long to be a pose.
    #[error("{}: write one pose a line", leg_base::text_input::too_long())]
    TooLong,
    /// A key that the contract does not have.
    #[error("unknown key `{key}`: {remedy}")]
    UnknownKey {
        /// The key.
        key: String,
        /// What to write instead.
        remedy: String,
    },
    /// The same key twice.
    #[error("`{0}` is given twice: give it once")]
    Repeated(String),
    /// A key that every line has to give.
    #[error("missing key `{0}`: add it, the rig file has no value for it")]
    MissingKey(&'static str),
    /// The value of this key is no number.
    #[error("`{key}` has to be a number, not {found}: write a number such as 1.5")]
    NotANumber {
        /// The key.
        key: &'static str,
        /// What the value is instead.
        found: &'static str,
    },
    /// The value of this key, a number, is too large for a float.
    #[error("`{0}` must be a finite number, {1} is too large: give a smaller one")]
    NotFinite(&'static str, String),
    /// The value of this key is no string.
    #[error("`{key}` has to be a string in quotes, not {found}: `leg eval --help` lists the words")]
    NotAWord {
        /// The key.
        key: &'static str,
        /// What the value is instead.
        found: &'static str,
    },
    /// An elastic support that the rig file does not describe.
    #[error(
        "the rig file describes the support `{described}`, not `{asked}`: give a rig file with --rig that does, `leg rig list` names some"
    )]
    NotInRigFile {
        /// What the line asks for.
        asked: &'static str,
        /// What the rig file has.
        described: &'static str,
    },
    /// A direction without a demand.
    #[error("`demand_towards_deg` is given without a demand: add `demand_nm_per_rad`")]
    NoDemand,
    /// A reading of the stiffness that does not exist.
    #[error("`stiffness_at` cannot be `{0}`: write `pretension` or `tension`")]
    StiffnessAt(String),
    /// A support that does not exist.
    #[error("{0}: {fix}", fix = .0.help())]
    Support(UnknownSupport),
    /// The model refuses a value.
    #[error("{name} {1}{remedy}", name = name_of(*.0), remedy = remedy_of(*.0, *.1))]
    Refused(Quantity, Reason),
    /// The model has no result at the pose.
    #[error("no result: {0}: {remedy}", remedy = pose_remedy(*.0))]
    NoResult(Error),
}

impl From<Error> for LineError {
    fn from(error: Error) -> Self {
        match error {
            Error::Refused { quantity, reason } => Self::Refused(quantity, reason),
            _ => Self::NoResult(error),
        }
    }
}

/// The key in quotes, or words where no key gives the quantity itself.
fn name_of(quantity: Quantity) -> String {
    match quantity {
        Quantity::Tension => "the tension of a tendon at this pretension".into(),
        Quantity::Elongation => "the elongation of a tendon under this load".into(),
        _ => format!("`{}`", key_of(quantity)),
    }
}

/// The key that gives a quantity. Those that only a rig file gives were accepted with the file, unless f32 cannot
/// hold them.
fn key_of(quantity: Quantity) -> &'static str {
    match quantity {
        Quantity::Azimuth => "azimuth_deg",
        Quantity::Tilt => "tilt_deg",
        Quantity::Payload => "payload_kg",
        Quantity::Pretension => "level_n",
        Quantity::TendonStiffness => "stiffness_n_per_m",
        Quantity::TensionMin => "f_min_n",
        Quantity::TensionMax => "f_max_n",
        Quantity::LegMass => "leg_mass_kg",
        Quantity::UpperLength => "l_upper_m",
        Quantity::BaseAnchors => "base_anchors_mm",
        Quantity::LegAnchors => "leg_anchors_mm",
        Quantity::JointLength => "joint_mm",
        Quantity::LegLength => "leg_mm",
        Quantity::LegCentroid => "centroid_mm",
        Quantity::Gravity => "gravity_m_per_s2",
        Quantity::TendonLength => "tendon length",
        Quantity::Direction => "direction",
        Quantity::Tension | Quantity::Elongation => "level_n",
        Quantity::TendonCurve => "curve",
        Quantity::BendingStiffness => "demand_nm_per_rad",
        Quantity::DemandAzimuth => "demand_towards_deg",
        _ => "support",
    }
}

/// What to add to a reason that does not say by itself what to give.
fn remedy_of(quantity: Quantity, reason: Reason) -> &'static str {
    match (quantity, reason) {
        (Quantity::Tilt, Reason::OutOfRange) => ": give -60 to 60",
        (Quantity::BendingStiffness, Reason::OutOfRange) => ": give more than 0 to 1e6",
        (Quantity::Azimuth | Quantity::DemandAzimuth, Reason::OutOfRange) => ": give -3600 to 3600",
        (_, Reason::NotFinite) => " in f32: give at most 3.4e38",
        (Quantity::Payload, Reason::OutOfRange) => ": give 0 to 1e6",
        (Quantity::TendonStiffness, Reason::OutOfRange) => ": give 0.01 to 1e10",
        (Quantity::TensionMin | Quantity::TensionMax, Reason::OutOfRange) => ": give 0 to 1e7",
        (Quantity::Pretension, Reason::OutOfRange) => ": give -1e7 to 1e7",
        (_, Reason::BeyondCurve) => ": give a lower `level_n`, or a constant `stiffness_n_per_m`",
        (_, Reason::AboveMax) => ": give at most `f_max_n`",
        _ => "",
    }
}

fn pose_remedy(error: Error) -> &'static str {
    match error {
        Error::Unstable => "give stiffer tendons or a smaller payload",
        _ => "give another pose or another rig",
    }
}
