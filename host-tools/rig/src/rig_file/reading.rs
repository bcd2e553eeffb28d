//! From the text of a rig file to its values, every one checked.

use super::actuator::{self, ACTUATOR};
use super::calibration::{self, CALIBRATION};
use super::simulation::{self, SIMULATION};
use super::{RigFile, buckling, consistency, support, tendon};
use crate::control_section::{self, CONTROL};
use crate::gains::Gains;
use crate::toml_problem::{Fault, Problem};
use crate::toml_section::Section;
use leg_model::{Elasticity, Error, Quantity, Reason, RigParameters};
use toml::de::DeTable;

/// The sections of a file; those from [`CONTROL`] on may be left out.
const SECTIONS: [&str; 9] = [
    "geometry",
    "mass",
    "tendon",
    "workspace",
    "support",
    CONTROL,
    ACTUATOR,
    CALIBRATION,
    SIMULATION,
];

/// Reads the file and lets the model check it.
pub(super) fn parse(text: &str) -> Result<RigFile, Fault> {
    let syntax = |error: toml::de::Error| Fault {
        span: error.span().unwrap_or(0..0),
        problem: Problem::Syntax(error.message().into()),
    };
    let table = DeTable::parse(text).map_err(syntax)?;
    let root = Section::new(table.get_ref(), 0..0, &SECTIONS)?;
    let file = read(&root)?;
    if let Err((quantity, reason)) = check(&file)
        && let Some((section, key)) = key_of(quantity)
    {
        let span = root.span_of(section, key).unwrap_or(0..0);
        return Err(Fault {
            span,
            problem: Problem::Refused { key, reason },
        });
    }
    buckling::check(&file, root.span_of("tendon", "pretension_n"))?;
    consistency::check(&file, &root)?;
    Ok(file)
}

fn read(root: &Section<'_>) -> Result<RigFile, Fault> {
    let lengths = [
        "upper_mm",
        "joint_mm",
        "leg_mm",
        "base_anchors_mm",
        "leg_anchors_mm",
    ];
    let geometry = root.section("geometry", &lengths)?;
    let mass = root.section("mass", &["leg_kg", "centroid_mm", "gravity_m_per_s2"])?;
    let forces = root.section("tendon", &tendon::KEYS)?;
    let workspace = root.section("workspace", &["tilt_deg"])?;
    let tilt_deg = workspace.number("tilt_deg")?;
    let support::Read {
        name: support_name,
        support,
        critical_n,
    } = support::read(root, tilt_deg)?;
    let actuator = actuator::read(root)?;
    Ok(RigFile {
        parameters: RigParameters {
            base_anchors_m: geometry
                .points("base_anchors_mm")?
                .map(|point| point.map(metres)),
            leg_anchors_m: geometry
                .points("leg_anchors_mm")?
                .map(|point| point.map(metres)),
            upper_length_m: metres(geometry.number("upper_mm")?),
            joint_length_m: metres(geometry.number("joint_mm")?),
            leg_length_m: metres(geometry.number("leg_mm")?),
            leg_mass_kg: mass.number("leg_kg")?,
            leg_centroid_m: metres(mass.number("centroid_mm")?),
            gravity_m_per_s2: mass.number("gravity_m_per_s2")?,
        },
        tendons: tendon::read(&forces)?,
        stiffness_at: tendon::read_stiffness_at(&forces)?,
        f_min_n: forces.number("f_min_n")?,
        f_max_n: forces.number("f_max_n")?,
        pretension_n: forces.number("pretension_n")?,
        tilt_deg,
        support_name,
        support,
        critical_n,
        gains: Gains::defaults(&actuator).with(&control_section::read(root)?),
        actuator,
        calibration: calibration::read(root)?,
        plant: simulation::read(root)?,
    })
}

pub(super) fn metres(length_mm: f64) -> f64 {
    length_mm / 1000.0
}

/// What the model refuses in the file. What it cannot solve at some pose is left to the commands.
fn check(file: &RigFile) -> Result<(), (Quantity, Reason)> {
    if file.tilt_deg <= 0.0 {
        return Err((Quantity::Tilt, Reason::NotPositive));
    }
    // A curve has to serve every tension that is allowed.
    for tendon in &file.tendons {
        if let Err(Error::Refused { reason, .. }) = tendon.elongation(file.f_max_n) {
            return Err((Quantity::TensionMax, reason));
        }
        if let Err(Error::Refused { reason, .. }) = tendon.elongation(file.pretension_n) {
            return Err((Quantity::Pretension, reason));
        }
    }
    match leg_model::evaluate(&file.parameters, &file.query(0.0, file.tilt_deg, 0.0)) {
        Err(Error::Refused { quantity, reason }) => Err((quantity, reason)),
        _ if !(file.f_min_n..=file.f_max_n).contains(&file.pretension_n) => {
            Err((Quantity::Pretension, Reason::OutsideBounds))
        }
        _ => Ok(()),
    }
}

/// Where the file gives a quantity: section and key. It does not give those of a single pose; tendons and support are
/// checked where they are read.
fn key_of(quantity: Quantity) -> Option<(&'static str, &'static str)> {
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
