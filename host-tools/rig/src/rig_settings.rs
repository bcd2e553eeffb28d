//! What a rig file may leave out, as it stands: each value with its unit, range, default and meaning.

use crate::actuator::{ACTUATOR, Actuator, CELL_RANGE, TEMPERATURE_RANGE, THERMAL};
use crate::calibration::{CALIBRATION, Calibration};
use crate::gains::{CONTROL, groups, widened};
use crate::motor_sections::motor_section;
use crate::number::{decimal, plain};
use crate::plant_settings::{CURRENT_OFFSET, PlantSettings, SIMULATION, TRANSVERSE_INERTIA};
use crate::rig_file::RigFile;
use crate::rig_file::derived::{self, Basis, GivenGains};
use leg_firmware::settings::{Field, Gains};
use serde::Serialize;

/// One number of a rig, or one for each end of a range or each axis.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Setting {
    /// The section of the rig file.
    pub section: String,
    /// Its key, which ends with its unit.
    pub key: &'static str,
    /// Its unit, `1` for a pure number.
    pub unit: &'static str,
    /// As it is.
    pub value: Vec<f64>,
    /// As it is unless the file gives it.
    pub default: Vec<f64>,
    /// Lowest and highest value.
    pub range: [f64; 2],
    /// What it means.
    pub meaning: String,
}

impl Setting {
    /// A key with a value and a default for each field or each axis.
    fn new(
        section: &str,
        fields: &[Field<f64>],
        value: impl Into<Vec<f64>>,
        default: impl Into<Vec<f64>>,
    ) -> Option<Self> {
        let (first, last) = (fields.first()?, fields.last()?);
        let meanings: Vec<_> = fields.iter().map(|field| field.meaning.trim()).collect();
        Some(Self {
            section: section.into(),
            key: first.name,
            unit: first.unit,
            value: value.into(),
            default: default.into(),
            range: [first.range[0], last.range[1]],
            meaning: meanings.join(" "),
        })
    }
}

/// The settings of a section, one for each field.
fn numbers(
    section: &str,
    fields: &[Field<f64>],
    values: impl IntoIterator<Item = f64>,
    defaults: impl IntoIterator<Item = f64>,
) -> Vec<Setting> {
    let values = values.into_iter().zip(defaults);
    let setting = |(field, (value, default)): (&Field<f64>, _)| {
        Setting::new(section, &[*field], [value], [default])
    };
    fields.iter().zip(values).filter_map(setting).collect()
}

/// The same settings of each motor: what all have in common once, then what they have differently, motor by motor.
fn merged(motors: [&Vec<Setting>; 3]) -> Vec<Setting> {
    let [first, second, third] = motors;
    let common: Vec<bool> = first
        .iter()
        .zip(second)
        .zip(third)
        .map(|((first, second), third)| first == second && second == third)
        .collect();
    let kept = |settings: &[Setting], wanted: bool| -> Vec<Setting> {
        let chosen = settings.iter().zip(&common);
        chosen
            .filter(|(_, common)| **common == wanted)
            .map(|(setting, _)| setting.clone())
            .collect()
    };
    let mut all = kept(first, true);
    for (motor, settings) in motors.into_iter().enumerate() {
        all.extend(kept(settings, false).into_iter().map(|setting| Setting {
            section: motor_section(&setting.section, motor),
            ..setting
        }));
    }
    all
}

/// Gains and limits of the control law.
#[must_use]
pub fn control(file: &RigFile) -> Vec<Setting> {
    let basis = Basis::new_all(file);
    let defaults = derived::gains(&basis, &Gains::default(), GivenGains::default());
    let mut values = file.gains.values().map(decimal);
    let mut defaults = defaults.values().map(decimal);
    let (mut all, mut motors) = (Vec::new(), Vec::<Vec<Setting>>::new());
    for group in groups() {
        let fields: Vec<_> = group.fields.iter().map(widened).collect();
        let values = values.by_ref().take(fields.len());
        let defaults = defaults.by_ref().take(fields.len());
        let section = format!("{CONTROL}.{}", group.section);
        let settings = numbers(&section, &fields, values, defaults);
        if group.motor.is_none() {
            all.extend(settings);
            continue;
        }
        motors.push(settings);
        if let [first, second, third] = &motors[..] {
            all.extend(merged([first, second, third]));
        }
    }
    all
}

/// Actuators, sensors and their calibration.
#[must_use]
pub fn actuator(file: &RigFile) -> Vec<Setting> {
    let motors = file.actuators.each_ref().map(actuator_settings);
    let mut all = merged(motors.each_ref());
    let (mut measured, mut nominal) = (file.calibration, Calibration::nominal(&file.actuators));
    for ((field, value), (_, default)) in measured.keys().into_iter().zip(nominal.keys()) {
        all.extend(Setting::new(CALIBRATION, &[field], *value, *default));
    }
    all
}

fn actuator_settings(actuator: &Actuator) -> Vec<Setting> {
    let default = Actuator::DEFAULT;
    let (values, defaults) = (actuator.values(), default.values());
    let mut all = numbers(ACTUATOR, Actuator::FIELDS, values, defaults);
    for (field, value) in THERMAL
        .iter()
        .zip([actuator.continuous_a, actuator.thermal_time_s])
    {
        all.extend(Setting::new(ACTUATOR, &[*field], value.as_slice(), []));
    }
    let cells = [actuator.cell_range_n, default.cell_range_n];
    let temperatures = [actuator.temperature_range_c, default.temperature_range_c];
    for (fields, [value, default]) in [(CELL_RANGE, cells), (TEMPERATURE_RANGE, temperatures)] {
        all.extend(Setting::new(ACTUATOR, &fields, value, default));
    }
    all
}

/// What else the simulated leg is.
#[must_use]
pub fn simulation(file: &RigFile) -> Vec<Setting> {
    let (plant, default) = (&file.plant, PlantSettings::DEFAULT);
    let (values, defaults) = (plant.values(), default.values());
    let mut all = numbers(SIMULATION, PlantSettings::FIELDS, values, defaults);
    let inertia = |plant: &PlantSettings| [plant.transverse_inertia_kg_m2(&file.parameters)];
    let [value, default] = [plant, &default].map(inertia);
    all.extend(Setting::new(
        SIMULATION,
        &[TRANSVERSE_INERTIA],
        value,
        default,
    ));
    all.extend(Setting::new(
        SIMULATION,
        &[CURRENT_OFFSET],
        plant.current_offset_a,
        PlantSettings::DEFAULT.current_offset_a,
    ));
    all
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
                "{gap}{heading:<28} {:>10} {:>10} {:>10} {:>10}  {:<9}  meaning\n",
                "value", "default", "lowest", "highest", "unit"
            );
            last = &setting.section;
        }
        let [low, high] = setting.range.map(plain);
        table += &format!(
            "{:<28} {:>10} {:>10} {low:>10} {high:>10}  {:<9}  {}\n",
            setting.key,
            written(&setting.value),
            written(&setting.default),
            setting.unit,
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

/// A number, or an array of them that are not all the same; a dash where the file gives none.
#[must_use]
pub fn written(values: &[f64]) -> String {
    match values {
        [] => "-".into(),
        [first, rest @ ..] if rest.iter().all(|other| other == first) => plain(*first),
        _ => {
            let entries: Vec<String> = values.iter().copied().map(plain).collect();
            format!("[{}]", entries.join(", "))
        }
    }
}
