//! Whether the motors can home the leg as fast as the settings ask.

use super::Motor;
use crate::number::{decimal, plain};
use crate::rig_file::derived::rules::{stopped_m_per_s, touch_n};
use crate::rig_file::derived::{two_digits, two_digits_above, two_digits_below};
use leg_firmware::control::SHOWN_PART;
use leg_firmware::settings::CurrentOutput;

/// The least that `touch_n` may be, N.
const TOUCH_MIN_N: f64 = 0.1;

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
        let remedy = if fit < TOUCH_MIN_N {
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
