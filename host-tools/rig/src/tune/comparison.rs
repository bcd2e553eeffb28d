//! What was measured beside what a rig file says, and as a section for one.

use super::MeasuredMotor;
use super::estimate::UncertainValue;
use super::motor::MotorConstants;
use super::servo::{MeasuredServo, configured_servo};
use super::swing::Swings;
use crate::actuator::{ACTUATOR, Actuator};
use crate::loop_response::Margins;
use crate::motor_sections::motor_section;
use crate::number::{plain, significant};
use crate::plant_settings::{SIMULATION, TRANSVERSE_INERTIA};
use crate::rig_file::{ELONGATION_FACTOR, MEASURED_TENDON, RigFile};
use serde::Serialize;

/// A quantity, as measured and as configured.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ComparisonRow {
    /// What it is.
    pub name: String,
    /// Its unit.
    pub unit: &'static str,
    /// As measured.
    pub measured: UncertainValue,
    /// As the rig file says or implies; none where that says nothing.
    pub configured: Option<f64>,
    /// The section and the key that hold it; none where it follows from others.
    pub key: Option<(String, &'static str)>,
}

/// All that was measured at a motor beside what the rig says.
#[must_use]
pub fn comparison(
    motor: &MeasuredMotor,
    swings: Option<&Swings>,
    rig: &RigFile,
) -> Vec<ComparisonRow> {
    let own = usize::from(motor.motor).saturating_sub(1);
    let actuator = rig.actuators.get(own).unwrap_or(&Actuator::DEFAULT);
    let section = motor_section(ACTUATOR, own);
    let mut rows = motor_rows(&motor.constants, actuator, &section);
    let servo = motor.servo.as_ref();
    rows.extend(
        servo
            .into_iter()
            .flat_map(|servo| servo_rows(servo, motor.motor, rig)),
    );
    rows.extend(
        swings
            .into_iter()
            .flat_map(|swings| swing_rows(swings, rig, own)),
    );
    rows
}

fn motor_rows(motor: &MotorConstants, actuator: &Actuator, section: &str) -> Vec<ComparisonRow> {
    let row = |name: &str, unit, measured, configured| ComparisonRow {
        name: name.into(),
        unit,
        measured,
        configured: Some(configured),
        key: None,
    };
    let keyed = |key, unit, measured, configured| ComparisonRow {
        key: Some((section.into(), key)),
        ..row(key, unit, measured, configured)
    };
    let m_per_rad = actuator.m_per_rad();
    let torque_constant = motor.back_emf_v_s_per_m.scaled(m_per_rad);
    let [friction_in, friction_out] = motor.friction_a.map(|amps| amps.times(torque_constant));
    let [pull_in, pull_out] = motor.pull_a_per_n;
    let efficiency = pull_in
        .times(torque_constant)
        .inverse()
        .scaled(m_per_rad / actuator.gear_efficiency);
    let pays_out = (1.0 - 2.0 * actuator.screw_efficiency) * actuator.pull_a_per_n();
    let viscous = motor.viscous_a_s_per_m.times(torque_constant);
    vec![
        keyed(
            "resistance_ohm",
            "Ω",
            motor.resistance_ohm,
            actuator.resistance_ohm,
        ),
        keyed(
            "torque_constant_nm_per_a",
            "N·m/A",
            torque_constant,
            actuator.torque_constant_nm_per_a,
        ),
        row(
            "friction, pulling in",
            "N·m",
            friction_in,
            actuator.friction_nm,
        ),
        row(
            "friction, paying out",
            "N·m",
            friction_out,
            actuator.friction_nm,
        ),
        keyed(
            "friction_nm",
            "N·m",
            friction_in.mean_of_one_fit(friction_out),
            actuator.friction_nm,
        ),
        keyed(
            "viscous_nm_s_per_rad",
            "N·m·s/rad",
            viscous.scaled(m_per_rad),
            actuator.viscous_nm_s_per_rad,
        ),
        keyed(
            "screw_efficiency",
            "1",
            efficiency,
            actuator.screw_efficiency,
        ),
        row("pull, pulling in", "A/N", pull_in, actuator.pull_a_per_n()),
        row("pull, paying out", "A/N", pull_out, pays_out),
        row("voltage lost in the driver", "V", motor.driver_loss_v, 0.0),
    ]
}

fn servo_rows(servo: &MeasuredServo, motor: u8, rig: &RigFile) -> Vec<ComparisonRow> {
    let margins = Margins::new(&configured_servo(motor, rig));
    let row = |name: String, unit, measured, configured| ComparisonRow {
        name,
        unit,
        measured,
        configured,
        key: None,
    };
    let of_loop = |name: &str, unit, measured: Option<UncertainValue>, configured| {
        Some(row(format!("servo, {name}"), unit, measured?, configured))
    };
    let step_mm = 1000.0 * servo.step_m;
    let step = [
        row(
            format!("servo, overshoot of {step_mm:.2} mm"),
            "%",
            servo.overshoot.scaled(100.0),
            None,
        ),
        row(
            "servo, within 5 % after".into(),
            "ms",
            servo.settled_s.scaled(1000.0),
            None,
        ),
    ];
    let of_loop = [
        of_loop("crossover", "Hz", servo.crossover_hz, margins.phase_hz),
        of_loop(
            "phase margin",
            "°",
            servo.phase_margin_deg,
            margins.phase_deg,
        ),
        of_loop("gain margin", "dB", servo.gain_margin_db, margins.gain_db),
    ];
    step.into_iter()
        .chain(of_loop.into_iter().flatten())
        .collect()
}

fn swing_rows(swings: &Swings, rig: &RigFile, own: usize) -> Vec<ComparisonRow> {
    let first_mode = swings.all.iter().map(|swing| ComparisonRow {
        name: format!("first mode at {:.0} N", swing.pretension_n),
        unit: "Hz",
        measured: swing.frequency_hz,
        configured: Some(swing.configured_hz),
        key: None,
    });
    let inertia = ComparisonRow {
        name: TRANSVERSE_INERTIA.name.into(),
        unit: TRANSVERSE_INERTIA.unit,
        measured: swings.inertia_kg_m2,
        configured: Some(rig.plant.transverse_inertia_kg_m2(&rig.parameters)),
        key: Some((SIMULATION.into(), TRANSVERSE_INERTIA.name)),
    };
    let travels = swings.travels.map(|travels| {
        let [low_n, high_n] = travels.tensions_n;
        let stretch = ComparisonRow {
            name: format!("stretch, {low_n:.0} to {high_n:.0} N"),
            unit: "mm",
            measured: travels.stretch_m.scaled(1000.0),
            configured: swings.configured_stretch_m.map(|m| 1000.0 * m),
            key: None,
        };
        let factor = swings.stretched().map(|stretched| ComparisonRow {
            name: ELONGATION_FACTOR.name.into(),
            unit: ELONGATION_FACTOR.unit,
            measured: stretched.scaled(rig.elongation_factor),
            configured: Some(rig.elongation_factor),
            key: Some((MEASURED_TENDON.into(), ELONGATION_FACTOR.name)),
        });
        let plays = play_rows(travels.play_m, rig, own);
        plays.into_iter().chain([stretch]).chain(factor)
    });
    travels
        .into_iter()
        .flatten()
        .chain(first_mode)
        .chain([inertia])
        .collect()
}

/// The play of the gears. The pretension moves the three motors together, and the leg leans by what their plays differ by: the travels tell the mean alone.
/// It is that of each motor where the file says that the three are alike.
fn play_rows(play_m: UncertainValue, rig: &RigFile, own: usize) -> Vec<ComparisonRow> {
    let row = |name: String, lead_m: f64, configured_m: f64, key| ComparisonRow {
        name,
        unit: "rad",
        measured: play_m.scaled(std::f64::consts::TAU / lead_m),
        configured: Some(configured_m * std::f64::consts::TAU / lead_m),
        key,
    };
    let [first, ..] = &rig.actuators;
    let alike = |actuator: &Actuator| actuator.play_m() == first.play_m();
    if rig.actuators.iter().all(alike) {
        // That of the measured motor first: what a file takes of it stands together.
        let mut motors: Vec<_> = rig.actuators.iter().enumerate().collect();
        motors.sort_by_key(|&(motor, _)| motor != own);
        let each = motors.into_iter().map(|(motor, actuator)| {
            let key = (motor_section(ACTUATOR, motor), "backlash_rad");
            let name = format!("backlash_rad, motor {}", motor + 1);
            row(name, actuator.lead_m, actuator.play_m(), Some(key))
        });
        return each.collect();
    }
    let mean = |value: fn(&Actuator) -> f64| rig.actuators.iter().map(value).sum::<f64>() / 3.0;
    let name = "backlash_rad, mean of three that differ".into();
    vec![row(
        name,
        mean(|actuator| actuator.lead_m),
        mean(Actuator::play_m),
        None,
    )]
}

/// A table for people.
#[must_use]
pub fn table(rows: &[ComparisonRow]) -> String {
    let mut table = format!(
        "{:<30} {:>10} {:>10} {:>10} {:>11}  unit\n",
        "", "measured", "±", "configured", "difference"
    );
    for row in rows {
        let UncertainValue { value, uncertainty } = row.measured;
        let configured = row
            .configured
            .map_or_else(String::new, |number| plain(significant(number, 4)));
        let difference = row
            .configured
            .filter(|&number| number != 0.0)
            .map_or_else(String::new, |number| {
                format!("{:+.1} %", 100.0 * (value / number - 1.0))
            });
        table += &format!(
            "{:<30} {:>10} {:>10} {configured:>10} {difference:>11}  {}\n",
            row.name,
            written(value, uncertainty),
            plain(significant(uncertainty, 2)),
            row.unit,
        );
    }
    table
}

/// What a rig file takes of a measured quantity.
enum Entry {
    Number(String),
    TooUncertain,
    /// It is not within these.
    OutOfRange([f64; 2]),
}

impl Entry {
    /// The section, the key and what that takes; none where no key holds the quantity.
    fn new(row: &ComparisonRow) -> Option<(&str, &'static str, Self)> {
        let (section, key) = row.key.as_ref()?;
        let UncertainValue { value, uncertainty } = row.measured;
        let entry = if !row.measured.is_certain() || value <= 0.0 {
            Self::TooUncertain
        } else {
            match range(key) {
                Some([low, high]) if value < low || value > high => Self::OutOfRange([low, high]),
                _ => Self::Number(written(value, uncertainty)),
            }
        };
        Some((section, key, entry))
    }
}

/// What was measured with certainty and a rig file takes: its section, its key, its value.
#[must_use]
pub fn certain_values(rows: &[ComparisonRow]) -> Vec<(String, &'static str, String)> {
    let values = rows.iter().filter_map(|row| match Entry::new(row)? {
        (section, key, Entry::Number(number)) => Some((section.into(), key, number)),
        _ => None,
    });
    values.collect()
}

/// What was measured with certainty, as sections of a rig file; what such a file does not take, or is uncertain, as a comment.
#[must_use]
pub fn section(motor: u8, rows: &[ComparisonRow]) -> String {
    let mut text =
        format!("# Measured by leg tune at motor {motor}; ± holds in 95 of 100 cases.\n");
    let mut last = "";
    for row in rows {
        let Some((section, key, entry)) = Entry::new(row) else {
            continue;
        };
        let UncertainValue { value, uncertainty } = row.measured;
        let off = plain(significant(uncertainty, 2));
        let measured = format!("{} ± {off}", written(value, uncertainty));
        match entry {
            Entry::TooUncertain => text += &format!("# {key} is too uncertain: {measured}\n"),
            Entry::OutOfRange(range) => {
                let [low, high] = range.map(plain);
                text += &format!("# {key} is not within {low} to {high}: {measured}\n");
            }
            Entry::Number(number) => {
                if section != last {
                    text += &format!("\n[{section}]\n");
                    last = section;
                }
                let configured = row.configured.map_or_else(String::new, |number| {
                    format!(", was {}", plain(significant(number, 4)))
                });
                text += &format!("{key} = {number}  # ± {off}{configured}\n");
            }
        }
    }
    text
}

/// What a rig file may say of a key.
fn range(key: &str) -> Option<[f64; 2]> {
    let mut fields = Actuator::FIELDS
        .iter()
        .chain([&TRANSVERSE_INERTIA, &ELONGATION_FACTOR]);
    fields
        .find(|field| field.name == key)
        .map(|field| field.range)
}

/// A number to the second digit of its uncertainty.
fn written(value: f64, uncertainty: f64) -> String {
    let last = significant(uncertainty, 2).log10().floor() - 1.0;
    let digits = 1.0 + value.abs().log10().floor() - last;
    plain(significant(value, digits.clamp(1.0, 6.0) as usize))
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test may panic")]
mod tests {
    use super::{UncertainValue, play_rows, section};
    use crate::rig_file::RigFile;

    /// A mean is that of each motor only where they are alike.
    #[test]
    fn the_mean_play_is_written_for_motors_that_are_alike() {
        let mut rig = RigFile::load(None).unwrap();
        let play_m = UncertainValue::new(3e-6, 1e-8);
        let alike = section(2, &play_rows(play_m, &rig, 1));
        let place = |key: &str| alike.find(key).unwrap();
        assert!(place("[actuator.2]") < place("[actuator.1]"), "{alike}");
        assert_eq!(alike.matches("backlash_rad = ").count(), 3, "{alike}");
        rig.actuators[0].backlash_rad *= 2.0;
        let rows = play_rows(play_m, &rig, 1);
        assert!(rows.iter().all(|row| row.name.contains("mean of three")));
        assert!(!section(2, &rows).contains("backlash_rad = "));
    }
}
