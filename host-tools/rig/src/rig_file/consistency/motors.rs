//! Whether the motors can do what the settings ask of them.

mod homing;
mod monitored;
mod rest;

use super::{RigFile, Warning, place_of};
use crate::actuator::ACTUATOR;
use crate::gains::range_of;
use crate::number::{decimal, plain};
use crate::rig_file::derived::rules::{
    BORNE_S, MARGIN_DEG, homed_m_per_s, pulling_a, reachable_m_per_s,
};
use crate::rig_file::derived::{
    Basis, MotorGains, ServoLoop, two_digits, two_digits_above, two_digits_below,
};
use crate::toml_error::TomlError;
use crate::toml_section::Section;
use leg_firmware::settings::{Motion, SERVO};
use std::ops::Range;

/// Phase margin below which a servo rings whatever the motor, degrees.
const LEAST_MARGIN_DEG: f64 = 30.0;

/// Keys of `[actuator]` that say which motor it is.
const MOTOR_KEYS: [&str; 6] = [
    "resistance_ohm",
    "inductance_h",
    "torque_constant_nm_per_a",
    "inertia_kg_m2",
    "gear_ratio",
    "lead_m",
];

/// What all checks of a motor use.
struct Motor<'a> {
    file: &'a RigFile,
    root: &'a Section<'a>,
    /// From 0.
    motor: usize,
    /// What a message begins with.
    named: String,
    basis: Basis,
    gains: MotorGains,
    warnings: Vec<Warning>,
}

/// Checks each motor, or one of them if all are the same, and what they have together.
pub(super) fn check(file: &RigFile, root: &Section<'_>) -> Result<Vec<Warning>, TomlError> {
    let mut warnings = Vec::new();
    let bases = Basis::new_all(file);
    let same = |motor: usize| {
        file.actuators[motor] == file.actuators[0]
            && file.gains.servos[motor] == file.gains.servos[0]
            && file.calibration.m_per_count[motor] == file.calibration.m_per_count[0]
            && file.calibration.cell_n_per_code[motor] == file.calibration.cell_n_per_code[0]
    };
    let all_same = same(1) && same(2);
    for (motor, basis) in bases.into_iter().enumerate() {
        if motor > 0 && all_same {
            break;
        }
        let named = if all_same {
            String::new()
        } else {
            format!("motor {}: ", motor + 1)
        };
        let mut checked = Motor::new(file, root, motor, basis, named);
        checked.check_current()?;
        checked.check_driven_voltage()?;
        checked.check_heat()?;
        checked.check_speed()?;
        checked.check_homing_speed();
        checked.check_shown();
        checked.check_cell_step();
        checked.check_counts()?;
        checked.check_play();
        checked.check_following()?;
        checked.check_residual()?;
        checked.check_bandwidth()?;
        warnings.extend(checked.warnings);
    }
    // The one that homes the slowest.
    let homes = |motor: usize| homed_m_per_s(&bases[motor], &MotorGains::new(&file.gains, motor));
    let slowest = (0..bases.len()).min_by(|a, b| homes(*a).total_cmp(&homes(*b)));
    let motor = slowest.unwrap_or_default();
    let mut together = Motor::new(file, root, motor, bases[motor], String::new());
    together.check_disagreement()?;
    together.check_touch();
    together.check_stopped();
    together.check_duration();
    together.check_runaway();
    together.check_supply_dip();
    together.check_low_supply();
    warnings.extend(together.warnings);
    Ok(warnings)
}

impl<'a> Motor<'a> {
    fn new(
        file: &'a RigFile,
        root: &'a Section<'a>,
        motor: usize,
        basis: Basis,
        named: String,
    ) -> Self {
        Self {
            file,
            root,
            motor,
            named,
            basis,
            gains: MotorGains::new(&file.gains, motor),
            warnings: Vec::new(),
        }
    }

    /// The place of the first of the keys that the file gives.
    fn place(&self, keys: &[&str]) -> Range<usize> {
        let path =
            |key: &&str| place_of(&key.split('.').collect::<Vec<_>>(), self.motor, self.root);
        let given = keys.iter().find_map(path);
        given
            .or_else(|| place_of(&[ACTUATOR], self.motor, self.root))
            .unwrap_or(0..0)
    }

    fn refuse<T>(&self, keys: &[&str], sentence: String, help: String) -> Result<T, TomlError> {
        let sentence = [self.named.as_str(), &sentence].concat();
        Err(TomlError::new(self.place(keys), sentence, help))
    }

    fn warn(&mut self, keys: &[&str], text: String) {
        let span = self.place(keys);
        let text = [self.named.as_str(), &text].concat();
        self.warnings.push(Warning { span, text });
    }

    /// The current that the servo may drive has to pull the highest tension, and the supply has to drive it.
    fn check_current(&self) -> Result<(), TomlError> {
        let gains = &self.gains;
        let pulling_a = pulling_a(self.file.f_max_n, gains);
        let needed = plain(two_digits_above(pulling_a));
        let f_max = plain(self.file.f_max_n);
        let limit_a = decimal(gains.servo.current_a);
        let asked = format!(
            "a pull with `tendon.f_max_n` ({f_max} N) takes {} A",
            plain(two_digits(pulling_a))
        );
        let supply_v = decimal(gains.servo.duty_max) * self.basis.actuator.supply_v;
        let dropped_v = decimal(gains.servo.resistance_ohm) * pulling_a;
        if supply_v <= dropped_v {
            let needed = plain(two_digits_above(
                1.5 * dropped_v / decimal(gains.servo.duty_max),
            ));
            let sentence = format!(
                "`actuator.supply_v` ({}) cannot drive a motor at the maximum tension: {asked}, which is {} V at its \
                 resistance alone",
                plain(self.basis.actuator.supply_v),
                plain(two_digits(dropped_v))
            );
            let help = format!("give `supply_v` at least {needed}, or lower `f_max_n`");
            let keys = [
                "actuator.supply_v",
                "control.servo.resistance_ohm",
                "actuator.resistance_ohm",
                "tendon.f_max_n",
            ];
            return self.refuse(&keys, sentence, help);
        }
        if limit_a < pulling_a {
            let range = "actuator.current_range_a";
            let given = self.file.given_gains.has(SERVO, self.motor, "current_a");
            let range_a = two_digits_above(pulling_a / 0.45);
            let help = if given {
                format!("give `control.servo.current_a` at least {needed}, or lower `f_max_n`")
            } else if self.basis.actuator.current_range_a < range_a {
                format!(
                    "give `{range}` at least {}, or lower `f_max_n`",
                    plain(range_a)
                )
            } else {
                format!(
                    "take a motor whose `continuous_a` is at least {needed}, or lower `f_max_n`"
                )
            };
            let keys = [
                "control.servo.current_a",
                range,
                "actuator.continuous_a",
                "tendon.f_max_n",
            ];
            let sentence = format!(
                "`control.servo.current_a` ({}) cannot pull the maximum tension: {asked}",
                plain(limit_a)
            );
            return self.refuse(&keys, sentence, help);
        }
        Ok(())
    }

    /// Where the file says what the winding bears.
    fn check_heat(&mut self) -> Result<(), TomlError> {
        let (actuator, gains) = (self.basis.actuator, self.gains);
        let limit_a = decimal(gains.servo.current_a);
        let monitored_s = decimal(gains.limits.disagreement_time_s);
        let keys = ["control.servo.current_a", "actuator.continuous_a"];
        if let Some(borne_s) = actuator.bears_s(limit_a)
            && borne_s < 0.99 * BORNE_S
        {
            let borne_a = actuator.current_borne_a(BORNE_S).unwrap_or_default();
            let words = format!(
                "`control.servo.current_a` ({}) is more than the winding bears for {} s",
                plain(limit_a),
                plain(two_digits(borne_s))
            );
            let help = format!("give at most {}", plain(two_digits_below(borne_a)));
            if borne_s < monitored_s {
                let words = format!(
                    "{words}, and the monitors end it after {} s",
                    plain(monitored_s)
                );
                return self.refuse(&keys, words, help);
            }
            self.warn(&keys, format!("{words}: {help}"));
        }
        let pulling_a = pulling_a(self.file.f_max_n, &gains);
        if let Some(borne_s) = actuator.bears_s(pulling_a)
            && borne_s.is_finite()
        {
            let sentence = format!(
                "a motor that goes on pulling with `tendon.f_max_n` draws {} A, and bears that for {} s: `continuous_a` of {} \
                 would do",
                plain(two_digits(pulling_a)),
                plain(two_digits(borne_s)),
                plain(two_digits_above(pulling_a))
            );
            self.warn(&["actuator.continuous_a"], sentence);
        }
        Ok(())
    }

    /// The speed that the servo may ask for.
    fn check_speed(&mut self) -> Result<(), TomlError> {
        let gains = &self.gains;
        let servo = &gains.servo;
        let speed = decimal(servo.speed_m_per_s);
        let reachable = reachable_m_per_s(&self.basis, gains);
        let highest_v = decimal(servo.duty_max) * decimal(gains.limits.supply_max_v);
        let highest = highest_v / decimal(servo.back_emf_v_s_per_m).max(1e-9);
        let keys = [
            "control.servo.speed_m_per_s",
            "control.servo.back_emf_v_s_per_m",
            "actuator.supply_v",
        ];
        let words = format!("`control.servo.speed_m_per_s` ({})", plain(speed));
        let do_this = format!("give at most {}", plain(two_digits_below(reachable)));
        if speed > highest {
            let sentence = format!(
                "{words} is beyond every supply: at `supply_max_v` a motor without a load reaches {} m/s",
                plain(two_digits(highest))
            );
            return self.refuse(&keys, sentence, do_this);
        }
        if speed > 1.001 * reachable {
            let text = format!(
                "{words} is not reached at the nominal supply and the maximum tension: {do_this}"
            );
            self.warn(&keys, text);
        }
        let turn = decimal(self.file.gains.motion.speed_rad_per_s);
        if turn * self.basis.lever_m > 1.001 * speed {
            let keys = [
                "control.motion.speed_rad_per_s",
                "control.servo.speed_m_per_s",
            ];
            let text = format!(
                "`{}` ({}) asks the tendons for more than `{}` ({}): {}",
                keys[0],
                plain(turn),
                keys[1],
                plain(speed),
                self.speed_remedy(speed)
            );
            self.warn(&keys, text);
        }
        Ok(())
    }

    /// A turn that tendons of a speed, m/s, follow, or, where that is slower than any that may be given, a speed that follows the slowest.
    fn speed_remedy(&self, speed: f64) -> String {
        let fit = two_digits_below(0.9 * speed / self.basis.lever_m);
        let [slowest, _] = range_of(Motion::FIELDS, "speed_rad_per_s");
        if fit >= slowest {
            format!("give at most {}", plain(fit))
        } else {
            let least = two_digits_above(slowest * self.basis.lever_m / 0.9);
            format!(
                "no slower turn than {} may be given: let the tendons have at least {}",
                plain(slowest),
                plain(least)
            )
        }
    }

    /// The servo with the delays of its sampling, its speed and its winding.
    fn check_bandwidth(&mut self) -> Result<(), TomlError> {
        let given = self.file.given_gains;
        // What a board was set to says nothing of inertia and inductance.
        let known = MOTOR_KEYS
            .iter()
            .any(|key| place_of(&[ACTUATOR, key], self.motor, self.root).is_some());
        if !known && given.has(SERVO, self.motor, "back_emf_v_s_per_m") {
            return Ok(());
        }
        let servo = &self.gains.servo;
        let servo_loop = ServoLoop::new(&self.basis.actuator, servo);
        let margin = servo_loop.phase_margin_deg(servo);
        if margin >= MARGIN_DEG - 1.0 {
            return Ok(());
        }
        let fit = two_digits_below(servo_loop.highest_gain_per_s(MARGIN_DEG))
            .min(decimal(servo.position_gain_per_s));
        let keys = [
            "control.servo.position_gain_per_s",
            "control.servo.speed_gain_v_s_per_m",
            "control.servo.integral_time_s",
            "control.servo.tracking",
        ];
        let words = format!(
            "the servo with `control.servo.position_gain_per_s` ({}) and `speed_gain_v_s_per_m` ({}) has a phase margin of {margin:.0}° \
             with the delays of sampling, `tracking` and winding",
            plain(decimal(servo.position_gain_per_s)),
            plain(decimal(servo.speed_gain_v_s_per_m))
        );
        let help = format!(
            "give `position_gain_per_s` at most {}, and `speed_gain_v_s_per_m` {} or none of its own",
            plain(fit),
            plain(two_digits_below(ServoLoop::speed_gain_v_s_per_m(
                &self.basis.actuator,
                fit
            )))
        );
        if margin < LEAST_MARGIN_DEG {
            return self.refuse(&keys, format!("{words}: it rings"), help);
        }
        self.warn(&keys, format!("{words}: {help}"));
        Ok(())
    }
}
