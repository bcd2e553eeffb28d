//! The constants of a motor, from its jogs.
//!
//! At a steady speed v of the tendon the voltage is U = R I + k v + c sign(v), with what the driver loses in c, and the current
//! I = F sign(v) + B v + P f sign(v) with the tension f. F and P are different for the two ways. Both are linear, so they hold
//! for the means of a jog in which the tension changes.

use super::error::TuneError;
use super::estimate::{Equation, UncertainValue, least_squares};
use super::jogs::Jogged;

/// Part of the current by the tension that it may be off beside: while a motor pulls, the tension grows and the motor becomes slower,
/// so that the inertia of its rotor drives, too. That is the mechanical time constant, 5 to 10 ms, by the time in which the tension
/// grows by itself, about a second.
const PULL_OFF_PART: f64 = 0.01;

/// What a motor shows by the quantities of its terminals and of its tendon.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct MotorConstants {
    /// Terminal resistance, Ω.
    pub resistance_ohm: UncertainValue,
    /// Voltage by the speed of the tendon, V·s/m.
    pub back_emf_v_s_per_m: UncertainValue,
    /// Voltage that the driver loses, V.
    pub driver_loss_v: UncertainValue,
    /// Current of the dry friction when the tendon is pulled in and paid out, A.
    pub friction_a: [UncertainValue; 2],
    /// Current of the viscous friction by the speed, A·s/m.
    pub viscous_a_s_per_m: UncertainValue,
    /// Current by the tension when the tendon is pulled in and paid out, A/N.
    pub pull_a_per_n: [UncertainValue; 2],
}

impl MotorConstants {
    /// From jogs without and against a tension. A current sensor shows steps of `current_step_a`.
    pub(super) fn fit<E>(jogs: &[Jogged], current_step_a: f64) -> Result<Self, TuneError<E>> {
        // Half a step, not the deviation of even errors within it: at steady currents they are the same in many jogs.
        let current_off_a = 0.5 * current_step_a;
        let slack_n = slack_n(jogs);
        let currents: Vec<_> = jogs.iter().map(|jog| current(jog, slack_n)).collect();
        let voltages: Vec<_> = jogs.iter().map(voltage).collect();
        let [friction_in, friction_out, viscous, pull_in, pull_out] =
            least_squares(&currents, current_off_a).ok_or_else(undetermined)?;
        // A current that is off counts by the resistance, which a first solution gives.
        let [first, ..] = least_squares(&voltages, 0.0).ok_or_else(undetermined)?;
        let voltage_off_v = (first.value * current_off_a).abs();
        let [resistance_ohm, back_emf_v_s_per_m, driver_loss_v] =
            least_squares(&voltages, voltage_off_v).ok_or_else(undetermined)?;
        let found = Self {
            resistance_ohm,
            back_emf_v_s_per_m,
            driver_loss_v,
            friction_a: [friction_in, friction_out],
            viscous_a_s_per_m: viscous,
            pull_a_per_n: [pull_in, pull_out].map(|pull| pull.widened(PULL_OFF_PART)),
        };
        let positive = [
            resistance_ohm,
            back_emf_v_s_per_m,
            friction_in,
            friction_out,
            pull_in,
        ];
        if positive
            .iter()
            .all(|one| one.value > 0.0 && one.is_certain())
        {
            Ok(found)
        } else {
            Err(undetermined())
        }
    }
}

fn undetermined<E>() -> TuneError<E> {
    TuneError::undetermined(
        "the currents and speeds of the jogs are not those of a motor with its screw",
        "look at the currents in `leg sensors`, and at `counts_per_turn`, `current_range_a` and `supply_range_v` in `[actuator]`",
    )
}

/// What the load cell shows of a slack tendon, N.
pub(super) fn slack_n(jogs: &[Jogged]) -> f64 {
    let free: Vec<f64> = jogs
        .iter()
        .filter(|jog| !jog.loaded)
        .map(|jog| jog.tension_n)
        .collect();
    free.iter().sum::<f64>() / free.len().max(1) as f64
}

fn voltage(jog: &Jogged) -> Equation<3> {
    let factors = [jog.current_a, jog.speed_m_per_s, jog.voltage_v.signum()];
    (factors, jog.voltage_v)
}

fn current(jog: &Jogged, slack_n: f64) -> Equation<5> {
    let pull_n = if jog.loaded {
        jog.tension_n - slack_n
    } else {
        0.0
    };
    let factors = if jog.voltage_v > 0.0 {
        [1.0, 0.0, jog.speed_m_per_s, pull_n, 0.0]
    } else {
        [0.0, -1.0, jog.speed_m_per_s, 0.0, -pull_n]
    };
    (factors, jog.current_a)
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test may panic")]
mod tests {
    use super::{Jogged, MotorConstants};

    /// A motor of 2 Ω and 600 V·s/m whose driver loses 0.3 V.
    fn jogs() -> Vec<Jogged> {
        let mut jogs = Vec::new();
        for (pull_n, loaded) in [(0.0, false), (6.0, true), (9.0, true)] {
            for speed in [1e-3_f64, 3e-3, 6e-3] {
                for sign in [1.0, -1.0] {
                    let [friction_a, pull_a_per_n] = if sign > 0.0 {
                        [0.04, 6e-3]
                    } else {
                        [0.05, 2e-3]
                    };
                    let current = friction_a + 0.3 * speed + pull_a_per_n * pull_n;
                    jogs.push(Jogged {
                        voltage_v: sign * (2.0 * current + 600.0 * speed + 0.3),
                        current_a: sign * current,
                        speed_m_per_s: sign * speed,
                        tension_n: pull_n + 1.5,
                        loaded,
                    });
                }
            }
        }
        jogs
    }

    #[test]
    fn every_constant_is_found_beside_the_others() {
        let found = MotorConstants::fit::<()>(&jogs(), 1e-6).unwrap();
        for (found, expected) in [
            (found.resistance_ohm, 2.0),
            (found.back_emf_v_s_per_m, 600.0),
            (found.driver_loss_v, 0.3),
            (found.friction_a[0], 0.04),
            (found.friction_a[1], 0.05),
            (found.viscous_a_s_per_m, 0.3),
            (found.pull_a_per_n[0], 6e-3),
            (found.pull_a_per_n[1], 2e-3),
        ] {
            assert!((found.value / expected - 1.0).abs() < 1e-6, "{found:?}");
        }
    }

    #[test]
    fn jogs_without_a_tension_do_not_tell_resistance_from_loss() {
        let free: Vec<_> = jogs().into_iter().filter(|jog| !jog.loaded).collect();
        MotorConstants::fit::<()>(&free, 1e-6).unwrap_err();
    }
}
