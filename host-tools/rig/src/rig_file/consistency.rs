//! Whether motors, sensors and limits go together.

use super::RigFile;
use crate::actuator::ACTUATOR;
use crate::gains::{CONTROL, widened};
use crate::number::{decimal, plain};
use crate::toml_error::TomlError;
use crate::toml_section::Section;
use leg_firmware::settings::{AxisCalibration, Field, Servo};
use std::ops::RangeInclusive;

/// What several values of `[actuator]` make up: its name, its value, its range and the keys that make it up.
type Combination = (&'static str, f64, RangeInclusive<f64>, &'static str);

/// A value with the path of its key.
type Value = (&'static str, f64);

/// Two values, the first of which has to be below the second, and why.
type Pair = (Value, Value, &'static str);

/// Refuses what does not go together. A file without these sections may describe no more than a mechanism.
pub(super) fn check(file: &RigFile, root: &Section<'_>) -> Result<(), TomlError> {
    if root.has(ACTUATOR) {
        for combination in combinations(file) {
            check_combination(&combination, root)?;
        }
    }
    if root.has(ACTUATOR) || root.has(CONTROL) {
        for pair in pairs(file) {
            check_pair(&pair, root)?;
        }
    }
    Ok(())
}

fn combinations(file: &RigFile) -> [Combination; 4] {
    let actuator = &file.actuator;
    let range = |fields: &[Field], name: &str| {
        let field = fields.iter().find(|field| field.name == name);
        let [low, high] = field.map_or([f64::NAN; 2], |field| widened(field).range);
        low..=high
    };
    [
        (
            "the travel of a tendon in one encoder count, m,",
            actuator.m_per_count(),
            range(AxisCalibration::FIELDS, "m_per_count"),
            "`lead_m`, `gear_ratio` and `counts_per_turn`",
        ),
        (
            "the voltage that a motor induces by the speed of its tendon, V·s/m,",
            actuator.back_emf_v_s_per_m(),
            range(Servo::FIELDS, "back_emf_v_s_per_m"),
            "`torque_constant_nm_per_a`, `gear_ratio` and `lead_m`",
        ),
        (
            "the motor's mechanical time constant, s,",
            actuator.mechanical_time_s(),
            2e-4..=10.0,
            "`resistance_ohm`, `inertia_kg_m2` and `torque_constant_nm_per_a`",
        ),
        (
            "how fast viscous friction stops the rotor, 1/s,",
            actuator.viscous_nm_s_per_rad / actuator.inertia_kg_m2,
            0.0..=1e4,
            "`viscous_nm_s_per_rad` and `inertia_kg_m2`",
        ),
    ]
}

fn check_combination(
    (what, value, range, keys): &Combination,
    root: &Section<'_>,
) -> Result<(), TomlError> {
    if range.contains(value) {
        return Ok(());
    }
    let [value, low, high] = [value, range.start(), range.end()].map(|number| plain(*number));
    Err(TomlError::new(
        root.place(&[ACTUATOR]).unwrap_or(0..0),
        format!("{what} comes out as {value}, outside {low} to {high}"),
        format!("correct one of {keys}"),
    ))
}

fn pairs(file: &RigFile) -> [Pair; 8] {
    let (actuator, limits) = (&file.actuator, &file.gains.limits);
    let gain = |key, value| (key, decimal(value));
    let supply_min = gain("control.limits.supply_min_v", limits.supply_min_v);
    let supply_max = gain("control.limits.supply_max_v", limits.supply_max_v);
    let driven = gain("control.servo.current_a", file.gains.servo.current_a);
    let current = gain("control.limits.current_a", limits.current_a);
    let hot = gain("control.limits.temperature_c", limits.temperature_c);
    let slack = gain("control.limits.slack_n", limits.slack_n);
    let supply = ("actuator.supply_v", actuator.supply_v);
    let supply_range = ("actuator.supply_range_v", actuator.supply_range_v);
    let current_range = ("actuator.current_range_a", actuator.current_range_a);
    let [_, hot_c] = actuator.temperature_range_c;
    let hot_range = ("actuator.temperature_range_c", hot_c);
    let [_, taut_n] = actuator.cell_range_n;
    let cell_range = ("actuator.cell_range_n", taut_n);
    let f_min = ("tendon.f_min_n", file.f_min_n);
    let f_max = ("tendon.f_max_n", file.f_max_n);
    let at_start = "else the supply is a fault from the start";
    let slack_at_min = "else a tendon at the minimum tension is taken as slack";
    let too_hot = "else no sensor sees that the drivers are too hot";
    [
        (supply_min, supply, at_start),
        (supply, supply_max, at_start),
        (
            supply_max,
            supply_range,
            "else no sensor sees too high a supply",
        ),
        (driven, current, "else the servo drives more than the limit"),
        (
            current,
            current_range,
            "else no sensor sees too much current",
        ),
        (hot, hot_range, too_hot),
        (f_max, cell_range, "else no load cell sees too much tension"),
        (slack, f_min, slack_at_min),
    ]
}

/// The place of a refusal is that of a value that is given.
fn check_pair((low, high, reason): &Pair, root: &Section<'_>) -> Result<(), TomlError> {
    if low.1 < high.1 {
        return Ok(());
    }
    let place = |(path, _): &Value| root.place(&path.split('.').collect::<Vec<_>>());
    let span = place(high).or(place(low)).unwrap_or(0..0);
    let [low, high] = [low, high].map(|(path, value)| format!("`{path}` ({})", plain(*value)));
    Err(TomlError::new(
        span,
        format!("{low} has to be below {high}"),
        *reason,
    ))
}
