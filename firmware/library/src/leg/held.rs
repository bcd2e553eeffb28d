//! Held: the motors brake to a stop, and rest on their screws from then on.

use super::shared::Shared;
use crate::control::TICK_S;
use leg_model::Scalar;

/// Time in which a moving leg is braked, s: stopped at once, it would swing on with its payload, and double the tension of a
/// tendon. About a period of that swing; at the greatest speed the tip goes on by 15 mm.
const BRAKE_S: f32 = 0.15;

/// The same in ticks.
const BRAKE_TICKS: u32 = (BRAKE_S / TICK_S) as u32;

/// A motor that is led by less than this in a tick stands, m: 0.1 mm/s.
const STILL_STEP_M: f32 = 1e-4 * TICK_S;

/// The leg stays where it is. No load cell is asked.
#[derive(Clone, Copy, Debug)]
pub struct Held<T> {
    /// How far each motor went in a tick at first, m.
    steps_m: [T; 3],
    ticks_left: u32,
}

impl<T: Scalar> Held<T> {
    /// From how far the motors go in a tick now, m.
    pub fn braking(steps_m: [T; 3]) -> Self {
        let still = steps_m
            .iter()
            .all(|step| step.abs() <= T::from(STILL_STEP_M));
        Self {
            steps_m,
            ticks_left: if still { 0 } else { BRAKE_TICKS },
        }
    }

    /// At rest.
    pub fn resting() -> Self {
        Self {
            steps_m: [T::zero(); 3],
            ticks_left: 0,
        }
    }

    /// Whether the motors still turn.
    #[inline(always)]
    pub const fn brakes(&self) -> bool {
        self.ticks_left > 0
    }

    /// One tick.
    #[inline(always)]
    pub fn step(&mut self, shared: &mut Shared<T>) {
        if !self.brakes() {
            return;
        }
        self.ticks_left -= 1;
        let part = T::from(self.ticks_left as f32 * (1.0 / BRAKE_TICKS as f32));
        for (axis, step_m) in shared.axes.iter_mut().zip(&mut self.steps_m) {
            // One that stands is led no farther: it may be turning without being counted, or not turn at all.
            if axis.moved_m().abs() <= T::from(STILL_STEP_M) {
                *step_m = T::zero();
            }
            axis.lead_by(*step_m * part);
            if *step_m == T::zero() {
                axis.rest_here();
            } else if self.ticks_left == 0 {
                axis.rest(axis.reference_m());
            }
        }
    }
}
