//! What can be wrong with a rig file or a scenario's sections that are read alike, in words.

use crate::fields::plain;
use crate::support_name::UnknownSupport;
use leg_model::Reason;
use std::ops::Range;

/// A refusal and the bytes of the text that it means.
#[derive(Clone, Debug, PartialEq)]
pub struct Fault {
    /// The bytes.
    pub span: Range<usize>,
    /// What is wrong with them.
    pub problem: Problem,
}

/// What can be wrong with a rig file.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Problem {
    /// It is no TOML.
    #[error("not TOML: {0}")]
    Syntax(String),
    /// A key that no reader takes.
    #[error("unknown key `{key}`")]
    UnknownKey {
        /// The key.
        key: String,
        /// The fix.
        fix: String,
    },
    /// A key is not there.
    #[error("missing key `{0}`")]
    MissingKey(&'static str),
    /// A section is not there.
    #[error("missing section `[{0}]`")]
    MissingSection(&'static str),
    /// A value has another type.
    #[error("`{key}` has to be {wanted}, this is a TOML {found}")]
    WrongType {
        /// The key.
        key: &'static str,
        /// What the file takes.
        wanted: &'static str,
        /// The TOML type found.
        found: &'static str,
    },
    /// A number is infinite or not a number.
    #[error("`{0}` must be a finite number")]
    NotFinite(&'static str),
    /// Not as many anchors as the leg has tendons.
    #[error("`{key}` has {found} anchors: the leg has three tendons")]
    AnchorCount {
        /// The key.
        key: &'static str,
        /// How many the file gives.
        found: usize,
    },
    /// No support has this name.
    #[error(transparent)]
    Support(UnknownSupport),
    /// A word that is none of the choices.
    #[error("`{key}` cannot be `{found}`")]
    Choice {
        /// The key.
        key: &'static str,
        /// What the file says.
        found: String,
        /// What it may say.
        choices: &'static str,
    },
    /// Two keys that give the same thing.
    #[error("`{0}` and `{1}` cannot both be given")]
    Both(&'static str, &'static str),
    /// Arrays that belong together are of different lengths.
    #[error("`{key}` has {found} entries, `{other}` has {wanted}")]
    Count {
        /// The key.
        key: &'static str,
        /// How many it has.
        found: usize,
        /// The key beside it.
        other: &'static str,
        /// How many that one has.
        wanted: usize,
    },
    /// An array of another length than it has to be.
    #[error("`{key}` has {found} entries, it takes {wanted}")]
    Entries {
        /// The key.
        key: &'static str,
        /// How many it has.
        found: usize,
        /// How many it takes.
        wanted: usize,
    },
    /// A value outside its range.
    #[error("`{key}` is outside {} to {}", plain(range[0]), plain(range[1]))]
    OutsideRange {
        /// The key.
        key: &'static str,
        /// Lowest and highest value.
        range: [f64; 2],
        /// What the value means.
        meaning: &'static str,
    },
    /// Values that are sensible each, but make up something that is not.
    #[error("{what} comes out as {found}")]
    Outcome {
        /// What they make up.
        what: &'static str,
        /// Its value and its range.
        found: Box<str>,
        /// The keys that make it up.
        keys: &'static str,
    },
    /// A value that has to be below another.
    #[error("{low} has to be below {high}")]
    NotBelow {
        /// The one, with its value.
        low: Box<str>,
        /// The other, with its value.
        high: Box<str>,
        /// Why.
        reason: &'static str,
    },
    /// A point of a tendon's curve that cannot be.
    #[error("point {point} of the curve {reason}")]
    Curve {
        /// Which point, counted from 1.
        point: usize,
        /// What is wrong with it.
        reason: Reason,
    },
    /// The model has no result for the section.
    #[error("the model has no result for this: {0}")]
    NoResult(leg_model::Error),
    /// The flexures buckle.
    #[error(
        "`pretension_n` is too high for the flexures: three tendons at it pull with {pull_n:.0} N, and the joint buckles at {critical_n:.0} N"
    )]
    Buckles {
        /// What the tendons pull with, N.
        pull_n: f64,
        /// What the joint bears, N.
        critical_n: f64,
    },
    /// The model refuses the value.
    #[error("`{key}` {reason}")]
    Refused {
        /// The key.
        key: &'static str,
        /// What is wrong with it.
        reason: Reason,
    },
}

impl Problem {
    /// What to do about it.
    #[must_use]
    pub fn fix(&self) -> String {
        match self {
            Self::Syntax(_) => "write `key = value` lines under `[section]` headings".into(),
            Self::UnknownKey { fix, .. } => fix.clone(),
            Self::MissingKey(_) | Self::MissingSection(_) => {
                "add it; the ready rigs in host-tools/rigs show all keys of each support".into()
            }
            Self::WrongType { wanted, .. } => format!("write {wanted}"),
            Self::NotFinite(_) => "write a number such as 29 or 1.5e3".into(),
            Self::AnchorCount { .. } => "give three anchors, [[x, y], [x, y], [x, y]]".into(),
            Self::Support(error) => error.fix(),
            Self::Choice { choices, .. } => format!("write {choices}"),
            Self::Both(first, second) => format!("give either `{first}` or `{second}`"),
            Self::Count { .. } => "give one entry for each point of the curve in each array".into(),
            Self::Entries { wanted, .. } => format!("give {wanted} numbers, [a, b, …]"),
            Self::OutsideRange { key, meaning, .. } => format!("`{key}` is this: {meaning}"),
            Self::Outcome { keys, .. } => format!("correct one of {keys}"),
            Self::NotBelow { reason, .. } => (*reason).into(),
            Self::Curve { .. } => {
                "correct the point; `leg curve` makes a curve from a tensile test".into()
            }
            Self::Buckles { critical_n, .. } => format!(
                "make the flexures thicker or shorter, or give less than {:.1}",
                (critical_n / 0.3).floor() / 10.0
            ),
            Self::NoResult(_) => "compare with the ready rigs, `leg rig list`".into(),
            Self::Refused { key, reason } => fix_of(key, *reason),
        }
    }
}

fn fix_of(key: &str, reason: Reason) -> String {
    match reason {
        Reason::OutOfRange if key == "tilt_deg" => "give at most 60".into(),
        Reason::OutOfRange if key == "shear_modulus_gpa" => {
            "give less than `youngs_modulus_gpa`, about 0.38 of it for a metal".into()
        }
        Reason::Collinear => "spread the anchors round the axis".into(),
        Reason::AboveMax => "give at most `f_max_n`".into(),
        Reason::OutsideBounds => "give at least `f_min_n` and at most `f_max_n`".into(),
        Reason::NotSlender => "make it longer or wider, or the flexure thinner".into(),
        Reason::OutsideFormula => "give 0.05 to 0.8 times `radius_mm`".into(),
        Reason::Exceeded => "make the flexure thinner or longer, or lower `tilt_deg`".into(),
        Reason::BeyondCurve => "give at most the last tension of the curve".into(),
        Reason::TooFew | Reason::TooMany => "give 2 to 16 points".into(),
        _ => "correct the value; the ready rigs in host-tools/rigs have one that works".into(),
    }
}
