//! Whether the flexures of the joint bear the pull of the tendons.

use super::RigFile;
use crate::toml_error::TomlError;
use std::ops::Range;

/// The load along a joint of flexures beside the one under which it buckles.
///
/// The pull is that of the three tendons along the leg; its weight, which takes a little off, is left out. The joint
/// is softer in bending by about this part of it, which the model leaves out.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Buckling {
    /// The load under which the joint buckles, N.
    pub critical_n: f64,
    /// The pull by it, each tendon at the pretension.
    pub at_pretension: f64,
    /// The pull by it, each tendon at the highest tension allowed.
    pub at_f_max: f64,
}

impl RigFile {
    /// How near the joint is to buckling; none where the file does not give the geometry of flexures.
    #[must_use]
    pub fn buckling(&self) -> Option<Buckling> {
        let critical_n = self.critical_n?;
        Some(Buckling {
            critical_n,
            at_pretension: pull_n(self.pretension_n) / critical_n,
            at_f_max: pull_n(self.f_max_n) / critical_n,
        })
    }
}

fn pull_n(tension_n: f64) -> f64 {
    3.0 * tension_n
}

/// Refuses a joint that buckles at the pretension, at the place of the pretension.
pub(super) fn check(file: &RigFile, pretension: Option<Range<usize>>) -> Result<(), TomlError> {
    let (Some(critical_n), pull_n) = (file.critical_n, pull_n(file.pretension_n)) else {
        return Ok(());
    };
    if pull_n < critical_n {
        return Ok(());
    }
    Err(TomlError::new(
        pretension.unwrap_or(0..0),
        format!(
            "`pretension_n` is too high for the flexures: three tendons at it pull with {pull_n:.0} N, and the joint \
             buckles at {critical_n:.0} N"
        ),
        format!(
            "make the flexures thicker or shorter, or give less than {:.1}",
            (critical_n / 0.3).floor() / 10.0
        ),
    ))
}
