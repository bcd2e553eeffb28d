//! A joint of flexures, from the geometry and the material that the section `[support]` gives.

use super::reading::metres;
use super::support::fault;
use crate::support_name::SupportName;
use crate::toml_problem::Fault;
use crate::toml_section::Section;
use leg_model::{Error, FlexureMaterial, JointStiffness, Leaf, Notch, Rod};

/// The keys of a material.
pub(super) const MATERIAL: [&str; 3] = [
    "youngs_modulus_gpa",
    "shear_modulus_gpa",
    "strain_max_percent",
];

/// How the joint resists, and what one of its flexures bears before it buckles, N.
type Outcome = (Result<JointStiffness<f64>, Error>, f64);

/// How the joint resists when it bends by up to `tilt` rad, and the load along the leg under which it buckles, N.
pub(super) fn read(
    section: &Section<'_>,
    name: SupportName,
    tilt: f64,
) -> Result<(JointStiffness<f64>, Option<f64>), Fault> {
    let material = FlexureMaterial {
        youngs_modulus_pa: section.number(MATERIAL[0])? * 1e9,
        shear_modulus_pa: section.number(MATERIAL[1])? * 1e9,
        strain_max: section.number(MATERIAL[2])? / 100.0,
    };
    let ((joint, one_n), side_by_side) = match name {
        SupportName::CompliantPivot => (pivot(section, &material, tilt)?, 1.0),
        SupportName::NotchUniversal => (notches(section, &material, tilt)?, 2.0),
        SupportName::LeafSpringUniversal => (leaves(section, &material, tilt)?, 2.0),
        _ => (rods(section, &material, tilt)?, 2.0),
    };
    let joint = joint.map_err(|error| fault(section, error))?;
    Ok((joint, Some(side_by_side * one_n)))
}

type Material = FlexureMaterial<f64>;

fn pivot(section: &Section<'_>, material: &Material, tilt: f64) -> Result<Outcome, Fault> {
    let rod = rod(section)?;
    Ok((rod.pivot(material, tilt), rod.critical_n(material)))
}

fn rods(section: &Section<'_>, material: &Material, tilt: f64) -> Result<Outcome, Fault> {
    let (rod, spacing) = (rod(section)?, length(section, "spacing_mm")?);
    Ok((
        rod.universal(spacing, material, tilt),
        rod.critical_n(material),
    ))
}

fn notches(section: &Section<'_>, material: &Material, tilt: f64) -> Result<Outcome, Fault> {
    let notch = Notch {
        radius_m: length(section, "radius_mm")?,
        thickness_m: length(section, "thickness_mm")?,
        width_m: length(section, "width_mm")?,
    };
    let joint = notch.universal(length(section, "spacing_mm")?, material, tilt);
    Ok((joint, notch.critical_n(material)))
}

fn leaves(section: &Section<'_>, material: &Material, tilt: f64) -> Result<Outcome, Fault> {
    let leaf = Leaf {
        length_m: length(section, "length_mm")?,
        width_m: length(section, "width_mm")?,
        thickness_m: length(section, "thickness_mm")?,
    };
    let joint = leaf.universal(length(section, "spacing_mm")?, material, tilt);
    Ok((joint, leaf.critical_n(material)))
}

fn rod(section: &Section<'_>) -> Result<Rod<f64>, Fault> {
    Ok(Rod {
        length_m: length(section, "length_mm")?,
        diameter_m: length(section, "diameter_mm")?,
    })
}

fn length(section: &Section<'_>, key: &'static str) -> Result<f64, Fault> {
    section.number(key).map(metres)
}
