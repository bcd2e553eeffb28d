//! Where a leg would point without its weights.

use super::{Mechanism, target::pretension};
use leg_model::{
    Direction, Elasticity, Error, Scalar, SupportKind, distribute, forward_kinematics,
    forward_kinematics_universal, inverse_kinematics,
};
use nalgebra::SVector;

/// Steps of the search: the sag is up to 3°, and the first one leaves a thirtieth of it.
const STEPS: usize = 2;

/// The direction of a leg whose tendons have these lengths without tension, m, and these tensions, N, if it carried nothing, not even
/// itself. A target that leaves the weights out gives these lengths there: a leg that begins there stays where it is. The search
/// starts from where it points.
///
/// # Errors
/// What kinematics and distribution refuse; a tension beyond a tendon's curve.
#[inline(never)]
pub fn unloaded_direction<T: Scalar>(
    mechanism: &Mechanism<T>,
    unstretched_m: &[T; 3],
    tensions_n: &[T; 3],
    loaded: &Direction<T>,
    torsion: T,
) -> Result<Direction<T>, Error> {
    let mut direction = *loaded;
    for _ in 0..STEPS {
        let mut twisted = None;
        let geometry = mechanism.geometry(&direction, torsion, &mut twisted);
        let kinematics = inverse_kinematics(geometry, &direction)?;
        let plane = mechanism.support.plane(&direction);
        let moment = mechanism.support.joint_moment(&direction, torsion);
        let distribution = distribute(&kinematics.moment_map, &plane, &moment, &mechanism.bounds)?;
        let tensions = distribution.tensions(pretension(&distribution, tensions_n));
        let mut lengths = SVector::<T, 3>::zeros();
        for (i, tendon) in mechanism.tendons.iter().enumerate() {
            lengths[i] = unstretched_m[i] + tendon.elongation(tensions[i])?;
        }
        let found = if mechanism.support.kind() == SupportKind::Universal {
            forward_kinematics_universal(mechanism.rig.geometry(), &lengths, &direction)?
        } else {
            forward_kinematics(geometry, &lengths, &direction)?
        };
        direction = found.direction;
    }
    Ok(direction)
}
