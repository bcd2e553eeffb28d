//! What is added to the lengths of a target, in every other cycle: the brake of the leg's swing, what a station still lacks, and the
//! play of the gears. Each step comes in the two cycles after it.

use super::shared::Shared;
use super::station::StationKeeping;
use crate::control::{SwingDamping, bounds};
use leg_model::Scalar;

/// Cycles from one step to the next, over which the step is spread so that the speed of a tendon is steady. Two, because a cycle has
/// time for these offsets or for the search for the pretension.
const CYCLES: u8 = 2;

/// By how much the tendons are longer than the target asks, and their motors behind.
#[derive(Clone, Copy, Debug)]
pub struct LengthOffsets<T> {
    /// Cycles in which the last step still comes.
    cycles_left: u8,
    longer_m: [T; 3],
    /// How that changes in a cycle, m.
    step_m: [T; 3],
}

impl<T: Scalar> LengthOffsets<T> {
    /// At rest, with motors that are so far behind their screws, m.
    pub fn new(behind_m: &[T; 3]) -> Self {
        Self {
            cycles_left: 0,
            longer_m: *behind_m,
            step_m: [T::zero(); 3],
        }
    }

    /// Brakes a swing about the last target, keeps a leg at its station from going there too fast, and leads the motors across the play.
    /// In one cycle, the speed of the tendons would go up and down with the cycles.
    #[inline(never)]
    pub fn step(
        &mut self,
        shared: &mut Shared<T>,
        tensioned: bool,
        station: &mut StationKeeping<T>,
    ) {
        let mut goals_m = if tensioned {
            let known = shared.mechanism.inertia(shared.estimator.load.payload_kg());
            let known_s = first_mode_s(shared, known);
            shared.estimator.load.follow_mode(known_s);
            let likely_kg = shared.estimator.load.likely_payload_kg();
            let inertia = shared.mechanism.inertia(likely_kg);
            let time_constant_s = first_mode_s(shared, inertia);
            brake_m(shared, inertia, time_constant_s)
        } else {
            [T::zero(); 3]
        };
        if let Some(target) = &shared.target {
            station.step(&shared.station, &target.unstretched_m, &mut goals_m);
            let mut lengths_m = target.unstretched_m;
            for (length, goal) in lengths_m.iter_mut().zip(goals_m) {
                *length += goal;
            }
            for (goal, lag) in goals_m.iter_mut().zip(shared.play.cross_m(&lengths_m)) {
                *goal += lag;
            }
        }
        for (i, step) in self.step_m.iter_mut().enumerate() {
            *step = (goals_m[i] - self.longer_m[i]) * T::HALF;
        }
        self.cycles_left = CYCLES;
    }

    /// Stays as it is.
    pub fn stay(&mut self) {
        self.cycles_left = 0;
    }

    /// By how much each tendon shall be longer in the next cycle, m. Nothing is added in a cycle beyond those of a step.
    #[inline(always)]
    pub fn advance(&mut self) -> &[T; 3] {
        if self.cycles_left > 0 {
            self.cycles_left -= 1;
            for (longer, &step) in self.longer_m.iter_mut().zip(&self.step_m) {
                *longer += step;
            }
        }
        &self.longer_m
    }
}

/// Time constant 1/ω of the first mode of a leg with an inertia, kg·m²; s.
#[inline(always)]
fn first_mode_s<T: Scalar>(shared: &Shared<T>, inertia: T) -> T {
    let stiffness = bounds::max(shared.pretension.swing_stiffness_nm_per_rad(), T::one());
    SwingDamping::time_constant_s(inertia, stiffness)
}

/// By how much each tendon shall be longer to brake a swing, m; not at all before there are a target and an estimate.
#[inline(always)]
fn brake_m<T: Scalar>(shared: &mut Shared<T>, inertia: T, time_constant_s: T) -> [T; 3] {
    let (Some(target), Some(estimate)) = (&shared.target, &shared.estimate) else {
        return [T::zero(); 3];
    };
    let mut deviations_m = estimate.lengths_m;
    for (i, deviation) in deviations_m.iter_mut().enumerate() {
        *deviation -= target.kinematics.lengths[i];
    }
    let per_pretension = &target.distribution.per_pretension;
    shared
        .damping
        .step(&deviations_m, per_pretension, inertia, time_constant_s)
}
