//! Where a leg at rest gives way to its maximum tension.

use super::shared::Shared;
use crate::command::Compensation;
use crate::control::{Measured, SLOW_STEP_S};
use leg_model::Scalar;

/// How far a tendon of a leg at rest may be paid out for its tension, m: half of what its reference stays ahead of it, and on the paper's
/// rig 0.4 mm at the tip.
const GIVEN_WAY_M: f32 = 5e-5;

/// Part of the maximum tension above which a motor that stays behind is held back by it: the servo is slowed down in the last newtons.
const NEAR_MAX_PART: f32 = 0.95;

/// How many steps it lasts until the leg has given way, 8 ms: at the end of a move to where a tension is near the maximum, a motor that the
/// servo has slowed down catches up in that.
pub const GIVEN_WAY_STEPS: u32 = (0.008 / SLOW_STEP_S) as u32;

/// Whether a tendon is paid out because its tension is at the maximum, although no target asks for it: a leg that leans goes on sinking so,
/// and a load cell that reads too much has it sink too. Where the load is estimated, there is a target for it, unless no pretension holds it.
#[inline(always)]
pub fn gives_way<T: Scalar>(
    shared: &Shared<T>,
    without_target: bool,
    measured: &Measured<T>,
) -> bool {
    if shared.compensation == Compensation::Estimated && !without_target {
        return false;
    }
    let near_max_n = shared.mechanism.f_max_n * T::from(NEAR_MAX_PART);
    let shown = measured.pulled_m.iter().zip(&measured.tensions_n);
    let mut axes = shared.axes.iter().zip(shown);
    axes.any(|(axis, (&pulled_m, &tension_n))| {
        tension_n > near_max_n && axis.reference_m() - pulled_m > T::from(GIVEN_WAY_M)
    })
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test may panic")]
mod tests {
    use super::gives_way;
    use crate::command::Compensation;
    use crate::control::Measured;
    use crate::leg::shared::{Checked, Shared};
    use crate::settings::Settings;

    /// A leg gives way where one motor is behind its reference and its tendon is near the maximum tension, and its load is not
    /// estimated or no target holds it. Either alone is none, nor are the two at different tendons.
    #[test]
    fn a_leg_gives_way_where_a_taut_tendon_is_paid_out() {
        let settings = Settings::table_1().unwrap();
        let f_max_n = f64::from(settings.f_max_n);
        let (near_n, less_n) = (0.96 * f_max_n, 0.94 * f_max_n);
        let mut shared = Shared::<f64>::new(&settings, Checked::new(&settings).unwrap());
        for (behind_m, tensions_n, gives) in [
            ([0.0, 6e-5, 0.0], [0.0, near_n, 0.0], true),
            ([0.0, 0.0, 6e-5], [0.0, 0.0, near_n], true),
            ([0.0, 4e-5, 0.0], [0.0, near_n, 0.0], false),
            ([0.0, 6e-5, 0.0], [0.0, less_n, 0.0], false),
            ([0.0, -6e-5, 0.0], [0.0, near_n, 0.0], false),
            ([6e-5, 0.0, 0.0], [0.0, near_n, 0.0], false),
            ([0.0; 3], [0.0; 3], false),
        ] {
            for axis in &mut shared.axes {
                axis.rest(0.01);
            }
            let measured = Measured::resting(behind_m.map(|behind| 0.01 - behind), tensions_n);
            for (compensation, without_target, expected) in [
                (Compensation::Off, false, gives),
                (Compensation::Frozen, false, gives),
                (Compensation::Estimated, false, false),
                (Compensation::Estimated, true, gives),
            ] {
                shared.compensation = compensation;
                let found = gives_way(&shared, without_target, &measured);
                assert_eq!(found, expected, "{behind_m:?} {tensions_n:?}");
            }
        }
    }
}
