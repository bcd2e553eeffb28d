//! Ramping down: the leg follows no command, and its tendons are paid out by their counters alone.

use super::phase::Phase;
use super::shared::{LegLimits, Shared};
use crate::control::{AxisGoal, Measured, bounds, ticks};
use leg_model::Scalar;

/// A tendon this near to its goal, beside the servo's dead band, has arrived, m: a fifth of the slack of a relaxed tendon, so that one
/// that stops there is slack.
const ARRIVED_M: f32 = 2e-5;

/// Part of the travel from which on a tendon was paid out by the whole of it, but for its rounding.
const WHOLE_PART: f32 = 0.999;

/// Time after which a motor that did not arrive is waited for no longer, s, beside twice the time that the way takes: for
/// a short way, on which a motor has to start and to stop.
const GRACE_S: f32 = 0.5;

/// The tendons are paid out. No load cell is used: one that is wrong would leave its tendon taut, and the others would swing
/// the leg.
#[derive(Clone, Copy, Debug)]
pub struct RampingDown<T> {
    rest_m: [T; 3],
    trusted: bool,
    /// None before the first tick.
    goals: Option<[AxisGoal<T>; 3]>,
    ticks_left: u32,
}

impl<T: Scalar> RampingDown<T> {
    /// From where the tendons are. With `trusted`, pose and zero are known: a leg that hangs straight down is made slack, no
    /// farther. Without, a tendon is led to where the last ramp down made it slack, where that is known. Every other one is paid out by
    /// [`relax_travel_m`](crate::settings::Limits::relax_travel_m).
    pub fn new(limits: &LegLimits<T>, rest_m: [T; 3], trusted: bool) -> Self {
        Self {
            rest_m,
            trusted,
            goals: None,
            ticks_left: ticks(GRACE_S) + 2 * limits.relax_ticks,
        }
    }

    /// Whether it relies on the pose.
    #[cfg(test)]
    pub const fn trusts_pose(&self) -> bool {
        self.trusted
    }

    /// One tick: true when every tendon has arrived and stands, or a motor did not in time.
    #[inline(never)]
    pub fn relax(&mut self, phase: Phase, shared: &mut Shared<T>, measured: &Measured<T>) -> bool {
        if self.goals.is_none() && phase == Phase::Estimate {
            // There is no time for both.
            return false;
        }
        let goals = *self
            .goals
            .get_or_insert_with(|| goals(shared, self.rest_m, self.trusted));
        let near = shared.dead_band_m() + T::from(ARRIVED_M);
        let mut arrived = true;
        for ((axis, goal), &pulled) in shared.axes.iter_mut().zip(&goals).zip(&measured.pulled_m) {
            axis.lead(goal, T::one());
            // One that turns yet would go on when the drivers are off.
            arrived &= (pulled - goal.pulled_m).abs() <= near && axis.stands();
        }
        self.ticks_left = self.ticks_left.saturating_sub(1);
        // A tick has no time for an estimate and for the next mode to begin.
        let ends = (arrived || self.ticks_left == 0) && phase != Phase::Estimate;
        if ends {
            // One that was paid out by the whole travel may pull yet.
            let farthest_m = shared.limits.relax_travel_m * T::from(WHOLE_PART);
            let led = shared.known_slack_m.iter_mut().zip(&goals).zip(self.rest_m);
            for ((slack, goal), rest_m) in led {
                let slackens = arrived && rest_m - goal.pulled_m < farthest_m;
                *slack = if slackens { goal.pulled_m } else { -T::MAX };
            }
        }
        ends
    }
}

/// Where the tendons are paid out to: all arrive at once, so that the leg is not led aside.
fn goals<T: Scalar>(shared: &Shared<T>, rest_m: [T; 3], trusted: bool) -> [AxisGoal<T>; 3] {
    let limits = &shared.limits;
    let mut travels_m = [limits.relax_travel_m; 3];
    let slack_m = if trusted {
        slack_straight_down_m(shared)
    } else {
        Some(shared.known_slack_m)
    };
    if let Some(slack_m) = slack_m {
        for ((travel, slack), rest) in travels_m.iter_mut().zip(slack_m).zip(rest_m) {
            *travel = bounds::max(bounds::min(rest - slack, *travel), T::zero());
        }
    }
    let [a, b, c] = travels_m;
    let farthest_m = bounds::max(bounds::max(a, b), c);
    let per_m = if farthest_m > T::zero() {
        limits.ramp_m_per_s / farthest_m
    } else {
        T::zero()
    };
    let goal = |i: usize| AxisGoal {
        pulled_m: rest_m[i] - travels_m[i],
        speed_m_per_s: per_m * travels_m[i],
    };
    [goal(0), goal(1), goal(2)]
}

/// Where the tendons of a leg that hangs straight down are just slack, m pulled in; none where the zero is not known, or the leg
/// leans.
fn slack_straight_down_m<T: Scalar>(shared: &Shared<T>) -> Option<[T; 3]> {
    let zero_m = shared.zero_m?;
    let pose = shared.estimator.direction().vector();
    // 1°: a leg that was led down is nearer than that, whatever load it carries.
    let near = T::from(0.0175 * 0.0175);
    if !(pose.x * pose.x + pose.y * pose.y <= near) {
        return None;
    }
    let [a, b, c] = zero_m;
    let lengths = &shared.limits.slack_lengths_m;
    Some([a - lengths[0], b - lengths[1], c - lengths[2]])
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test may panic")]
mod tests {
    use super::{RampingDown, goals};
    use crate::control::{CYCLE_TICKS, LoadEstimation, Measured};
    use crate::leg::phase::Phase;
    use crate::leg::shared::{Checked, Shared};
    use crate::settings::Settings;
    use leg_model::{Direction, inverse_kinematics};

    fn shared() -> Shared<f64> {
        let settings = Settings::table_1().unwrap();
        Shared::new(&settings, Checked::new(&settings).unwrap())
    }

    fn measured(pulled_m: [f64; 3]) -> Measured<f64> {
        Measured::resting(pulled_m, [1.0; 3])
    }

    /// A tendon of a hanging leg is paid out to where it is just slack, by no more than the travel, and never pulled in. All arrive
    /// at once.
    #[test]
    fn a_hanging_leg_is_made_slack_and_no_more() {
        let mut shared = shared();
        let zero_m = [0.21, 0.22, 0.23];
        shared.zero_m = Some(zero_m);
        let travel_m = shared.limits.relax_travel_m;
        let lengths_m = shared.limits.slack_lengths_m;
        for (parts, travels) in [
            ([0.5, 0.25, -0.5], [0.5, 0.25, 0.0]),
            ([3.0, 0.5, 0.1], [1.0, 0.5, 0.1]),
        ] {
            let mut rest_m = zero_m;
            for (i, rest) in rest_m.iter_mut().enumerate() {
                *rest += parts[i] * travel_m - lengths_m[i];
            }
            let goals = goals(&shared, rest_m, true);
            for (i, goal) in goals.iter().enumerate() {
                let paid_out_m = rest_m[i] - goal.pulled_m;
                let expected_m = travels[i] * travel_m;
                assert!((paid_out_m - expected_m).abs() < 1e-9, "{parts:?} {i}");
                let time_s = expected_m / shared.limits.ramp_m_per_s;
                let takes_s = travels[0] * travel_m / shared.limits.ramp_m_per_s;
                assert!((goal.speed_m_per_s * takes_s - expected_m).abs() < 1e-9);
                assert!(time_s <= takes_s);
            }
        }
    }

    /// Has the leg's estimator find it at a lean, degrees.
    fn lean(shared: &mut Shared<f64>, azimuth_deg: f64, tilt_deg: f64) {
        let [azimuth, tilt] = [azimuth_deg, tilt_deg].map(f64::to_radians);
        let direction = Direction::from_angles(azimuth, tilt).unwrap();
        let (mechanism, mut twisted) = (&shared.mechanism, None);
        let geometry = mechanism.geometry(&direction, 0.0, &mut twisted);
        let lengths = inverse_kinematics(geometry, &direction).unwrap().lengths;
        let slack = LoadEstimation::Slack;
        let (estimator, lengths) = (&mut shared.estimator, lengths.into());
        let found = estimator.update(mechanism, &lengths, &[0.0; 3], 0.0, slack);
        found.unwrap();
    }

    /// Its tendons would not be slack where those of a hanging leg are.
    #[test]
    fn a_leg_that_leans_any_way_is_paid_out_by_the_travel() {
        let mut shared = shared();
        let zero_m = [0.2; 3];
        shared.zero_m = Some(zero_m);
        let mut rest_m = zero_m;
        for (rest, length) in rest_m.iter_mut().zip(shared.limits.slack_lengths_m) {
            *rest += 0.5 * shared.limits.relax_travel_m - length;
        }
        for azimuth_deg in [0.0, 45.0, 90.0, 200.0] {
            for (tilt_deg, part) in [(0.9, 0.5), (1.1, 1.0), (30.0, 1.0)] {
                lean(&mut shared, azimuth_deg, tilt_deg);
                for (goal, rest) in goals(&shared, rest_m, true).iter().zip(rest_m) {
                    let off_m = rest - goal.pulled_m - part * shared.limits.relax_travel_m;
                    assert!(off_m.abs() < 1e-9, "{azimuth_deg}°, {tilt_deg}°: {off_m} m");
                }
            }
        }
    }

    /// Without a pose or a zero to rely on, every tendon is paid out by the whole travel.
    #[test]
    fn without_trust_every_tendon_is_paid_out_by_the_travel() {
        let mut shared = shared();
        for (zero_m, trusted) in [(Some([0.2; 3]), false), (None, true)] {
            shared.zero_m = zero_m;
            let rest_m = [0.01, 0.02, 0.03];
            for (goal, rest_m) in goals(&shared, rest_m, trusted).iter().zip(rest_m) {
                assert_eq!(goal.pulled_m, rest_m - shared.limits.relax_travel_m);
                assert_eq!(goal.speed_m_per_s, shared.limits.ramp_m_per_s);
            }
        }
    }

    /// A tendon is paid out to where the last ramp down led it, or by the travel where that is farther.
    #[test]
    fn a_leg_that_was_relaxed_is_slack_where_it_was() {
        let mut shared = shared();
        let travel_m = shared.limits.relax_travel_m;
        let rest_m = [0.01, 0.02, 0.03];
        let slack_m = [0.5 * travel_m, 0.0, 2.0 * travel_m];
        for (i, (rest, slack)) in rest_m.iter().zip(slack_m).enumerate() {
            shared.known_slack_m[i] = rest - slack;
        }
        let goals = goals(&shared, rest_m, false);
        for ((goal, rest), slack) in goals.iter().zip(rest_m).zip(slack_m) {
            let paid_out_m = rest - goal.pulled_m;
            assert!(
                (paid_out_m - slack.min(travel_m)).abs() < 1e-9,
                "{paid_out_m} m"
            );
        }
    }

    /// What the next ramp down relies on: where this one led a tendon to where it is slack, by the pose or by the ramp before. One that went by the
    /// whole travel may pull yet, and so may all where a motor did not come.
    #[test]
    fn a_ramp_that_ends_notes_where_tendons_are_slack() {
        let rest_m = [0.01; 3];
        let whole_m = shared().limits.relax_travel_m;
        let slack_m = [0.2, 0.9, 2.0].map(|part| 0.01 - part * whole_m);
        for (trusted, comes) in [(true, true), (true, false), (false, true), (false, false)] {
            let mut shared = shared();
            if trusted {
                let lengths_m = shared.limits.slack_lengths_m;
                let zero = |i: usize| slack_m[i] + lengths_m[i];
                shared.zero_m = Some([zero(0), zero(1), zero(2)]);
            } else {
                shared.known_slack_m = slack_m;
            }
            let mut ramp = RampingDown::new(&shared.limits, rest_m, trusted);
            let led_m = goals(&shared, rest_m, trusted).map(|goal| goal.pulled_m);
            let shown = measured(if comes { led_m } else { rest_m });
            while !ramp.relax(Phase::Command, &mut shared, &shown) {}
            for (i, found_m) in shared.known_slack_m.into_iter().enumerate() {
                let expected_m = if comes && i < 2 {
                    slack_m[i]
                } else {
                    -f64::MAX
                };
                assert!((found_m - expected_m).abs() < 1e-9, "{trusted} {comes} {i}");
            }
        }
    }

    /// The ramp ends once every motor is at its goal; where one does not come, after twice the time that it should take and
    /// half a second.
    #[test]
    fn a_ramp_ends_when_all_have_arrived_or_the_time_is_over() {
        let mut shared = shared();
        let travel_m = shared.limits.relax_travel_m;
        let rest_m = [0.01; 3];
        let late = 4000 + 2 * shared.limits.relax_ticks;
        let begin = |shared: &Shared<f64>| RampingDown::new(&shared.limits, rest_m, false);
        let there_m = rest_m.map(|rest| rest - travel_m);
        let mut arrived = begin(&shared);
        for (phase, ends) in [
            (Phase::Command, true),
            (Phase::Estimate, false),
            (Phase::Target, true),
        ] {
            let ended = arrived.relax(phase, &mut shared, &measured(there_m));
            assert_eq!(ended, ends);
        }
        let mut stuck = begin(&shared);
        let stuck_m = [there_m[0], rest_m[1], there_m[2]];
        let end =
            (1..=2 * late).find(|_| stuck.relax(Phase::Command, &mut shared, &measured(stuck_m)));
        assert_eq!(end, Some(late));
        assert!(late > u32::from(CYCLE_TICKS));
    }
}
