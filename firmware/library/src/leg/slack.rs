//! The travel from slack to taut.

use super::shared::Shared;
use crate::control::{Axis, CYCLE_S, bounds};
use leg_model::Scalar;

/// Every tendon is as far from its target as every other, so that the leg does not swing.
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

    /// Takes from the goals how far the tendons are still kept from them, m, and lessens that.
    #[inline(never)]
    pub fn reel_in(&mut self, shared: &Shared<T>, goals_m: &mut [T; 3]) {
        let mut left_m = self.left_m.unwrap_or_else(|| {
            let farthest = |farthest: T, (axis, &goal): (&Axis<T>, &T)| {
                bounds::max(farthest, goal - axis.reference_m())
            };
            shared
                .axes
                .iter()
                .zip(goals_m.iter())
                .fold(T::zero(), farthest)
        });
        let step_m = shared.limits.ramp_m_per_s * T::from(CYCLE_S);
        let mut there = true;
        for (axis, goal) in shared.axes.iter().zip(goals_m) {
            *goal -= left_m;
            there &= (*goal - axis.reference_m()).abs() <= T::TWO * step_m;
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

    /// All tendons are as far from their targets as the one with the farthest way, and come nearer at the speed of a ramp, but only
    /// while every motor is where it is led.
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
                let left_m = 1e-3 - cycles * step_m;
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
