//! What a rig file may leave out, as it stands: each value with its range, its default and its meaning.

use crate::actuator::{Actuator, CELL_RANGE, TEMPERATURE_RANGE};
use crate::calibration::{
    CELL_N_PER_CODE, CELL_ZERO_CODE, COUNTS_SIGN, CURRENT_A_PER_CODE, Calibration, M_PER_COUNT,
};
use crate::fields::{Field, decimal, plain};
use crate::gains::Gains;
use crate::plant_settings::{PlantSettings, TRANSVERSE_INERTIA};
use crate::rig_file::RigFile;
use leg_base::failure::Failure;
use leg_base::json_line::to_line;
use leg_firmware::settings::SECTIONS;
use serde::Serialize;

/// One number of a rig, or one for each end of a range or each axis.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Setting {
    /// The section of the rig file.
    pub section: String,
    /// Its key, which ends with its unit.
    pub key: &'static str,
    /// As it is.
    pub value: Vec<f64>,
    /// As it is unless the file gives it.
    pub default: Vec<f64>,
    /// Lowest and highest value.
    pub range: [f64; 2],
    /// What it means.
    pub meaning: String,
}

/// Gains and limits of the control law.
#[must_use]
pub fn control(file: &RigFile) -> Vec<Setting> {
    let defaults = Gains::defaults(&file.actuator).values();
    let sections = SECTIONS.iter().zip(file.gains.values()).zip(defaults);
    sections
        .flat_map(|(((name, fields), values), defaults)| {
            let section = format!("control.{name}");
            let fields: Vec<Field> = fields.iter().map(Field::from).collect();
            let [values, defaults] =
                [values, defaults].map(|all| all.into_iter().map(decimal).collect::<Vec<_>>());
            numbers(&section, &fields, &values, &defaults)
        })
        .collect()
}

/// Actuators, sensors and their calibration.
#[must_use]
pub fn actuator(file: &RigFile) -> Vec<Setting> {
    let (actuator, default) = (&file.actuator, Actuator::DEFAULT);
    let mut all = numbers(
        "actuator",
        &Actuator::fields(),
        &actuator.values(),
        &default.values(),
    );
    let range = |[low, high]: [Field; 2], value: [f64; 2], default: [f64; 2]| Setting {
        section: "actuator".into(),
        key: low.name,
        value: value.into(),
        default: default.into(),
        range: [low.range[0], high.range[1]],
        meaning: [low.meaning, high.meaning].join(" "),
    };
    all.push(range(
        CELL_RANGE,
        actuator.cell_range_n,
        default.cell_range_n,
    ));
    all.push(range(
        TEMPERATURE_RANGE,
        actuator.temperature_range_c,
        default.temperature_range_c,
    ));
    all.extend(calibration(file));
    all
}

fn calibration(file: &RigFile) -> Vec<Setting> {
    let measured = file.calibration.complete(&file.actuator);
    let nominal = Calibration::default().complete(&file.actuator);
    let of_axes = |field: Field, value: [f64; 3], default: [f64; 3]| {
        setting("calibration", &field, value.into(), default.into())
    };
    vec![
        of_axes(M_PER_COUNT, measured.m_per_count, nominal.m_per_count),
        of_axes(COUNTS_SIGN, measured.counts_sign, nominal.counts_sign),
        of_axes(
            CELL_N_PER_CODE,
            measured.cell_n_per_code,
            nominal.cell_n_per_code,
        ),
        of_axes(
            CELL_ZERO_CODE,
            measured.cell_zero_code,
            nominal.cell_zero_code,
        ),
        of_axes(
            CURRENT_A_PER_CODE,
            measured.current_a_per_code,
            nominal.current_a_per_code,
        ),
    ]
}

/// What else the simulated leg is.
#[must_use]
pub fn simulation(file: &RigFile) -> Vec<Setting> {
    let (plant, default) = (&file.plant, PlantSettings::DEFAULT);
    let mut all = numbers(
        "simulation",
        &PlantSettings::fields(),
        &plant.values(),
        &default.values(),
    );
    let inertia = |plant: &PlantSettings| vec![plant.transverse_inertia_kg_m2(&file.parameters)];
    all.push(setting(
        "simulation",
        &TRANSVERSE_INERTIA,
        inertia(plant),
        inertia(&default),
    ));
    all
}

fn numbers(section: &str, fields: &[Field], values: &[f64], defaults: &[f64]) -> Vec<Setting> {
    let values = values.iter().zip(defaults);
    fields
        .iter()
        .zip(values)
        .map(|(field, (value, default))| setting(section, field, vec![*value], vec![*default]))
        .collect()
}

fn setting(section: &str, field: &Field, value: Vec<f64>, default: Vec<f64>) -> Setting {
    Setting {
        section: section.into(),
        key: field.name,
        value,
        default,
        range: field.range,
        meaning: field.meaning.into(),
    }
}

/// A table for people, a part for each section.
#[must_use]
pub fn table(settings: &[Setting]) -> String {
    let mut table = String::new();
    let mut last = "";
    for setting in settings {
        if setting.section != last {
            let gap = if last.is_empty() { "" } else { "\n" };
            let heading = format!("[{}]", setting.section);
            table += &format!(
                "{gap}{heading:<28} {:>10} {:>10} {:>10} {:>10}  meaning\n",
                "value", "default", "lowest", "highest"
            );
            last = &setting.section;
        }
        let [low, high] = setting.range.map(plain);
        table += &format!(
            "{:<28} {:>10} {:>10} {low:>10} {high:>10}  {}\n",
            setting.key,
            written(&setting.value),
            written(&setting.default),
            setting.meaning
        );
    }
    table
}

/// One line for each value that is not its default; empty if all are.
#[must_use]
pub fn changes(file: &RigFile) -> String {
    let all = [control(file), actuator(file), simulation(file)].concat();
    let changed = all
        .iter()
        .filter(|setting| setting.value != setting.default);
    changed
        .map(|setting| {
            let (value, default) = (written(&setting.value), written(&setting.default));
            let Setting { section, key, .. } = setting;
            format!("{section:<22} {key} = {value} instead of {default}\n")
        })
        .collect()
}

/// A number, or an array of them that are not all the same.
fn written(values: &[f64]) -> String {
    match values {
        [first, rest @ ..] if rest.iter().all(|other| other == first) => plain(*first),
        _ => {
            let entries: Vec<String> = values.iter().copied().map(plain).collect();
            format!("[{}]", entries.join(", "))
        }
    }
}

/// One line of JSON for machines.
///
/// # Errors
/// A [`Failure`] if the numbers have no form in JSON.
pub fn json(settings: &[Setting]) -> Result<String, Failure> {
    to_line(settings)
}
