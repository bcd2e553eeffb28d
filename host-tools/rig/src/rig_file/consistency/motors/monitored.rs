//! Whether the monitors of a motor can find what they look for, and nothing where all is well.

use super::Motor;
use crate::number::{decimal, plain};
use crate::rig_file::consistency::cells::STEP_CODES;
use crate::rig_file::derived::{two_digits, two_digits_above, two_digits_below};
use crate::toml_error::TomlError;
use leg_firmware::control::LIMITED_AHEAD_M;
use leg_firmware::supervisor::{AWAY_PART, JAMMED_PART};
use leg_model::Elasticity;

/// Multiple of the maximum tension that a motor which runs away may pull with before it is found, more than which is warned of.
const RUNAWAY_MULTIPLE: f64 = 2.0;

/// The least that `following_m` may be by the dead band of a servo, m.
fn least_following_m(dead_band_m: f64) -> f64 {
    (decimal(LIMITED_AHEAD_M) / 0.9).max(1.1 * dead_band_m)
}

impl Motor<'_> {
    /// One that is jammed or counts the wrong way gets no more voltage than the supply has.
    pub(super) fn check_driven_voltage(&mut self) -> Result<(), TomlError> {
        let (servo, limits) = (&self.gains.servo, &self.gains.limits);
        let (part, jammed_part) = (decimal(limits.driven_part), decimal(JAMMED_PART));
        let driven_v = part * decimal(servo.current_a) * decimal(servo.resistance_ohm);
        let supply_part = jammed_part * decimal(servo.duty_max);
        let supply_v = supply_part * self.basis.actuator.supply_v;
        if driven_v <= supply_v && part <= jammed_part {
            return Ok(());
        }
        let keys = [
            "control.limits.driven_part",
            "control.servo.current_a",
            "control.servo.resistance_ohm",
            "actuator.resistance_ohm",
        ];
        let fit = (part * supply_v / driven_v).min(jammed_part);
        let sentence = format!(
            "a motor counts as driven from {} V, `{}` ({}) of what `{}` ({}) needs, and `actuator.supply_v` gives it little more than {} V: that it \
             is jammed, or counts the wrong way, is not found",
            plain(two_digits(driven_v)),
            keys[0],
            plain(part),
            keys[1],
            plain(decimal(servo.current_a)),
            plain(two_digits(supply_v))
        );
        let help = format!(
            "give `driven_part` at most {}, or less current",
            plain(two_digits_below(fit))
        );
        self.refuse(&keys, sentence, help)
    }

    /// A supply that is low, but no fault, gives less than what such a motor is found by.
    pub(super) fn check_low_supply(&mut self) {
        let limits = &self.gains.limits;
        let (supply_min_v, part) = (decimal(limits.supply_min_v), decimal(limits.driven_part));
        let servos = self.file.gains.servos.iter();
        let driven = servos.map(|servo| {
            let driven_v = part * decimal(servo.current_a) * decimal(servo.resistance_ohm);
            let least_v = driven_v / (decimal(JAMMED_PART) * decimal(servo.duty_max));
            [driven_v, least_v]
        });
        let highest = driven.max_by(|a, b| a[1].total_cmp(&b[1]));
        let [driven_v, least_v] = highest.unwrap_or_default();
        if supply_min_v >= 0.999 * least_v {
            return;
        }
        let keys = ["control.limits.supply_min_v", "control.servo.current_a"];
        let fit_v = two_digits_above(least_v);
        // Nearer to the supply, any sag would be a fault.
        let remedy = if fit_v < 0.9 * self.basis.actuator.supply_v {
            format!("{} would do", plain(fit_v))
        } else {
            "a supply of more volts, or a lower `tendon.f_max_n`, would do".into()
        };
        let text = format!(
            "a motor counts as driven from {} V, which a supply below {} V does not give it: that it is jammed, or counts the wrong way, is not \
             found between that and `{}` ({}): {remedy}",
            plain(two_digits(driven_v)),
            plain(two_digits(least_v)),
            keys[0],
            plain(supply_min_v)
        );
        self.warn(&keys, text);
    }

    /// As homing begins, all motors start together with all that their servos give.
    pub(super) fn check_supply_dip(&mut self) {
        let supply_v = self.basis.actuator.supply_v;
        let least_v = decimal(self.gains.limits.supply_min_v);
        let servos = self.file.gains.servos.iter();
        // As much by their windings as the servo and the supply give; 5 % above the limit, for what inductance and speed change.
        let low_v = 1.05 * least_v;
        let drawn = servos.map(|servo| {
            let resistance_ohm = decimal(servo.resistance_ohm);
            let most_v = decimal(servo.current_a) * resistance_ohm;
            let motor_v = most_v.min(decimal(servo.duty_max) * low_v);
            motor_v * motor_v / (resistance_ohm * low_v.max(1e-9))
        });
        let drawn_a = drawn.sum::<f64>();
        let most_ohm = (supply_v - low_v) / drawn_a;
        let resistance_ohm = self.file.plant.supply_resistance_ohm;
        if resistance_ohm <= most_ohm {
            return;
        }
        let keys = [
            "simulation.supply_resistance_ohm",
            "control.servo.current_a",
            "actuator.supply_v",
        ];
        let text = format!(
            "motors that start together draw up to {} A, and a supply with `{}` ({}) falls as low as `control.limits.supply_min_v` ({}): up to {} Ω, or a \
             smaller `{}`, would do",
            plain(two_digits(drawn_a)),
            keys[0],
            plain(resistance_ohm),
            plain(least_v),
            plain(two_digits_below(most_ohm)),
            keys[1]
        );
        self.warn(&keys, text);
    }

    /// How far a motor may be from where it is led.
    pub(super) fn check_following(&mut self) -> Result<(), TomlError> {
        let following_m = decimal(self.gains.limits.following_m);
        let band_m = decimal(self.gains.servo.dead_band_m);
        let least_m = least_following_m(band_m);
        let keys = ["control.limits.following_m", "control.servo.dead_band_m"];
        let words = format!("`{}` ({})", keys[0], plain(following_m));
        if following_m < least_m {
            let sentence = format!(
                "{words} is less than what a sound motor stays behind, at rest in `{}` ({}) or as the maximum tension slows it",
                keys[1],
                plain(band_m)
            );
            let help = format!("give at least {}", plain(two_digits_above(least_m)));
            return self.refuse(&keys, sentence, help);
        }
        Ok(())
    }

    /// How far a motor that runs away gets before it is found.
    pub(super) fn check_runaway(&mut self) {
        let following_m = decimal(self.gains.limits.following_m);
        let f_max_n = self.file.f_max_n;
        let tendons = self.file.tendons.iter();
        let stiffnesses = tendons.filter_map(|tendon| tendon.stiffness(f_max_n).ok());
        let stiffness_n_per_m = stiffnesses.fold(0.0, f64::max);
        let pulled_n = f64::from(AWAY_PART) * following_m * stiffness_n_per_m;
        let most_n = RUNAWAY_MULTIPLE * f_max_n;
        if pulled_n > most_n {
            let fit_m = two_digits_below(following_m * most_n / pulled_n);
            let servos = self.file.gains.servos.iter();
            let bands_m = servos.map(|servo| decimal(servo.dead_band_m));
            let remedy = if fit_m >= least_following_m(bands_m.fold(0.0, f64::max)) {
                format!("{} would do", plain(fit_m))
            } else {
                "softer tendons would do, as a sound motor stays behind by more than what would"
                    .into()
            };
            let key = "control.limits.following_m";
            let text = format!(
                "`{key}` ({}) lets a motor that runs away pull with {} N more before it is found: {remedy}",
                plain(following_m),
                plain(two_digits(pulled_n)),
            );
            self.warn(&[key], text);
        }
    }

    /// A current that no servo drives is not seen to differ. Motors that differ have one limit together.
    pub(super) fn check_disagreement(&self) -> Result<(), TomlError> {
        let differs_a = decimal(self.gains.limits.disagreement_a);
        let servos = self.file.gains.servos.iter();
        let beyond_a = servos.map(|servo| decimal(servo.current_a) - decimal(servo.friction_a));
        let most_a = beyond_a.fold(0.0, f64::max);
        if differs_a < most_a {
            return Ok(());
        }
        let keys = ["control.limits.disagreement_a", "control.servo.current_a"];
        let sentence = format!(
            "no current differs by `{}` ({}) from what friction takes: `{}` leaves {} A for it",
            keys[0],
            plain(differs_a),
            keys[1],
            plain(two_digits(most_a))
        );
        let help = format!("give at most {}", plain(two_digits_below(0.9 * most_a)));
        self.refuse(&keys, sentence, help)
    }

    /// What forward kinematics leaves over is told from the resolution of the sensors, and its change from itself.
    pub(super) fn check_residual(&self) -> Result<(), TomlError> {
        let limits = &self.gains.limits;
        let residual_m = decimal(limits.residual_m);
        let change_m = decimal(limits.residual_change_m);
        let root_3 = 3.0_f64.sqrt();
        let cell_n = STEP_CODES * self.file.calibration.cell_n_per_code[self.motor];
        let tendons = self.file.tendons.iter();
        let stiffnesses = tendons.filter_map(|tendon| tendon.stiffness(self.file.f_min_n).ok());
        let stiffness_n_per_m = stiffnesses.fold(f64::INFINITY, f64::min);
        let least_m = root_3 * (self.basis.m_per_count + cell_n / stiffness_n_per_m);
        let keys = [
            "control.limits.residual_m",
            "control.limits.residual_change_m",
        ];
        if residual_m < least_m {
            let sentence = format!(
                "`{}` ({}) is less than what counts and load cells resolve, {} m",
                keys[0],
                plain(residual_m),
                plain(two_digits(least_m))
            );
            let help = format!("give at least {}", plain(two_digits_above(2.0 * least_m)));
            return self.refuse(&keys[..1], sentence, help);
        }
        if root_3 * change_m >= residual_m {
            let sentence = format!(
                "`{}` ({}) is so much that `{}` ({}) comes first, and a load cell that is off is not found",
                keys[1],
                plain(change_m),
                keys[0],
                plain(residual_m)
            );
            let help = format!("give at most {}", plain(two_digits_below(0.5 * residual_m)));
            return self.refuse(&[keys[1], keys[0]], sentence, help);
        }
        Ok(())
    }
}
