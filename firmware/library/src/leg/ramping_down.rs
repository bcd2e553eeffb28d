//! Ramping down: the leg follows no command, and its tendons are paid out by their counters alone.

use super::phase::Phase;
use super::shared::Shared;
use crate::control::{AxisGoal, Measured, bounds, ticks};
use leg_model::Scalar;

/// A tendon this near to its goal, beside the servo's dead band, has arrived, m: a fifth of the slack of a relaxed tendon, so that one
/// that stops there is slack.
const ARRIVED_M: f32 = 2e-5;

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
    /// farther; every other one is paid out by [`relax_travel_m`](crate::settings::Limits::relax_travel_m).
    pub fn new(relax_ticks: u32, rest_m: [T; 3], trusted: bool) -> Self {
        Self {
            rest_m,
            trusted,
            goals: None,
            ticks_left: ticks(GRACE_S) + 2 * relax_ticks,
        }
    }

    /// One tick: true when every tendon has arrived, or a motor did not in time.
    #[inline(never)]
    pub fn relax(&mut self, phase: Phase, shared: &mut Shared<T>, measured: &Measured<T>) -> bool {
        if self.goals.is_none() && phase == Phase::Estimate {
            // There is no time for both.
            return false;
        }
        let goals = *self
            .goals
            .get_or_insert_with(|| goals(shared, self.rest_m, self.trusted));
        let near = shared.limits.dead_band_m + T::from(ARRIVED_M);
        let mut arrived = true;
        for ((axis, goal), &pulled) in shared.axes.iter_mut().zip(&goals).zip(&measured.pulled_m) {
            axis.lead(goal, T::one());
            arrived &= (pulled - goal.pulled_m).abs() <= near;
        }
        self.ticks_left = self.ticks_left.saturating_sub(1);
        arrived || self.ticks_left == 0
    }
}

/// Where the tendons are paid out to: all arrive at once, so that the leg is not led aside.
fn goals<T: Scalar>(shared: &Shared<T>, rest_m: [T; 3], trusted: bool) -> [AxisGoal<T>; 3] {
    let limits = &shared.limits;
    let mut travels_m = [limits.relax_travel_m; 3];
    if trusted && let Some(slack_m) = slack_m(shared) {
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
fn slack_m<T: Scalar>(shared: &Shared<T>) -> Option<[T; 3]> {
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
