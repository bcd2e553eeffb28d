//! The brake of the leg's swing and the pace of its station, in every other cycle: what they ask of the tendons comes in the two
//! cycles until the next step.

use super::shared::Shared;
use super::station::StationKeeping;
use crate::control::bounds;
use leg_model::Scalar;

/// By how much the tendons are longer than the trajectory asks, and their motors behind.
#[derive(Clone, Copy, Debug)]
pub struct SwingBrake<T> {
    /// Whether the last cycle that had time for it braked, so that the next one searches for the pretension.
    braked: bool,
    longer_m: [T; 3],
    /// How that changes in a cycle, m.
    step_m: [T; 3],
}

impl<T: Scalar> SwingBrake<T> {
    /// At rest, with motors that are so far behind their screws, m.
    pub fn new(behind_m: &[T; 3]) -> Self {
        Self {
            braked: false,
            longer_m: *behind_m,
            step_m: [T::zero(); 3],
        }
    }

    /// Whether it has its turn, of two.
    #[inline(always)]
    pub fn takes_turn(&mut self) -> bool {
        self.braked = !self.braked;
        self.braked
    }

    /// Brakes a swing about the last target, and keeps a leg at its station from going there too fast. In one cycle, the speed of the
    /// tendons would go up and down with the cycles.
    #[inline(never)]
    pub fn step(
        &mut self,
        shared: &mut Shared<T>,
        tensioned: bool,
        station: &mut StationKeeping<T>,
    ) {
        let mut goals_m = if tensioned {
            lengths_m(shared)
        } else {
            [T::zero(); 3]
        };
        if let Some(target) = &shared.target {
            station.step(&shared.station, &target.unstretched_m, &mut goals_m);
            let mut lengths_m = target.unstretched_m;
            for (length, goal) in lengths_m.iter_mut().zip(goals_m) {
                *length += goal;
            }
            for (goal, lead) in goals_m.iter_mut().zip(shared.play.lead_m(&lengths_m)) {
                *goal += lead;
            }
        }
        for (i, step) in self.step_m.iter_mut().enumerate() {
            *step = (goals_m[i] - self.longer_m[i]) * T::HALF;
        }
    }

    /// Stays as it is: in a cycle without a step, what the last one has left would go on.
    #[inline(always)]
    pub fn stay(&mut self) {
        self.step_m = [T::zero(); 3];
    }

    /// By how much each tendon shall be longer in the next cycle, m.
    #[inline(always)]
    pub fn advance(&mut self) -> &[T; 3] {
        for (longer, &step) in self.longer_m.iter_mut().zip(&self.step_m) {
            *longer += step;
        }
        &self.longer_m
    }
}

/// By how much each tendon shall be longer to brake a swing, m; not at all before there are a target and an estimate.
#[inline(always)]
fn lengths_m<T: Scalar>(shared: &mut Shared<T>) -> [T; 3] {
    let (Some(target), Some(estimate)) = (&shared.target, &shared.estimate) else {
        return [T::zero(); 3];
    };
    let mut deviations_m = estimate.lengths_m;
    for (i, deviation) in deviations_m.iter_mut().enumerate() {
        *deviation -= target.kinematics.lengths[i];
    }
    let inertia = shared.mechanism.inertia(shared.estimator.payload_kg());
    let stiffness = bounds::max(shared.pretension.mean_stiffness_nm_per_rad(), T::one());
    let per_pretension = &target.distribution.per_pretension;
    shared
        .damping
        .step(&deviations_m, per_pretension, inertia, stiffness)
}
