//! A joint of flexures, from the geometry and the material that the section `[support]` gives.

use crate::support_name::SupportName;
use crate::toml_error::TomlError;
use crate::toml_section::Section;
use leg_model::{Error, FlexureMaterial, JointStiffness, Leaf, Notch, Rod};

/// The keys of a material.
pub(super) const MATERIAL: [&str; 3] = [
    "youngs_modulus_gpa",
    "shear_modulus_gpa",
    "strain_max_percent",
];

/// How the joint resists, and what one of its flexures bears before it buckles, N.
type FlexureJoint = (Result<JointStiffness<f64>, Error>, f64);

/// How the joint resists when it bends by up to `tilt` rad, or what the model refuses of it; and the load along the leg
/// under which it buckles, N.
pub(super) fn read(
    section: &Section<'_>,
    name: SupportName,
    tilt: f64,
) -> Result<FlexureJoint, TomlError> {
    let material = FlexureMaterial {
        youngs_modulus_pa: section.number(MATERIAL[0])? * 1e9,
        shear_modulus_pa: section.number(MATERIAL[1])? * 1e9,
        strain_max: section.number(MATERIAL[2])? / 100.0,
    };
    let read = match name {
        SupportName::CompliantPivot => return pivot(section, &material, tilt),
        SupportName::NotchUniversal => notches,
        SupportName::LeafSpringUniversal => leaves,
        _ => rods,
    };
    // Two flexures of a pair stand side by side.
    let (joint, one_n) = read(section, &material, tilt)?;
    Ok((joint, 2.0 * one_n))
}

type Material = FlexureMaterial<f64>;

fn pivot(section: &Section<'_>, material: &Material, tilt: f64) -> Result<FlexureJoint, TomlError> {
    let rod = rod(section)?;
    Ok((rod.pivot(material, tilt), rod.critical_n(material)))
}

fn rods(section: &Section<'_>, material: &Material, tilt: f64) -> Result<FlexureJoint, TomlError> {
    let (rod, spacing) = (rod(section)?, section.metres("spacing_mm")?);
    Ok((
        rod.universal(spacing, material, tilt),
        rod.critical_n(material),
    ))
}

fn notches(
    section: &Section<'_>,
    material: &Material,
    tilt: f64,
) -> Result<FlexureJoint, TomlError> {
    let notch = Notch {
        radius_m: section.metres("radius_mm")?,
        thickness_m: section.metres("thickness_mm")?,
        width_m: section.metres("width_mm")?,
    };
    let joint = notch.universal(section.metres("spacing_mm")?, material, tilt);
    Ok((joint, notch.critical_n(material)))
}

fn leaves(
    section: &Section<'_>,
    material: &Material,
    tilt: f64,
) -> Result<FlexureJoint, TomlError> {
    let leaf = Leaf {
        length_m: section.metres("length_mm")?,
        width_m: section.metres("width_mm")?,
        thickness_m: section.metres("thickness_mm")?,
    };
    let joint = leaf.universal(section.metres("spacing_mm")?, material, tilt);
    Ok((joint, leaf.critical_n(material)))
}

fn rod(section: &Section<'_>) -> Result<Rod<f64>, TomlError> {
    Ok(Rod {
        length_m: section.metres("length_mm")?,
        diameter_m: section.metres("diameter_mm")?,
    })
}
