//! The names of the supports in rig files and JSON.

use leg_model::SupportKind;

const SUPPORTS: [SupportKind; 3] = [
    SupportKind::TorsionFree,
    SupportKind::Universal,
    SupportKind::Spherical,
];

/// A word that names no support.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("there is no support `{0}`")]
pub struct UnknownSupport(String);

impl UnknownSupport {
    /// What to write instead.
    #[must_use]
    pub fn fix(&self) -> String {
        let names = SUPPORTS.map(|support| format!("`{}`", of(support)));
        format!("write one of {}", names.join(", "))
    }
}

/// The support with a name.
///
/// # Errors
/// [`UnknownSupport`] when there is none.
pub fn parse(word: &str) -> Result<SupportKind, UnknownSupport> {
    let named = SUPPORTS.into_iter().find(|&support| of(support) == word);
    named.ok_or_else(|| UnknownSupport(word.into()))
}

/// The name of a support.
#[must_use]
pub const fn of(support: SupportKind) -> &'static str {
    match support {
        SupportKind::TorsionFree => "torsion_free",
        SupportKind::Universal => "universal",
        SupportKind::Spherical => "spherical",
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test may panic")]
mod tests {
    use super::{SUPPORTS, of};

    #[test]
    fn the_names_are_those_of_the_wire() {
        for support in SUPPORTS {
            let json = serde_json::to_string(&support).unwrap();
            assert_eq!(json, format!("{:?}", of(support)));
        }
    }
}
