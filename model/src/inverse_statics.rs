//! Inverse statics: the unstretched lengths that put the loaded tip on its target.

use crate::{
    Direction, Distribution, Elasticity, Error, FreePlane, Geometry, Kinematics, Scalar,
    TensionBounds, distribute, inverse_kinematics,
};
use nalgebra::{SVector, Vector3};

/// What holds a loaded leg at a pose.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InverseStatics<T, const N: usize> {
    /// Lengths and moments of the tendons at the pose.
    pub kinematics: Kinematics<T, N>,
    /// All tensions that balance the load there.
    pub distribution: Distribution<T, N>,
    /// The tensions at the level, N.
    pub tensions: SVector<T, N>,
    /// u = l − δ(f): lengths of the tendons without tension, m. Tendons of these lengths bring the loaded leg to rest
    /// exactly at the pose.
    pub unstretched: SVector<T, N>,
}

/// Finds the unstretched lengths that hold the leg at `direction` against a moment, at a level of pretension in N.
///
/// `geometry` is twisted as the support twists it there. `moment` is all that turns the leg but its tendons, N·m: the
/// load's, as [`Load::moment`](crate::Load::moment) gives it for a known load or
/// [`estimate_moment`](crate::estimate_moment) from measured tensions, and that of an elastic joint.
///
/// # Errors
/// Those of [`inverse_kinematics`] and [`distribute`]; [`Error::OutOfBounds`] with the tendon and the bound if the
/// tensions at the level leave their bounds; [`Error::Infeasible`] if they do at every level; a tension that is
/// beyond a tendon's curve.
#[inline(always)]
pub fn inverse_statics<T: Scalar, E: Elasticity<T>, const N: usize>(
    geometry: &Geometry<T, N>,
    plane: &FreePlane<T>,
    direction: &Direction<T>,
    moment: &Vector3<T>,
    bounds: &TensionBounds<T>,
    tendons: &[E; N],
    level: T,
) -> Result<InverseStatics<T, N>, Error> {
    let kinematics = inverse_kinematics(geometry, direction)?;
    let distribution = distribute(&kinematics.moment_map, plane, moment, bounds)?;
    if !(distribution.lowest_level <= level && level <= distribution.highest_level) {
        return Err(distribution.refusal(bounds, level));
    }
    let tensions = distribution.tensions(level);
    let mut unstretched = kinematics.lengths;
    for (i, tendon) in tendons.iter().enumerate() {
        unstretched[i] -= tendon.elongation(tensions[i])?;
    }
    Ok(InverseStatics {
        kinematics,
        distribution,
        tensions,
        unstretched,
    })
}
