//! From the text of a rig file to its values, every one checked.

use super::consistency::Warning;
use super::derived::{Basis, GivenGains};
use super::{RigFile, buckling, consistency, derived, support, tendon, whole_leg};
use crate::actuator::{ACTUATOR, Actuator};
use crate::calibration::{CALIBRATION, Calibration};
use crate::gains::{self, CONTROL};
use crate::mechanism_keys::{self, key_of};
use crate::plant_settings::{PlantSettings, SIMULATION};
use crate::renamed_keys;
use crate::toml_error::TomlError;
use crate::toml_section::Section;
use leg_firmware::settings::Gains;
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

/// Reads the file and lets the model check it; with notes on what it should say otherwise.
pub(super) fn parse(text: &str) -> Result<(RigFile, Vec<String>), TomlError> {
    let mut table = DeTable::parse(text)?.into_inner();
    let mut notes = renamed_keys::replace(&mut table)?;
    let root = Section::whole(&table).checked(&SECTIONS)?;
    let file = read(&root)?;
    if let Err((quantity, reason)) = check(&file)
        && let Some((section, key)) = key_of(quantity)
    {
        let span = root.place(&[section, key]).unwrap_or(0..0);
        return Err(TomlError::refused(span, key, reason));
    }
    buckling::check(&file, root.place(&["tendon", "pretension_n"]))?;
    let mut warnings = consistency::check(&file, &root)?;
    warnings.extend(whole_leg::check(&file, &root)?);
    notes.extend(warnings.iter().map(|Warning { span, text: words }| {
        let before = text.get(..span.start).unwrap_or_default();
        format!(
            "warning: {words} (line {})",
            1 + before.matches('\n').count()
        )
    }));
    Ok((file, notes))
}

fn read(root: &Section<'_>) -> Result<RigFile, TomlError> {
    let parameters = read_parameters(root)?;
    let tendon = root.section("tendon", &tendon::KEYS)?;
    let tilt_deg = root
        .section("workspace", &mechanism_keys::names("workspace"))?
        .number("tilt_deg")?;
    let (support_name, support, critical_n) = support::read(root, tilt_deg)?;
    let actuators = Actuator::read_all(root)?;
    let control = gains::read_rig(root)?;
    let elongation_factor = tendon::read_elongation_factor(&tendon)?;
    let mut file = RigFile {
        parameters,
        tendons: tendon::read(&tendon, elongation_factor)?,
        elongation_factor,
        stiffness_at: tendon::read_stiffness_at(&tendon)?,
        f_min_n: tendon.number("f_min_n")?,
        f_max_n: tendon.number("f_max_n")?,
        pretension_n: tendon.number("pretension_n")?,
        tilt_deg,
        support_name,
        support,
        critical_n,
        keeps_station: control.keeps_station.unwrap_or(true),
        recorded: control.recorded,
        gains: gains::changed(Gains::default(), &control.changes),
        given_gains: GivenGains::new(&control.changes),
        calibration: Calibration::read(root, &actuators)?,
        actuators,
        plant: PlantSettings::read(root)?,
    };
    file.gains = derived::gains(&Basis::new_all(&file), &file.gains, file.given_gains);
    Ok(file)
}

fn read_parameters(root: &Section<'_>) -> Result<RigParameters<f64, 3>, TomlError> {
    let geometry = root.section("geometry", &mechanism_keys::names("geometry"))?;
    let mass = root.section("mass", &mechanism_keys::names("mass"))?;
    Ok(RigParameters {
        base_anchors_m: geometry.points_m("base_anchors_mm")?,
        leg_anchors_m: geometry.points_m("leg_anchors_mm")?,
        upper_length_m: geometry.metres("upper_mm")?,
        joint_length_m: geometry.metres("joint_mm")?,
        leg_length_m: geometry.metres("leg_mm")?,
        leg_mass_kg: mass.number("leg_kg")?,
        leg_centroid_m: mass.metres("centroid_mm")?,
        gravity_m_per_s2: mass.number("gravity_m_per_s2")?,
    })
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
        // What it refuses of a single pose must not hide what is wrong with the file.
        Err(Error::Refused { quantity, reason }) if key_of(quantity).is_some() => {
            Err((quantity, reason))
        }
        _ if !(file.f_min_n..=file.f_max_n).contains(&file.pretension_n) => {
            Err((Quantity::Pretension, Reason::OutsideBounds))
        }
        _ => Ok(()),
    }
}
