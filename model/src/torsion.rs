//! The twist of a leg on a ball joint, which only its tendons hold.

use crate::{
    Direction, Error, FreePlane, Load, Rig, Scalar, TensionBounds, Twist, distribute,
    inverse_kinematics,
};

/// Steps after which a search without convergence ends.
const STEPS_MAX: u8 = 20;

/// The torsion, rad, at which the tendons' moment about the bisector of the two plates' normals vanishes while the
/// pretension keeps its `level` (N), by the secant method.
///
/// # Errors
/// Those of [`inverse_kinematics`] and [`distribute`]; [`Error::Unstable`] if nothing holds the torsion, as without
/// any tension; [`Error::NotConverged`].
pub fn ball_joint_torsion<T: Scalar, const N: usize>(
    rig: &Rig<T, N>,
    direction: &Direction<T>,
    load: &Load<T>,
    bounds: &TensionBounds<T>,
    level: T,
) -> Result<T, Error> {
    let moment_at = |torsion| torsion_moment(rig, direction, load, bounds, level, torsion);
    // A thousandth of a radian is small beside the curvature of the moment and large beside its rounding.
    let (mut last, mut torsion) = (T::zero(), T::TORSION_START_RAD);
    let mut last_moment = moment_at(last)?;
    for _ in 0..STEPS_MAX {
        let moment = moment_at(torsion)?;
        let change = moment - last_moment;
        if change == T::zero() {
            return Err(Error::Unstable);
        }
        let step = -moment * (torsion - last) / change;
        (last, last_moment, torsion) = (torsion, moment, torsion + step);
        if step.abs() <= T::TORSION_STEP_RAD {
            return Ok(torsion);
        }
    }
    Err(Error::NotConverged)
}

/// Moment of the tendons along z + Rz at a torsion, N·m (times the length of that vector).
fn torsion_moment<T: Scalar, const N: usize>(
    rig: &Rig<T, N>,
    direction: &Direction<T>,
    load: &Load<T>,
    bounds: &TensionBounds<T>,
    level: T,
    torsion: T,
) -> Result<T, Error> {
    let geometry = rig.geometry.twisted(&Twist::from_torsion(torsion));
    let moment_map = inverse_kinematics(&geometry, direction)?.moment_map;
    let plane = FreePlane::torsion_free(direction);
    let tensions =
        distribute(&moment_map, &plane, &load.moment(direction), bounds)?.tensions(level);
    let moment = moment_map * tensions;
    Ok(moment.z * (T::one() - direction.z) - moment.x * direction.x - moment.y * direction.y)
}
