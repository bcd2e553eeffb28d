//! What is wrong with a TOML text, where, and what to do about it.

use leg_base::failure::{Failure, TextPlace};
use leg_model::Reason;
use std::ops::Range;

/// A refusal of a piece of a text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TomlError {
    /// The bytes of the text that are meant.
    pub span: Range<usize>,
    /// What is wrong with them.
    pub sentence: String,
    /// What to do.
    pub help: String,
}

impl TomlError {
    /// A refusal with what to do.
    #[must_use]
    pub fn new(span: Range<usize>, sentence: impl Into<String>, help: impl Into<String>) -> Self {
        Self {
            span,
            sentence: sentence.into(),
            help: help.into(),
        }
    }

    /// A value that the model refuses.
    #[must_use]
    pub fn refused(span: Range<usize>, key: &str, reason: Reason) -> Self {
        Self::new(span, format!("`{key}` {reason}"), help(key, reason))
    }

    /// The same with the text and its name.
    #[must_use]
    pub fn failure(self, file: &str, text: &str) -> Failure {
        let place = TextPlace {
            file: file.into(),
            text: text.into(),
            span: self.span,
        };
        Failure::refused_at(self.sentence, self.help, place)
    }
}

impl From<toml::de::Error> for TomlError {
    fn from(error: toml::de::Error) -> Self {
        Self::new(
            error.span().unwrap_or(0..0),
            format!("not TOML: {}", error.message()),
            "write `key = value` lines under `[section]` headings",
        )
    }
}

fn help(key: &str, reason: Reason) -> &'static str {
    match reason {
        Reason::OutOfRange if key == "tilt_deg" => "give at most 60",
        Reason::OutOfRange if key == "shear_modulus_gpa" => {
            "give less than `youngs_modulus_gpa`, about 0.38 of it for a metal"
        }
        Reason::Collinear => "spread the anchors round the axis",
        Reason::AboveMax => "give at most `f_max_n`",
        Reason::OutsideBounds => "give at least `f_min_n` and at most `f_max_n`",
        Reason::NotSlender => "make it longer or wider, or the flexure thinner",
        Reason::OutsideFormula => "give 0.05 to 0.8 times `radius_mm`",
        Reason::Exceeded => "make the flexure thinner or longer, or lower `tilt_deg`",
        Reason::BeyondCurve => "give at most the last tension of the curve",
        Reason::TooFew | Reason::TooMany => "give 2 to 16 points",
        _ => "correct the value; the ready rigs in host-tools/rigs have one that works",
    }
}
