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

/// The keys of their geometry.
pub(super) const fn keys(name: SupportName) -> &'static [&'static str] {
    match name {
        SupportName::TorsionFree | SupportName::Spherical | SupportName::Universal => &[],
        SupportName::CompliantPivot => &["length_mm", "diameter_mm"],
        SupportName::ElasticRodUniversal => &["length_mm", "diameter_mm", "spacing_mm"],
        SupportName::NotchUniversal => &["radius_mm", "thickness_mm", "width_mm", "spacing_mm"],
        SupportName::LeafSpringUniversal => {
            &["length_mm", "thickness_mm", "width_mm", "spacing_mm"]
        }
    }
}

/// How the joint resists when it bends by up to `tilt` rad, or what the model refuses of it; and the load along the leg
/// under which it buckles, N.
pub(super) fn read(
    section: &Section<'_>,
    name: SupportName,
    tilt: f64,
) -> Result<(Result<JointStiffness<f64>, Error>, f64), TomlError> {
    let material = FlexureMaterial {
        youngs_modulus_pa: section.number(MATERIAL[0])? * 1e9,
        shear_modulus_pa: section.number(MATERIAL[1])? * 1e9,
        strain_max: section.number(MATERIAL[2])? / 100.0,
    };
    let metres = |key| section.metres(key);
    // Two flexures of a pair stand side by side; a pivot is one.
    Ok(match name {
        SupportName::NotchUniversal => {
            let notch = Notch {
                radius_m: metres("radius_mm")?,
                thickness_m: metres("thickness_mm")?,
                width_m: metres("width_mm")?,
            };
            let joint = notch.universal(metres("spacing_mm")?, &material, tilt);
            (joint, 2.0 * notch.critical_n(&material))
        }
        SupportName::LeafSpringUniversal => {
            let leaf = Leaf {
                length_m: metres("length_mm")?,
                width_m: metres("width_mm")?,
                thickness_m: metres("thickness_mm")?,
            };
            let joint = leaf.universal(metres("spacing_mm")?, &material, tilt);
            (joint, 2.0 * leaf.critical_n(&material))
        }
        _ => {
            let rod = Rod {
                length_m: metres("length_mm")?,
                diameter_m: metres("diameter_mm")?,
            };
            let one_n = rod.critical_n(&material);
            if name == SupportName::CompliantPivot {
                (rod.pivot(&material, tilt), one_n)
            } else {
                let joint = rod.universal(metres("spacing_mm")?, &material, tilt);
                (joint, 2.0 * one_n)
            }
        }
    })
}
