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
