//! A published number beside ours.

use serde::Serialize;

/// What a number belongs to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Topic {
    /// Eqs. (24) and (25).
    Kinematics,
    /// Table 3.
    Statics,
    /// Fig. 6.
    Tendon,
    /// Fig. 9.
    Deviation,
    /// Fig. 10.
    Workspace,
}

impl Topic {
    /// Every topic.
    pub const ALL: [Self; 5] = [
        Self::Kinematics,
        Self::Statics,
        Self::Tendon,
        Self::Deviation,
        Self::Workspace,
    ];

    /// A heading.
    #[must_use]
    pub const fn heading(self) -> &'static str {
        match self {
            Self::Kinematics => "Kinematics: Eqs. (24) and (25)",
            Self::Statics => "Statics: Table 3",
            Self::Tendon => "The tendon: Fig. 6",
            Self::Deviation => "Deviation along one azimuth: Fig. 9",
            Self::Workspace => "Deviation over the workspace: Fig. 10",
        }
    }
}

/// Whether two numbers agree.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Verdict {
    /// Within the bound.
    Agrees,
    /// Beyond it.
    Differs,
    /// Ours is the nearest counterpart, but another thing.
    NotComparable,
}

/// How the published number is meant.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum PublishedAs {
    /// As a value.
    Value,
    /// As a limit that is not exceeded.
    AtMost,
    /// As something that cannot be repeated here; ours stands beside it for scale.
    Unrepeatable,
}

/// A published number beside ours.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PaperRow {
    /// What it belongs to.
    pub topic: Topic,
    /// What it is.
    pub what: String,
    /// What the paper prints.
    pub published: f64,
    /// How that is meant.
    pub meaning: PublishedAs,
    /// What the program computes.
    pub ours: f64,
    /// The unit of both.
    pub unit: &'static str,
    /// Digits after the point.
    pub decimals: usize,
    /// How far ours may be from the published number to agree, in the same unit.
    pub bound: f64,
    /// The verdict that is known.
    pub expected: Verdict,
    /// Why it is what it is.
    pub why: &'static str,
}

impl PaperRow {
    /// A value that is to be met exactly; see the methods below for the other kinds.
    pub(super) fn new(
        topic: Topic,
        what: impl Into<String>,
        (published, ours): (f64, f64),
        (unit, decimals): (&'static str, usize),
        why: &'static str,
    ) -> Self {
        Self {
            topic,
            what: what.into(),
            published,
            meaning: PublishedAs::Value,
            ours,
            unit,
            decimals,
            bound: 0.0,
            expected: Verdict::Agrees,
            why,
        }
    }

    /// The same with a bound on the difference.
    pub(super) fn bounded(self, bound: f64) -> Self {
        Self { bound, ..self }
    }

    /// The same as a limit that is not exceeded.
    pub(super) fn limit(self) -> Self {
        Self {
            meaning: PublishedAs::AtMost,
            ..self
        }
    }

    /// The same as a number that cannot be repeated here.
    pub(super) fn unrepeatable(self) -> Self {
        Self {
            meaning: PublishedAs::Unrepeatable,
            expected: Verdict::NotComparable,
            ..self
        }
    }

    /// The same with the verdict that is known.
    pub(super) fn expected(self, expected: Verdict) -> Self {
        Self { expected, ..self }
    }

    /// Ours less the published number.
    #[must_use]
    pub fn difference(&self) -> f64 {
        self.ours - self.published
    }

    /// Whether they agree. What is no number does not.
    #[must_use]
    pub fn verdict(&self) -> Verdict {
        let near = match self.meaning {
            PublishedAs::Value => self.difference().abs() <= self.bound,
            PublishedAs::AtMost => self.difference() <= self.bound,
            PublishedAs::Unrepeatable => return Verdict::NotComparable,
        };
        if near {
            Verdict::Agrees
        } else {
            Verdict::Differs
        }
    }
}

impl Verdict {
    /// In a word.
    #[must_use]
    pub const fn word(self) -> &'static str {
        match self {
            Self::Agrees => "agrees",
            Self::Differs => "differs",
            Self::NotComparable => "not comparable",
        }
    }
}
