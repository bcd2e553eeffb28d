//! The names of the supports in rig files and JSON.

use leg_model::SupportKind;

const SUPPORTS: [(&str, SupportKind); 3] = [
    ("torsion_free", SupportKind::TorsionFree),
    ("universal", SupportKind::Universal),
    ("spherical", SupportKind::Spherical),
];

/// A word that names no support.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("there is no support `{0}`")]
pub struct UnknownSupport(String);

impl UnknownSupport {
    /// What to write instead.
    #[must_use]
    pub fn fix(&self) -> String {
        let names: Vec<String> = SUPPORTS
            .iter()
            .map(|(name, _)| format!("`{name}`"))
            .collect();
        format!("write one of {}", names.join(", "))
    }
}

/// The support with a name.
///
/// # Errors
/// [`UnknownSupport`] when there is none.
pub fn parse(word: &str) -> Result<SupportKind, UnknownSupport> {
    let named = SUPPORTS.iter().find(|(name, _)| *name == word);
    named
        .map(|&(_, support)| support)
        .ok_or_else(|| UnknownSupport(word.into()))
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test may panic")]
mod tests {
    use super::SUPPORTS;

    #[test]
    fn the_names_are_those_of_the_wire() {
        for (name, support) in SUPPORTS {
            let json = serde_json::to_string(&support).unwrap();
            assert_eq!(json, format!("{name:?}"));
        }
    }
}
