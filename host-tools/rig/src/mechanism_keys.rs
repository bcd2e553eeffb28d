//! The keys of a rig file that the model checks, and not a table of ranges: the mechanism, its tendons and its support. For
//! those who list every key of a file, and for its reading. Tendons and support are read by their positions in lists of their own
//! or by the kind of the support: tests beside those compare them with this table.

use leg_model::Quantity;

/// A key of the mechanism.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MechanismKey {
    /// The sections of the rig file that have it: its name, or how their names begin.
    pub section: &'static str,
    /// The key, which ends with its unit.
    pub key: &'static str,
    /// Its unit; `1` for a pure number, nothing for a word.
    pub unit: &'static str,
    /// What it means.
    pub meaning: &'static str,
}

macro_rules! keys {
    ($($section:literal $key:literal [$unit:literal] $meaning:literal;)*) => {
        &[$(MechanismKey { section: $section, key: $key, unit: $unit, meaning: $meaning },)*]
    };
}

/// All of them.
pub const MECHANISM_KEYS: &[MechanismKey] = keys! {
    "geometry" "upper_mm" ["mm"] "From the upper plate to the joint's centre.";
    "geometry" "joint_mm" ["mm"] "From the joint's centre to the lower plate.";
    "geometry" "leg_mm" ["mm"] "From the lower plate to the tip.";
    "geometry" "base_anchors_mm" ["mm"] "Where the tendons are fixed on the upper plate, (x, y).";
    "geometry" "leg_anchors_mm" ["mm"] "Where the tendons are fixed on the lower plate, (x, y).";
    "mass" "leg_kg" ["kg"] "The leg without its payload.";
    "mass" "centroid_mm" ["mm"] "The leg's centroid below the joint's centre.";
    "mass" "gravity_m_per_s2" ["m/s²"] "Gravity.";
    "tendon" "f_min_n" ["N"] "Lowest tension allowed.";
    "tendon" "f_max_n" ["N"] "Highest tension allowed.";
    "tendon" "pretension_n" ["N"] "Tension of each tendon when the leg hangs straight down.";
    "tendon" "stiffness_at" [""] "At which tension a tendon's stiffness is read for the linear deviation: \"pretension\" or \"tension\".";
    "tendon" "stiffness_n_per_m" ["N/m"] "Stiffness of the tendons, the same at every tension; of a curve, at each of its points.";
    "tendon" "tension_n" ["N"] "The tensions of the curve's points.";
    "tendon" "elongation_mm" ["mm"] "How far the tendon is stretched at each.";
    "tendon" "length_mm" ["mm"] "Length of the piece that was tested.";
    "tendon" "diameter_mm" ["mm"] "Its diameter.";
    "tendon" "tendon_length_mm" ["mm"] "Length of the tendons themselves.";
    "tendon" "tendon_diameter_mm" ["mm"] "Their diameter.";
    "tendon" "elongation_factor" ["1"] "Elongation of the leg's tendons over that by their curve or stiffness, measured by `leg tune`; 1 where left out.";
    "workspace" "tilt_deg" ["°"] "How far the leg leans at most.";
    "support" "kind" [""] "How the joint guides the leg; each kind has keys of its own.";
    "support" "bending_nm_per_rad" ["N·m/rad"] "Stiffness of the joint against bending, as measured.";
    "support" "torsion_nm_per_rad" ["N·m/rad"] "Stiffness of the joint against torsion, as measured.";
    "support" "axial_n_per_m" ["N/m"] "Stiffness of the joint along the leg.";
    "support" "length_mm" ["mm"] "Free length of a flexure, or of the shaft.";
    "support" "diameter_mm" ["mm"] "Diameter of a rod.";
    "support" "thickness_mm" ["mm"] "Thickness of a flexure where it is thinnest.";
    "support" "width_mm" ["mm"] "Width of a flexure along its axis.";
    "support" "radius_mm" ["mm"] "Radius of the notches.";
    "support" "spacing_mm" ["mm"] "Distance between the two flexures of a pair.";
    "support" "youngs_modulus_gpa" ["GPa"] "Young's modulus of the material.";
    "support" "shear_modulus_gpa" ["GPa"] "Its shear modulus.";
    "support" "strain_max_percent" ["%"] "The strain up to which stress is linear: bending to the greatest tilt may take no more.";
    "support" "section_mm2" ["mm²"] "Cross-section of the shaft.";
};

/// The names of the keys of a section.
pub(crate) fn names(section: &str) -> Vec<&'static str> {
    let keys = MECHANISM_KEYS.iter().filter(|key| key.section == section);
    keys.map(|key| key.key).collect()
}

/// The key of a section; none of one that a table of fields has, or that there is not.
#[must_use]
pub fn find(section: &str, key: &str) -> Option<&'static MechanismKey> {
    let first = section.split('.').next().unwrap_or_default();
    let mut keys = MECHANISM_KEYS.iter();
    keys.find(|known| known.section == first && known.key == key)
}

/// Where the file gives a quantity: section and key. It does not give those of a single pose; tendons and support are
/// checked where they are read.
pub(crate) fn key_of(quantity: Quantity) -> Option<(&'static str, &'static str)> {
    Some(match quantity {
        Quantity::BaseAnchors => ("geometry", "base_anchors_mm"),
        Quantity::LegAnchors => ("geometry", "leg_anchors_mm"),
        Quantity::UpperLength => ("geometry", "upper_mm"),
        Quantity::JointLength => ("geometry", "joint_mm"),
        Quantity::LegLength => ("geometry", "leg_mm"),
        Quantity::LegMass => ("mass", "leg_kg"),
        Quantity::LegCentroid => ("mass", "centroid_mm"),
        Quantity::Gravity => ("mass", "gravity_m_per_s2"),
        Quantity::TensionMin => ("tendon", "f_min_n"),
        Quantity::TensionMax => ("tendon", "f_max_n"),
        Quantity::Pretension => ("tendon", "pretension_n"),
        Quantity::Tilt => ("workspace", "tilt_deg"),
        _ => return None,
    })
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test may panic")]
mod tests {
    use super::{MECHANISM_KEYS, MechanismKey, find};
    use crate::ready_rigs::READY_RIGS;
    use std::collections::BTreeSet;

    fn found(section: &str, table: &toml::Table, keys: &mut BTreeSet<(String, String)>) {
        for (key, value) in table {
            match value.as_table() {
                Some(inner) => {
                    let name = [section, key].join(".");
                    found(name.trim_start_matches('.'), inner, keys);
                }
                None => {
                    keys.insert((section.into(), key.clone()));
                }
            }
        }
    }

    #[test]
    fn every_key_of_the_ready_rigs_is_known() {
        let mut keys = BTreeSet::new();
        for rig in READY_RIGS {
            found("", &rig.text.parse().unwrap(), &mut keys);
        }
        assert!(keys.len() > 20);
        let of_tables = |section: &str| section.starts_with("control");
        for (section, key) in keys.into_iter().filter(|(section, _)| !of_tables(section)) {
            assert!(find(&section, &key).is_some(), "[{section}] {key}");
        }
    }

    #[test]
    fn no_key_stands_twice() {
        for (index, key) in MECHANISM_KEYS.iter().enumerate() {
            let same = |other: &MechanismKey| (other.section, other.key) == (key.section, key.key);
            assert_eq!(
                MECHANISM_KEYS.iter().position(same),
                Some(index),
                "{}",
                key.key
            );
        }
    }
}
