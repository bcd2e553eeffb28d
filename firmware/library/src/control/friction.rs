//! The voltage that a motor needs against the friction of motor, gear and screw, fed forward by where it is led.

use super::{TICK_S, bounds::min};
use crate::settings::Servo;
use leg_model::Scalar;

/// By how many times as much the settings allow for as the data sheet of a motor gives, so that no monitor errs: that is not fed, for
/// with more than there is a motor runs ahead until its servo takes it back.
pub const FRICTION_ALLOWANCE: f64 = 2.6;

/// The same of the current of a pull.
pub const PULL_ALLOWANCE: f64 = 1.05;

/// Speed of a tendon below which its direction is that of noise, m/s: nothing is fed. The target of a leg at rest on the paper's rig
/// wanders at 1 µm/s, ten times as slowly.
const LEAST_M_PER_S: f32 = 1e-5;

/// How much faster the whole friction is fed, m/s. At twice as much a motor breaks away too late to brake the last 0.03 mm of a swing at
/// the tip (`tests/suite/bench/moves.rs`); at half of it rounding decides when a motor at rest does (`fault_off_station`).
const WHOLE_M_PER_S: f32 = 5e-5;

/// The friction of a motor, as voltages.
#[derive(Clone, Copy, Debug)]
pub struct Friction<T> {
    /// Without a tension, V.
    dry_v: T,
    /// By the tension, V/N: while the tendon is reeled in, and while it is paid out.
    inwards_v_per_n: T,
    outwards_v_per_n: T,
}

impl<T: Scalar> Friction<T> {
    /// What the settings tell. Of a screw with the efficiency η a pull takes 1/η of the frictionless torque to reel in, and 1/η − 2
    /// to pay out. η is what is left of the back-EMF constant's torque when a pull takes its current; the loss of the gear is
    /// counted as the screw's.
    pub fn new(servo: &Servo) -> Self {
        let pull_a_per_n = servo.pull_a_per_n / PULL_ALLOWANCE as f32;
        // No more than the servo may drive: a setting far beyond any motor's would leave the integral without digits.
        let dry_a = (servo.friction_a / FRICTION_ALLOWANCE as f32).min(servo.current_a);
        let twice_efficiency = 2.0 / (servo.back_emf_v_s_per_m * pull_a_per_n).max(1.0);
        let inwards_v_per_n = servo.resistance_ohm * pull_a_per_n;
        let outwards_v_per_n = inwards_v_per_n * (1.0 - twice_efficiency).max(0.0);
        Self {
            dry_v: T::from(servo.resistance_ohm * dry_a),
            inwards_v_per_n: inwards_v_per_n.into(),
            outwards_v_per_n: outwards_v_per_n.into(),
        }
    }

    /// The voltage of a motor that is led by `step_m` in a tick, at a tension that is asked for, N. That is between the bounds of the
    /// tensions, whatever a load cell shows.
    #[inline(always)]
    pub fn voltage_v(&self, step_m: T, tension_n: T) -> T {
        let faster_m = step_m.abs() - T::from(LEAST_M_PER_S * TICK_S);
        if !(faster_m > T::zero()) {
            return T::zero();
        }
        let part = min(faster_m * T::from(1.0 / (WHOLE_M_PER_S * TICK_S)), T::one());
        if step_m > T::zero() {
            part * (self.dry_v + self.inwards_v_per_n * tension_n)
        } else {
            -part * (self.dry_v + self.outwards_v_per_n * tension_n)
        }
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test may panic")]
mod tests {
    use super::Friction;
    use crate::control::TICK_S;
    use crate::settings::Settings;

    /// By the data of the default motor: 0.9 mN·m at 23.4 mN·m/A and 2.32 Ω are 0.089 V; a pull of 100 N takes 0.58 A to reel in, of
    /// which a screw and gear of 27 % together leave 46 % to pay out.
    #[test]
    fn the_friction_of_the_default_motor_is_fed() {
        let [servo, ..] = Settings::table_1().unwrap().servos;
        let friction = Friction::<f64>::new(&servo);
        let voltage = |mm_per_s: f64, tension_n: f64| {
            friction.voltage_v(mm_per_s * 1e-3 * f64::from(TICK_S), tension_n)
        };
        for (mm_per_s, tension_n, expected_v) in [
            (5.0, 0.0, 0.089),
            (-5.0, 0.0, -0.089),
            (5.0, 100.0, 0.089 + 1.33),
            (-5.0, 100.0, -0.089 - 0.61),
            (0.035, 0.0, 0.5 * 0.089),
            (0.01, 100.0, 0.0),
            (-0.01, 100.0, 0.0),
        ] {
            let found_v = voltage(mm_per_s, tension_n);
            assert!(
                (found_v - expected_v).abs() < 0.02,
                "{mm_per_s} mm/s, {tension_n} N: {found_v} V"
            );
        }
    }
}
