//! Whether the motors can home the leg as fast as the settings ask.

use super::Motor;
use crate::gains::range_of;
use crate::number::{decimal, plain};
use crate::rig_file::consistency::cells::STEP_CODES;
use crate::rig_file::derived::rules::{homed_m_per_s, stopped_m_per_s, touch_n};
use crate::rig_file::derived::{two_digits, two_digits_above, two_digits_below};
use leg_firmware::control::SHOWN_PART;
use leg_firmware::settings::{CurrentOutput, Homing};

/// What a tendon's zero may be off by half a step of its load cell before it is worth a warning, m.
const ZERO_M: f64 = 5e-5;

/// Multiple of `release_m` that the motors turn one after the other while a leg homes whose tendons have 1 mm of slack: that of homings with
/// gears of 4.4 to 100. `a_long_homing_is_told_before` holds it.
const HOMING_RELEASES: f64 = 8.4;

/// A homing that takes longer is warned of, s.
const LONG_S: f64 = 60.0;

impl Motor<'_> {
    /// A motor has to stop as its tendon becomes taut.
    pub(super) fn check_homing_speed(&mut self) {
        let homing = decimal(self.gains.homing.speed_m_per_s);
        let servo = decimal(self.gains.servo.speed_m_per_s);
        let highest = 0.5 * servo;
        if homing > highest {
            let keys = [
                "control.homing.speed_m_per_s",
                "control.servo.speed_m_per_s",
            ];
            let text = format!(
                "`{}` ({}) is more than half of `{}` ({}), and homing may fail as tendons are pulled too hard before their motors stop: give at most {}",
                keys[0],
                plain(homing),
                keys[1],
                plain(servo),
                plain(highest)
            );
            self.warn(&keys, text);
        }
    }

    /// A motor stops as its tendon becomes taut before that pulls too hard, by its stiffness.
    pub(super) fn check_stopped(&mut self) {
        let homing = decimal(self.gains.homing.speed_m_per_s);
        let stopped = stopped_m_per_s(&self.basis, &self.gains);
        // What is derived is rounded to two digits.
        if homing > 1.05 * stopped {
            let key = "control.homing.speed_m_per_s";
            let text = format!(
                "`{key}` ({}) pulls a tendon beyond `control.homing.f_max_n` ({}) before its motor stops, by its stiffness: give at most {}",
                plain(homing),
                plain(decimal(self.gains.homing.f_max_n)),
                plain(two_digits_below(stopped))
            );
            self.warn(&[key], text);
        }
    }

    /// Whoever homes such a leg has to know that it has not stopped.
    pub(super) fn check_duration(&mut self) {
        let homing = &self.gains.homing;
        let speed = decimal(homing.speed_m_per_s);
        let rests_s = 3.0 * (decimal(homing.settle_time_s) + decimal(homing.average_time_s));
        let lasts_s = HOMING_RELEASES * decimal(homing.release_m) / speed + rests_s;
        if lasts_s <= LONG_S {
            return;
        }
        let given = |key: &str| self.file.given_gains.has("homing", self.motor, key);
        let stiff =
            stopped_m_per_s(&self.basis, &self.gains) < homed_m_per_s(&self.basis, &self.gains);
        let remedy = if given("speed_m_per_s") || given("release_m") {
            "more `speed_m_per_s`, or less `release_m`, would shorten it"
        } else if 2.0 * rests_s > lasts_s {
            "`settle_time_s` and `average_time_s` follow from how long the leg swings"
        } else if stiff {
            "softer tendons, or a higher `f_max_n` of homing, would shorten it"
        } else {
            "less `gear_ratio`, more `lead_m` or more `control.servo.current_a` would shorten it"
        };
        let text = format!(
            "homing takes some {} s with `control.homing.speed_m_per_s` ({}), and an arm up to {} s with `control.limits.ramp_m_per_s` ({}): {remedy}",
            plain(two_digits(lasts_s)),
            plain(speed),
            plain(two_digits(decimal(self.gains.limits.taut_time_s))),
            plain(decimal(self.gains.limits.ramp_m_per_s))
        );
        let keys = [
            "control.homing.speed_m_per_s",
            "control.homing.release_m",
            "control.servo.speed_m_per_s",
            "actuator.gear_ratio",
            "actuator.lead_m",
        ];
        self.warn(&keys, text);
    }

    /// A tendon that is found taut has lifted the leg, and has to become slack as it is paid out again.
    pub(super) fn check_touch(&mut self) {
        let homing = &self.gains.homing;
        let touch = decimal(homing.touch_n);
        let fit = touch_n(&self.basis, &self.gains);
        // What is derived is rounded to two digits.
        if touch <= 1.05 * fit {
            return;
        }
        let lifted_m = touch * self.basis.lift_m_per_n;
        let keys = ["control.homing.touch_n", "control.homing.release_m"];
        let [least_n, _] = range_of(Homing::FIELDS, "touch_n");
        let remedy = if fit < least_n {
            format!("give a longer `{}`", keys[1])
        } else {
            let fit = plain(two_digits_below(fit));
            format!("give at most {fit}, or a longer `{}`", keys[1])
        };
        let text = format!(
            "a tendon that pulls with `{}` ({}) comes in by {} m as it lifts the leg, and `{}` ({}) may not make it slack again: {remedy}",
            keys[0],
            plain(touch),
            plain(two_digits(lifted_m)),
            keys[1],
            plain(decimal(homing.release_m))
        );
        self.warn(&keys, text);
    }

    /// Readings are averaged to less than a step of the converter only where their noise is no less than about half of one.
    pub(super) fn check_cell_step(&mut self) {
        let noise_n = self.file.plant.cell_noise_n;
        let step_n = STEP_CODES * self.file.calibration.cell_n_per_code[self.motor];
        let off_m = 0.5 * step_n * self.basis.lift_m_per_n;
        if noise_n >= 0.5 * step_n || off_m <= ZERO_M {
            return;
        }
        let fit_n = (2.0 * noise_n).max(2.0 * ZERO_M / self.basis.lift_m_per_n);
        let text = format!(
            "a step of its load cell is {} N, which noise of {} N (`simulation.cell_noise_n`) does not average, and so little lifts the leg that homing may \
             be off by {} m: a range in which a step is at most {} N would do",
            plain(two_digits(step_n)),
            plain(noise_n),
            plain(two_digits(off_m)),
            plain(two_digits_below(fit_n))
        );
        let keys = [
            "calibration.cell_n_per_code",
            "actuator.cell_range_n",
            "simulation.cell_noise_n",
        ];
        self.warn(&keys, text);
    }

    /// An output that is silent in short pulses shows a motor that homes.
    pub(super) fn check_shown(&mut self) {
        let actuator = &self.basis.actuator;
        if actuator.current_output != CurrentOutput::MagnitudeWhenDriven {
            return;
        }
        let shown_v = f64::from(SHOWN_PART) * actuator.supply_v;
        let back_emf_v_s_per_m = decimal(self.gains.servo.back_emf_v_s_per_m);
        let speed = decimal(self.gains.homing.speed_m_per_s);
        if speed * back_emf_v_s_per_m < shown_v {
            let text = format!(
                "`control.homing.speed_m_per_s` ({}) turns a motor without a load by pulses that are too short for its current \
                 output, and its ceiling is kept by counts and `resistance_ohm` alone: {} would do",
                plain(speed),
                plain(two_digits_above(shown_v / back_emf_v_s_per_m.max(1e-9)))
            );
            let keys = ["control.homing.speed_m_per_s", "actuator.current_output"];
            self.warn(&keys, text);
        }
    }
}
