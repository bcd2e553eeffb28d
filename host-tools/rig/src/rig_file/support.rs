//! The section `[support]`: how the joint guides the leg, and how it resists.

mod flexures;

use crate::support_name::SupportName;
use crate::toml_error::TomlError;
use crate::toml_section::Section;
use flexures::MATERIAL;
use leg_model::{Error, JointStiffness, Quantity, Support};

/// The keys of a measured joint.
const MEASURED: [&str; 3] = ["bending_nm_per_rad", "torsion_nm_per_rad", "axial_n_per_m"];

const SHAFT: [&str; 3] = ["length_mm", "section_mm2", "youngs_modulus_gpa"];

/// Reads the section: the support's name, the support, and the load along the leg under which its flexures buckle, N;
/// `tilt_deg` is how far the joint bends.
pub(super) fn read(
    root: &Section<'_>,
    tilt_deg: f64,
) -> Result<(SupportName, Support<f64>, Option<f64>), TomlError> {
    let section = root.any_section("support")?;
    let name = read_name(&section)?;
    let measured = section.has(MEASURED[0]);
    let section = section.checked(&keys(name, measured))?;
    let refused = |error| refusal(&section, error);
    let (joint, critical_n) = if name.elastic() && !measured {
        let (joint, critical_n) = flexures::read(&section, name, tilt_deg.to_radians())?;
        (joint.map_err(refused)?, Some(critical_n))
    } else {
        (measured_joint(&section, name.elastic())?, None)
    };
    let joint = JointStiffness {
        axial_compliance_m_per_n: joint.axial_compliance_m_per_n + shaft(&section)?,
        ..joint
    };
    let support = Support::new(name.kind(), joint).map_err(refused)?;
    Ok((name, support, critical_n))
}

fn read_name(section: &Section<'_>) -> Result<SupportName, TomlError> {
    let word = section.word("kind")?;
    SupportName::parse(word.get_ref())
        .map_err(|error| TomlError::new(word.span(), error.to_string(), error.help()))
}

/// The keys of the section for a support.
fn keys(name: SupportName, measured: bool) -> Vec<&'static str> {
    let mut keys = vec!["kind", "shaft"];
    if !name.elastic() {
        keys.push("axial_n_per_m");
    } else if measured {
        keys.extend(MEASURED);
    } else {
        keys.extend(flexures::keys(name));
        keys.extend(MATERIAL);
    }
    keys
}

/// A joint whose stiffness is given; one that is not elastic gives way along the leg at most.
fn measured_joint(section: &Section<'_>, elastic: bool) -> Result<JointStiffness<f64>, TomlError> {
    let mut joint = JointStiffness::none();
    if elastic {
        joint.bending_nm_per_rad = section.positive(MEASURED[0])?;
        joint.torsion_nm_per_rad = section.positive(MEASURED[1])?;
    }
    if elastic || section.has(MEASURED[2]) {
        joint.axial_compliance_m_per_n = section.positive(MEASURED[2])?.recip();
    }
    Ok(joint)
}

/// L/EA of the shaft between joint and leg, m/N; nothing where the file gives none.
fn shaft(section: &Section<'_>) -> Result<f64, TomlError> {
    if !section.has("shaft") {
        return Ok(0.0);
    }
    let shaft = section.section("shaft", &SHAFT)?;
    let [length_mm, section_mm2, modulus_gpa] = SHAFT.map(|key| shaft.positive(key));
    Ok(length_mm? / 1000.0 / (section_mm2? * 1e-6 * modulus_gpa? * 1e9))
}

/// What the model refuses, at the key that gives it.
fn refusal(section: &Section<'_>, error: Error) -> TomlError {
    let Error::Refused { quantity, reason } = error else {
        let sentence = format!("the model has no result for this: {error}");
        let help = "compare with the ready rigs, `leg rig list`";
        return TomlError::new(section.span(), sentence, help);
    };
    let candidates: &[&str] = match quantity {
        Quantity::FlexureLength => &["length_mm"],
        Quantity::FlexureWidth => &["width_mm"],
        Quantity::FlexureThickness => &["thickness_mm", "diameter_mm"],
        Quantity::NotchRadius => &["radius_mm"],
        Quantity::FlexureSpacing => &["spacing_mm"],
        Quantity::YoungsModulus => &["youngs_modulus_gpa"],
        Quantity::ShearModulus => &["shear_modulus_gpa"],
        Quantity::StrainLimit => &["strain_max_percent"],
        Quantity::JointBending => &["bending_nm_per_rad"],
        Quantity::JointTorsion => &["torsion_nm_per_rad"],
        _ => &["axial_n_per_m"],
    };
    let given = candidates
        .iter()
        .find_map(|key| Some((*key, section.place(&[*key])?)));
    let (key, span) = given.unwrap_or(("kind", section.span()));
    TomlError::refused(span, key, reason)
}

#[cfg(test)]
mod tests {
    use super::{MEASURED, SHAFT, SupportName, keys};
    use crate::mechanism_keys;
    use std::collections::BTreeSet;
    use strum::VariantArray;

    #[test]
    fn the_keys_that_are_read_are_those_of_the_table() {
        let mut read: BTreeSet<&str> = MEASURED.into_iter().chain(SHAFT).collect();
        for name in SupportName::VARIANTS {
            read.extend(keys(*name, false));
        }
        // A table of its own.
        assert!(read.remove("shaft"));
        assert_eq!(read, mechanism_keys::names("support").into_iter().collect());
    }
}
