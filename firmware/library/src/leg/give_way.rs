//! Where a leg at rest gives way to its maximum tension.

use super::shared::Shared;
use crate::command::Compensation;
use crate::control::Measured;
use leg_model::Scalar;

/// How far a tendon of a leg at rest may be paid out for its tension, m: half of what its reference stays ahead of it, and on the paper's
/// rig 0.4 mm at the tip.
const GIVEN_WAY_M: f32 = 5e-5;

/// Part of the maximum tension above which a motor that stays behind is held back by it: the servo is slowed down in the last newtons.
const NEAR_MAX_PART: f32 = 0.95;

/// Whether a tendon is paid out because its tension is at the maximum, although no estimate of the load asks for it: a leg that leans goes
/// on sinking so, and a load cell that reads too much has it sink too.
#[inline(always)]
pub fn gives_way<T: Scalar>(shared: &Shared<T>, measured: &Measured<T>) -> bool {
    if shared.compensation == Compensation::Estimated {
        return false;
    }
    let near_max_n = shared.mechanism.f_max_n * T::from(NEAR_MAX_PART);
    let shown = measured.pulled_m.iter().zip(&measured.tensions_n);
    let mut axes = shared.axes.iter().zip(shown);
    axes.any(|(axis, (&pulled_m, &tension_n))| {
        tension_n > near_max_n && axis.reference_m() - pulled_m > T::from(GIVEN_WAY_M)
    })
}
