//! What a leg finds of its tendons when it is tensioned after homing: by how much they stretch for what their curves say.
//!
//! A homed leg hangs straight down by its own weight. Counters and load cells of three tendons then show two freedoms, which are known, and
//! one number is left over: what all tendons are longer or shorter than their curves say. Tendons of another make or age are so by a fifth
//! and more. One load cell that is off shows a load, too, which a leg that hangs straight down cannot have.

use super::shared::Shared;
use crate::command::Compensation;
use crate::control::CYCLE_S;
use crate::supervisor::{Fault, FaultSet};
use leg_model::Scalar;

/// Time at the pretension that was asked for before the tendons are measured, s: a time constant of the trim. The search has a step in
/// every other cycle.
const STEADY_S: f32 = 0.5;
const STEADY_STEPS: u16 = (STEADY_S / (2.0 * CYCLE_S)) as u16;

/// The one in which its load is looked at.
const LOAD_STEP: u16 = STEADY_STEPS - 1;

/// Steps after which a leg that has not come to its pretension is not measured, 10 s.
const STEPS_MAX: u16 = 20 * STEADY_STEPS;

/// A target this near to the pretension that was asked for has it, N.
const NEAR_N: f32 = 0.5;

/// Least part by which tendons stretch otherwise than by their curves that is taken over. Less may come of one load cell that is off by so
/// little that it shows no load, and leaves little over.
const LEAST_PART: f32 = 0.03;

/// Bounds of all that is taken over since the settings were sent: what is beyond is no tendon of that curve.
const FACTORS: [f32; 2] = [0.7, 1.4];

/// The payloads whose moment, with the leg horizontal, a leg that hangs straight down must not show, kg: to be measured, and to be trusted.
/// On the paper's leg 0.1 and 0.3 N·m, 0.5 and 1.5 N at the tip. A load cell that is off by a tenth or by a fifth shows that.
const MEASURED_KG: f32 = 0.05;
const TRUSTED_KG: f32 = 0.15;

/// The search for the factor by which the tendons stretch.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StretchSearch {
    /// It is over, or was not begun.
    Over,
    /// The leg comes to its pretension.
    Tensioning {
        /// Steps at the pretension that was asked for.
        steady: u16,
        /// Steps since it was armed.
        steps: u16,
    },
    /// The tendons were scaled in this cycle or the last: what was known of lengths and tensions before does not hold.
    Scaled,
}

impl StretchSearch {
    /// Of a leg that was homed just now.
    pub const fn begin() -> Self {
        Self::Tensioning {
            steady: 0,
            steps: 0,
        }
    }

    /// Whether it is over.
    #[inline(always)]
    pub const fn is_over(self) -> bool {
        matches!(self, Self::Over)
    }

    /// One step of a leg of which nothing but its pretension was asked for, whether every tendon pulls or not. Adds the fault of a leg that
    /// shows a load; true if the tendons were scaled.
    #[cold]
    #[inline(never)]
    pub fn step<T: Scalar>(
        &mut self,
        shared: &mut Shared<T>,
        tensioned: bool,
        faults: &mut FaultSet,
    ) -> bool {
        let found = self.find(shared, tensioned);
        if found == StretchFound::Load {
            // It is not cleared before it has lost its zero, or was homed.
            shared.load_seen = true;
            faults.add(Fault::Residual, true);
        }
        let StretchFound::Factor(factor) = found else {
            return false;
        };
        shared.scale_tendons(factor);
        true
    }

    fn find<T: Scalar>(&mut self, shared: &Shared<T>, tensioned: bool) -> StretchFound<T> {
        let Self::Tensioning { steady, steps } = self else {
            *self = Self::Over;
            return StretchFound::Nothing;
        };
        let compensated = shared.compensation == Compensation::Estimated;
        let way = if tensioned {
            progress(shared)
        } else {
            Way::Open
        };
        *steps += 1;
        *steady = if way == Way::There { *steady + 1 } else { 0 };
        // No tick has time for all of it.
        let found = match *steady {
            LOAD_STEP => find_load(shared),
            STEADY_STEPS => find_factor(shared),
            _ => StretchFound::Nothing,
        };
        let ends = *steady == STEADY_STEPS || *steps == STEPS_MAX || !compensated;
        if let StretchFound::Factor(_) = found {
            *self = Self::Scaled;
        } else if ends || way == Way::Blocked || found == StretchFound::Load {
            *self = Self::Over;
        }
        found
    }
}

/// What a step finds.
#[derive(Clone, Copy, Debug, PartialEq)]
enum StretchFound<T> {
    /// Nothing to be done.
    Nothing,
    /// By how much the tendons stretch for what the settings say.
    Factor(T),
    /// A load that a leg that hangs straight down cannot have.
    Load,
}

/// How far a target is on its way to the pretension that was asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Way {
    Open,
    There,
    /// The bounds on the tensions hold it back.
    Blocked,
}

fn progress<T: Scalar>(shared: &Shared<T>) -> Way {
    let Some(target) = &shared.target else {
        return Way::Open;
    };
    let wish_n = shared.pretension.pretension_n();
    if (wish_n - target.pretension_n).abs() <= T::from(NEAR_N) {
        Way::There
    } else if target.is_capped_below(wish_n) {
        Way::Blocked
    } else {
        Way::Open
    }
}

/// Whether a leg that hangs straight down shows a load.
fn find_load<T: Scalar>(shared: &Shared<T>) -> StretchFound<T> {
    if load_is_within(shared, TRUSTED_KG) {
        StretchFound::Nothing
    } else {
        StretchFound::Load
    }
}

/// By how much its tendons stretch.
fn find_factor<T: Scalar>(shared: &Shared<T>) -> StretchFound<T> {
    let estimate = shared.estimate.as_ref();
    let Some(error) = estimate.and_then(|estimate| estimate.length_error.as_ref()) else {
        return StretchFound::Nothing;
    };
    let [a, b, c] = error.elongations_m;
    let factor = T::one() - error.mean_m * T::from(3.0) / (a + b + c);
    let all = shared.elongation_factor * factor;
    let [least, most] = FACTORS.map(T::from);
    let is_other = |factor: T| (factor - T::one()).abs() > T::from(LEAST_PART);
    if is_other(factor) && all >= least && all <= most && load_is_within(shared, MEASURED_KG) {
        // Where what was taken over before was wrong, as with a payload while homing, the settings are right.
        StretchFound::Factor(if is_other(all) { all } else { T::one() })
    } else {
        StretchFound::Nothing
    }
}

/// Whether the load is not more than this payload has about the leg's joint with the leg horizontal, kg; a load that is no number is more.
fn load_is_within<T: Scalar>(shared: &Shared<T>, payload_kg: f32) -> bool {
    let most_nm = shared.mechanism.payload_lever * T::from(payload_kg);
    let [x, y] = shared.estimator.excess_nm(&shared.mechanism);
    x * x + y * y <= most_nm * most_nm
}

#[cfg(test)]
mod tests;
