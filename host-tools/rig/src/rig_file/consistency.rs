//! Whether motors, sensors and limits go together.

mod cells;
mod motors;
mod travels;

use super::RigFile;
use crate::actuator::{ACTUATOR, Actuator};
use crate::calibration::CALIBRATION;
use crate::gains::{CONTROL, range_of};
use crate::motor_sections::{MOTORS, motor_section};
use crate::number::{decimal, plain};
use crate::plant_settings::SIMULATION;
use crate::toml_error::TomlError;
use crate::toml_section::Section;
use leg_firmware::sensors::CURRENT_ZERO_PART;
use leg_firmware::settings::{AxisCalibration, Servo};
use std::ops::Range;

/// Something doubtful at a place of the file.
pub(super) struct Warning {
    pub span: Range<usize>,
    pub text: String,
}

/// Refuses what does not go together, and warns of what is doubtful. A file without these sections may describe no more than
/// a mechanism.
pub(super) fn check(file: &RigFile, root: &Section<'_>) -> Result<Vec<Warning>, TomlError> {
    if root.has(ACTUATOR) {
        for (motor, actuator) in file.actuators.iter().enumerate() {
            check_actuator(actuator, motor, root)?;
        }
    }
    if root.has(ACTUATOR) || root.has(CONTROL) || root.has(CALIBRATION) {
        check_limits(file, root)?;
        cells::check_noise(file, root)?;
        let warnings = motors::check(file, root)?;
        // After what a motor alone cannot do.
        for motor in 0..file.actuators.len() {
            check_driven(file, motor, root)?;
        }
        travels::check(file, root)?;
        return Ok(warnings);
    }
    if root.has(SIMULATION) {
        cells::check_noise(file, root)?;
    }
    Ok(Vec::new())
}

/// What several values of `[actuator]` make up together.
fn check_actuator(actuator: &Actuator, motor: usize, root: &Section<'_>) -> Result<(), TomlError> {
    let check_range = |what: &str, value: f64, [low, high]: [f64; 2], keys: &str| {
        if (low..=high).contains(&value) {
            return Ok(());
        }
        let [value, low, high] = [value, low, high].map(plain);
        Err(TomlError::new(
            place_of(&[ACTUATOR], motor, root).unwrap_or(0..0),
            format!("{what} comes out as {value}, outside {low} to {high}"),
            format!("correct one of {keys}"),
        ))
    };
    check_range(
        "the travel of a tendon in one encoder count, m,",
        actuator.m_per_count(),
        range_of(AxisCalibration::FIELDS, "m_per_count"),
        "`lead_m`, `gear_ratio` and `counts_per_turn`",
    )?;
    check_range(
        "the voltage that a motor induces by the speed of its tendon, V·s/m,",
        actuator.back_emf_v_s_per_m(),
        range_of(Servo::FIELDS, "back_emf_v_s_per_m"),
        "`torque_constant_nm_per_a`, `gear_ratio` and `lead_m`",
    )?;
    check_range(
        "the motor's mechanical time constant, s,",
        actuator.mechanical_time_s(),
        [2e-4, 10.0],
        "`resistance_ohm`, `inertia_kg_m2` and `torque_constant_nm_per_a`",
    )?;
    check_range(
        "how fast viscous friction stops the rotor, 1/s,",
        actuator.viscous_nm_s_per_rad / actuator.inertia_kg_m2,
        [0.0, 1e4],
        "`viscous_nm_s_per_rad` and `inertia_kg_m2`",
    )
}

/// Limits that have to be below others.
fn check_limits(file: &RigFile, root: &Section<'_>) -> Result<(), TomlError> {
    let limits = &file.gains.limits;
    let [actuator, ..] = &file.actuators;
    let supply = ("actuator.supply_v", actuator.supply_v);
    let supply_range = ("actuator.supply_range_v", actuator.supply_range_v);
    let supply_min = ("control.limits.supply_min_v", decimal(limits.supply_min_v));
    let supply_max = ("control.limits.supply_max_v", decimal(limits.supply_max_v));
    let at_start = "else the supply is a fault from the start";
    check_below(supply_min, supply, at_start, root)?;
    check_below(supply, supply_max, at_start, root)?;
    let reason = "else no sensor sees too high a supply";
    check_below(supply_max, supply_range, reason, root)?;

    for motor in 0..file.actuators.len() {
        check_motor_limits(file, motor, root)?;
    }

    let hot = (
        "control.limits.temperature_c",
        decimal(limits.temperature_c),
    );
    let hot_range = (
        "actuator.temperature_range_c",
        actuator.temperature_range_c[1],
    );
    let reason = "else no sensor sees that the drivers are too hot";
    check_below(hot, hot_range, reason, root)?;

    let slack = ("control.limits.slack_n", decimal(limits.slack_n));
    let reason = "else a tendon at the minimum tension is taken as slack";
    check_below(slack, ("tendon.f_min_n", file.f_min_n), reason, root)?;

    let homing = &file.gains.homing;
    let touch = ("control.homing.touch_n", decimal(homing.touch_n));
    let ceiling = ("control.homing.f_max_n", decimal(homing.f_max_n));
    let reason = "else no tendon is found taut while homing";
    check_below(touch, ceiling, reason, root)?;
    let reason = "else homing pulls more than the tendons bear";
    check_at_most(ceiling, ("tendon.f_max_n", file.f_max_n), reason, root)
}

/// The same of what a motor, from 0, may have for itself.
fn check_motor_limits(file: &RigFile, motor: usize, root: &Section<'_>) -> Result<(), TomlError> {
    let (actuator, limits) = (&file.actuators[motor], &file.gains.limits);
    let own = |path: &str| own_path(path, motor, root);
    let [range, cells] = ["actuator.current_range_a", "actuator.cell_range_n"].map(own);
    let current = ("control.limits.current_a", decimal(limits.current_a));
    let current_range = (range.as_str(), actuator.current_range_a);
    check_current_range(current, current_range, root)?;

    let cell_range = (cells.as_str(), actuator.cell_range_n[1]);
    let reason = "else no load cell sees too much tension";
    check_below(("tendon.f_max_n", file.f_max_n), cell_range, reason, root)?;
    cells::check(file, motor, root)?;

    let servo = own("control.servo.speed_m_per_s");
    let fastest = (
        servo.as_str(),
        decimal(file.gains.servos[motor].speed_m_per_s),
    );
    let homing = (
        "control.homing.speed_m_per_s",
        decimal(file.gains.homing.speed_m_per_s),
    );
    let reason = "else a motor that homes is faster than its servo may be";
    check_at_most(homing, fastest, reason, root)?;
    let ramp = ("control.limits.ramp_m_per_s", decimal(limits.ramp_m_per_s));
    let reason = "else a motor that relaxes its tendon is faster than its servo may be";
    check_at_most(ramp, fastest, reason, root)
}

/// Refuses a servo that drives more than the limit, at the smallest range of a current sensor where neither is given: that bounds
/// the limit.
fn check_driven(file: &RigFile, motor: usize, root: &Section<'_>) -> Result<(), TomlError> {
    let servo = own_path("control.servo.current_a", motor, root);
    let driven = (servo.as_str(), decimal(file.gains.servos[motor].current_a));
    let current = (
        "control.limits.current_a",
        decimal(file.gains.limits.current_a),
    );
    let reason = "else the servo drives more than the limit";
    let checked = check_below(driven, current, reason, root);
    checked.map_err(|error| {
        let ranges_a = file
            .actuators
            .iter()
            .map(|actuator| actuator.current_range_a);
        let least = ranges_a.enumerate().min_by(|a, b| a.1.total_cmp(&b.1));
        let place = least
            .filter(|_| error.span.is_empty())
            .and_then(|(motor, _)| place_of(&[ACTUATOR, "current_range_a"], motor, root));
        match place {
            Some(span) => TomlError { span, ..error },
            None => error,
        }
    })
}

/// The path of a key as the file gives it for a motor, from 0: in the motor's own section or in that of all.
pub(super) fn own_path(path: &str, motor: usize, root: &Section<'_>) -> String {
    let Some((section, key)) = path.rsplit_once('.') else {
        return path.into();
    };
    let own = format!("{}.{key}", motor_section(section, motor));
    match root.place(&own.split('.').collect::<Vec<_>>()) {
        Some(_) => own,
        None => path.into(),
    }
}

/// The place of a key or a section in a motor's own section or, if it is not there, in that of all.
pub(super) fn place_of(path: &[&str], motor: usize, root: &Section<'_>) -> Option<Range<usize>> {
    let number = MOTORS.get(motor).copied().unwrap_or_default();
    let own = match path.split_last() {
        Some((key, section)) if !section.is_empty() => [section, &[number, *key]].concat(),
        _ => [path, &[number]].concat(),
    };
    root.place(&own).or_else(|| root.place(path))
}

/// Refuses a limit that a current sensor does not reach whose zero is off by the most that the start takes.
fn check_current_range(
    limit: (&str, f64),
    range: (&str, f64),
    root: &Section<'_>,
) -> Result<(), TomlError> {
    let reason = "else no sensor sees too much current";
    check_below(limit, range, reason, root)?;
    let part = 1.0 - decimal(CURRENT_ZERO_PART);
    if limit.1 < part * range.1 {
        return Ok(());
    }
    let place = |path: &str| root.place(&path.split('.').collect::<Vec<_>>());
    let [limited, ranged] =
        [limit, range].map(|(path, value)| format!("`{path}` ({})", plain(value)));
    Err(TomlError::new(
        place(limit.0).or(place(range.0)).unwrap_or(0..0),
        format!("{limited} has to be below {} of {ranged}", plain(part)),
        "else no sensor whose zero is off sees too much current",
    ))
}

/// Refuses two values, each with the path of its key, of which the first is not below the second; at the place of one
/// that is given.
fn check_below(
    low: (&str, f64),
    high: (&str, f64),
    reason: &str,
    root: &Section<'_>,
) -> Result<(), TomlError> {
    if low.1 < high.1 {
        return Ok(());
    }
    Err(disordered([low, high], "has to be below", reason, root))
}

/// The same of a first value that may be the second one.
fn check_at_most(
    low: (&str, f64),
    high: (&str, f64),
    reason: &str,
    root: &Section<'_>,
) -> Result<(), TomlError> {
    if low.1 <= high.1 {
        return Ok(());
    }
    Err(disordered([low, high], "has to be at most", reason, root))
}

/// What is wrong with two values, each with the path of its key; at the place of the second one, or of the first where that is not given.
fn disordered(pair: [(&str, f64); 2], order: &str, reason: &str, root: &Section<'_>) -> TomlError {
    let place = |path: &str| root.place(&path.split('.').collect::<Vec<_>>());
    let [low, high] = pair.map(|(path, _)| place(path));
    let [lower, higher] = pair.map(|(path, value)| format!("`{path}` ({})", plain(value)));
    TomlError::new(
        high.or(low).unwrap_or(0..0),
        format!("{lower} {order} {higher}"),
        reason,
    )
}

#[cfg(test)]
mod tests;
