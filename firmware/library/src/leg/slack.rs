//! The travel from slack to taut.

use super::shared::Shared;
use crate::command::Compensation;
use crate::control::{CYCLE_S, Measured, TICK_S, bounds};
use leg_model::Scalar;

/// All tendons come to their targets at once, so that the leg does not swing.
#[derive(Clone, Copy, Debug)]
pub struct Slack<T> {
    /// How much travel is left, m; none before the first target.
    pub left_m: Option<T>,
    /// Cycles since the leg was armed.
    pub cycles: u32,
}

impl<T: Scalar> Slack<T> {
    /// Whether every tendon is led to its target itself.
    #[inline(always)]
    pub fn taken_up(&self) -> bool {
        self.left_m.is_some_and(|left| left <= T::zero())
    }

    /// Counts a cycle of a leg that does not pull at every tendon yet; whether it does now.
    #[inline(always)]
    pub fn watch(&mut self, shared: &Shared<T>, measured: &Measured<T>) -> bool {
        self.cycles = self.cycles.saturating_add(1);
        if !self.taken_up() {
            return false;
        }
        let f_min_n = shared.mechanism.f_min_n;
        // A load that is left out may keep a tendon below what the target asks for.
        let least_n = if shared.compensation == Compensation::Off {
            shared.taut_n()
        } else {
            f_min_n
        };
        let tensions_n = &measured.steady_tensions_n;
        tensions_n.iter().all(|&tension| tension > least_n)
    }

    /// Moves each goal, m pulled in, back by the travel that is left, and lessens that travel. A tendon that is nearer to its goal than that
    /// stays where it is, and none is paid out: it may carry the leg. Gives how far a motor may be led in a tick, m.
    #[inline(never)]
    pub fn reel_in(&mut self, shared: &Shared<T>, goals_m: &mut [T; 3]) -> T {
        self.wait(shared, goals_m);
        let limits = &shared.limits;
        bounds::min(limits.ramp_m_per_s * T::from(TICK_S), limits.servo_step_m)
    }

    /// The same, without the motor's step.
    #[inline(always)]
    fn wait(&mut self, shared: &Shared<T>, goals_m: &mut [T; 3]) {
        let Some(mut left_m) = self.left_m else {
            // The first cycle looks how far they are: it has no time to lead them, too.
            let mut farthest_m = T::zero();
            for (axis, goal) in shared.axes.iter().zip(goals_m) {
                farthest_m = bounds::max(farthest_m, *goal - axis.reference_m());
                *goal = axis.reference_m();
            }
            self.left_m = Some(farthest_m);
            return;
        };
        let step_m = shared.limits.ramp_m_per_s * T::from(CYCLE_S);
        let mut there = true;
        for (axis, goal) in shared.axes.iter().zip(goals_m) {
            let reference_m = axis.reference_m();
            let ahead_m = bounds::max(*goal - left_m - reference_m, T::zero());
            *goal = reference_m + ahead_m;
            there &= ahead_m <= T::TWO * step_m;
        }
        if there {
            left_m -= step_m;
        }
        self.left_m = Some(left_m);
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test may panic")]
mod tests {
    use super::Slack;
    use crate::control::CYCLE_S;
    use crate::leg::shared::{Checked, Shared};
    use crate::settings::Settings;

    /// A tendon sets out when the one with the farthest way is as far from its target as it, and all come nearer at the speed of a ramp, but
    /// only while every motor is where it is led.
    #[test]
    fn slack_is_taken_up_at_the_speed_of_a_ramp() {
        let settings = Settings::table_1().unwrap();
        let mut shared = Shared::<f64>::new(&settings, Checked::new(&settings).unwrap());
        let step_m = shared.limits.ramp_m_per_s * f64::from(CYCLE_S);
        let targets_m = [1e-3, 7e-4, 2e-4];
        let mut slack = Slack {
            left_m: None,
            cycles: 0,
        };
        let mut cycles = 0.0;
        while !slack.taken_up() {
            let mut goals_m = targets_m;
            slack.reel_in(&shared, &mut goals_m);
            for (goal, target) in goals_m.iter().zip(targets_m) {
                let left_m = target.min(1e-3 - cycles * step_m);
                // The first goals are not reached yet: that takes a cycle.
                let waited_m = target - goal - left_m;
                assert!((-1e-9..step_m + 1e-9).contains(&waited_m), "{waited_m} m");
            }
            for (axis, goal) in shared.axes.iter_mut().zip(goals_m) {
                axis.rest(goal);
            }
            cycles += 1.0;
            assert!(cycles < 2.0 * 1e-3 / step_m);
        }
        assert!((cycles * step_m - 1e-3).abs() < 3.0 * step_m, "{cycles}");
    }

    /// A tendon that is nearer to its target stays where it is until the others are as near, and so does one that its target will pay out.
    #[test]
    fn no_tendon_is_paid_out_for_one_that_is_farther_off() {
        let settings = Settings::table_1().unwrap();
        let shared = Shared::<f64>::new(&settings, Checked::new(&settings).unwrap());
        for (goal_m, expected_m) in [(4e-4, 0.0), (1.2e-3, 2e-4), (-3e-4, 0.0)] {
            let mut slack = Slack {
                left_m: Some(1e-3),
                cycles: 0,
            };
            let mut goals_m = [1e-3, goal_m, 1e-3];
            slack.reel_in(&shared, &mut goals_m);
            let [first_m, found_m, last_m] = goals_m;
            assert!((found_m - expected_m).abs() < 1e-12, "{goal_m}: {found_m}");
            assert_eq!([first_m, last_m], [0.0; 2]);
        }
    }

    #[test]
    fn a_motor_that_stays_behind_is_waited_for() {
        let settings = Settings::table_1().unwrap();
        let shared = Shared::<f64>::new(&settings, Checked::new(&settings).unwrap());
        let mut slack = Slack {
            left_m: Some(5e-4),
            cycles: 0,
        };
        for _ in 0..100 {
            slack.reel_in(&shared, &mut [5e-4, 5e-4, 1e-3]);
            assert_eq!(slack.left_m, Some(5e-4));
        }
    }
}
