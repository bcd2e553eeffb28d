//! Held and ramping down: the leg follows no command, its motors still work.

use super::shared::Shared;
use crate::control::Measured;
use leg_model::Scalar;

/// The leg stays where it is.
#[derive(Clone, Copy, Debug)]
pub struct Held<T> {
    /// Where the tendons were when this began, m.
    rest_m: [T; 3],
}

/// The tendons are paid out.
#[derive(Clone, Copy, Debug)]
pub struct RampingDown<T> {
    /// Where the tendons were when this began, m.
    rest_m: [T; 3],
}

impl<T: Scalar> Held<T> {
    pub const fn new(rest_m: [T; 3]) -> Self {
        Self { rest_m }
    }

    /// Pulls in any tendon that is below the minimum tension, as far as that is allowed: not at all while the load cells
    /// are suspect.
    #[inline(never)]
    pub fn keep_f_min(&self, shared: &mut Shared<T>, measured: &Measured<T>, suspect_cells: bool) {
        let limits = &shared.limits;
        let travel_m = if suspect_cells {
            T::zero()
        } else {
            limits.hold_travel_m
        };
        shared.lowest_m = self.rest_m.map(|rest| rest - travel_m);
        for (i, axis) in shared.axes.iter_mut().enumerate() {
            let low = measured.steady_tensions_n[i] < shared.mechanism.f_min_n;
            let room = measured.pulled_m[i] - self.rest_m[i] < travel_m;
            let goal_m = if low && room {
                measured.pulled_m[i] + limits.hold_travel_m
            } else {
                axis.reference_m()
            };
            Shared::ramp(axis, goal_m, limits);
        }
    }
}

impl<T: Scalar> RampingDown<T> {
    pub const fn new(rest_m: [T; 3]) -> Self {
        Self { rest_m }
    }

    /// Pays out every tendon that still pulls, as far as that is allowed: a dead load cell may report a pull for ever. True
    /// when nothing is left to pay out.
    #[inline(never)]
    pub fn relax(&self, shared: &mut Shared<T>, measured: &Measured<T>) -> bool {
        let limits = &shared.limits;
        let mut relaxed = true;
        for (i, axis) in shared.axes.iter_mut().enumerate() {
            let pulls = measured.steady_tensions_n[i] > limits.slack_n;
            let room = self.rest_m[i] - measured.pulled_m[i] < limits.relax_travel_m;
            relaxed &= !(pulls && room);
            let goal_m = if pulls && room {
                axis.reference_m() - limits.hold_travel_m
            } else {
                axis.reference_m()
            };
            Shared::ramp(axis, goal_m, limits);
        }
        relaxed
    }
}
