//! The supports by name: the rows of the paper's Fig. 2.

use leg_model::SupportKind;
use serde::Serialize;
use strum::{IntoStaticStr, VariantArray};

/// A kind of central support, as rig files and JSON name it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, IntoStaticStr, VariantArray)]
#[serde(rename_all = "snake_case")]
#[strum(serialize_all = "snake_case")]
pub enum SupportName {
    /// The paper's idealisation: the leg tilts without torsion.
    TorsionFree,
    /// A ball joint.
    Spherical,
    /// A rigid universal joint.
    Universal,
    /// One elastic rod.
    CompliantPivot,
    /// A universal joint of elastic rods.
    ElasticRodUniversal,
    /// A universal joint of notch hinges.
    NotchUniversal,
    /// A universal joint of leaf springs.
    LeafSpringUniversal,
}

/// A word that names no support.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("there is no support `{0}`")]
pub struct UnknownSupport(String);

impl UnknownSupport {
    /// What to write instead.
    #[must_use]
    pub fn help(&self) -> String {
        let names = SupportName::VARIANTS.iter();
        let names: Vec<_> = names.map(|name| format!("`{}`", name.word())).collect();
        format!("write one of {}", names.join(", "))
    }
}

impl SupportName {
    /// The support with a name.
    ///
    /// # Errors
    /// [`UnknownSupport`] when there is none.
    pub fn parse(word: &str) -> Result<Self, UnknownSupport> {
        let named = Self::VARIANTS.iter().find(|name| name.word() == word);
        named.copied().ok_or_else(|| UnknownSupport(word.into()))
    }

    /// Its name.
    #[must_use]
    pub fn word(self) -> &'static str {
        self.into()
    }

    /// How it guides the leg.
    #[must_use]
    pub const fn kind(self) -> SupportKind {
        match self {
            Self::TorsionFree => SupportKind::TorsionFree,
            Self::Spherical | Self::CompliantPivot => SupportKind::Spherical,
            Self::Universal => SupportKind::Universal,
            Self::ElasticRodUniversal | Self::NotchUniversal | Self::LeafSpringUniversal => {
                SupportKind::ElasticUniversal
            }
        }
    }

    /// Whether its joint is a spring, so that a rig file has to say how stiff it is.
    #[must_use]
    pub const fn elastic(self) -> bool {
        !matches!(self, Self::TorsionFree | Self::Spherical | Self::Universal)
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test may panic")]
mod tests {
    use super::SupportName;
    use strum::VariantArray;

    #[test]
    fn every_name_leads_back_to_its_support() {
        for &support in SupportName::VARIANTS {
            assert_eq!(SupportName::parse(support.word()), Ok(support));
            let json = serde_json::to_string(&support).unwrap();
            assert_eq!(json, format!("{:?}", support.word()));
        }
    }

    #[test]
    fn another_name_is_answered_with_all_of_them() {
        let error = SupportName::parse("ball").unwrap_err();
        assert!(error.help().contains("`spherical`"));
    }
}
