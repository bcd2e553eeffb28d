//! The twist of a leg on a support with three freedoms: only its tendons and an elastic joint hold it.

use crate::joint::JointMoment;
use crate::{
    Direction, Error, FreePlane, Rig, Scalar, Support, TensionBounds, Twist, distribute,
    inverse_kinematics,
};
use nalgebra::Vector3;

/// Steps after which a search without convergence ends.
const STEPS_MAX: u8 = 20;

/// The elastic torsion, rad, at which tendons, joint and load balance about the third axis, too, while the pretension
/// keeps its `pretension` (N); by the secant method. Zero for a support that blocks the torsion.
///
/// # Errors
/// Those of [`inverse_kinematics`] and [`distribute`]; [`Error::Unstable`] if nothing holds the torsion, as without
/// any tension on a ball joint; [`Error::NotConverged`].
pub fn elastic_torsion<T: Scalar, const N: usize>(
    rig: &Rig<T, N>,
    support: &Support<T>,
    direction: &Direction<T>,
    load_moment: &Vector3<T>,
    bounds: &TensionBounds<T>,
    pretension: T,
) -> Result<T, Error> {
    if !support.twists() {
        return Ok(T::zero());
    }
    let third_axis = ThirdAxis {
        rig,
        direction,
        load_moment,
        bounds,
        pretension,
        joint: support.joint_moment_by_torsion(direction),
        twist: support.twist(direction),
        plane: support.plane(direction),
    };
    let moment_at = |torsion| third_axis.moment(torsion);
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

/// Everything about a pose that its elastic torsion does not change.
struct ThirdAxis<'a, T, const N: usize> {
    rig: &'a Rig<T, N>,
    direction: &'a Direction<T>,
    load_moment: &'a Vector3<T>,
    bounds: &'a TensionBounds<T>,
    pretension: T,
    joint: JointMoment<T>,
    twist: Twist<T>,
    plane: FreePlane<T>,
}

impl<T: Scalar, const N: usize> ThirdAxis<'_, T, N> {
    /// Moment on the leg along the normal of the plane of its tilts, N·m (times the length of that vector).
    fn moment(&self, torsion: T) -> Result<T, Error> {
        let twist = self.twist.composed(&Twist::from_torsion(torsion));
        let geometry = self.rig.geometry.twisted(&twist);
        let moment_map = inverse_kinematics(&geometry, self.direction)?.moment_map;
        let outer = self.load_moment + self.joint.moment(torsion);
        let distribution = distribute(&moment_map, &self.plane, &outer, self.bounds)?;
        let tensions = distribution.tensions(self.pretension);
        Ok((moment_map * tensions + outer).dot(&self.plane.normal()))
    }
}
