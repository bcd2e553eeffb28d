//! Inverse statics: the unstretched lengths that put the loaded tip on its target.

use crate::{
    Bound, Direction, Distribution, Elasticity, Error, FreePlane, Geometry, Kinematics, Limit, Rig,
    Scalar, Support, TensionBounds, Twist, distribute, elastic_torsion, estimate_moment,
    inverse_kinematics,
};
use core::fmt;
use nalgebra::{SVector, Vector3};

/// What holds a loaded leg at a pose.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hold<T, const N: usize> {
    /// The tensions at the pretension, N.
    pub tensions: SVector<T, N>,
    /// u = l − δ(f): lengths of the tendons without tension, m. Tendons of these lengths bring the loaded leg to rest
    /// exactly at the pose. What joint and shaft stretch along the leg is not undone: that takes another freedom.
    pub unstretched: SVector<T, N>,
}

/// Why nothing holds the leg at a pose.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum HoldError {
    /// The model has no result there.
    Model(Error),
    /// At the pretension a tendon is beyond a bound.
    OutOfBounds(Limit),
    /// At every pretension one is: which ends the range of pretensions below, and which above.
    Infeasible([Limit; 2]),
}

impl From<Error> for HoldError {
    fn from(error: Error) -> Self {
        Self::Model(error)
    }
}

impl fmt::Display for HoldError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Model(error) => error.fmt(f),
            Self::OutOfBounds(limit) => write!(f, "at this pretension {limit}"),
            Self::Infeasible([lowest, highest]) => write!(
                f,
                "at every pretension a tendon leaves its bounds: at low ones {lowest}, at high ones {highest}"
            ),
        }
    }
}

impl core::error::Error for HoldError {}

impl fmt::Display for Limit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { tendon, bound } = self;
        match bound {
            Bound::Min => write!(f, "tendon {tendon} is below the lowest tension"),
            Bound::Max => write!(f, "tendon {tendon} is above the highest tension"),
        }
    }
}

/// Finds the unstretched lengths that hold the leg at `direction` against a load, at a pretension in N, on any
/// support.
///
/// `load_moment` (N·m) is that of the load: [`Load::moment`](crate::Load::moment) of a known one, or what
/// [`estimate_load`] makes of measured tensions.
///
/// ```
/// use leg_model::{Direction, Load, Rig, RigParameters, SupportKind, Tendon, TensionBounds,
///     inverse_statics};
///
/// let rig = Rig::new(&RigParameters::<f64, 3>::TABLE_1)?;
/// let leaning = Direction::from_angles(0.0, 0.3)?;
/// let tendons = [Tendon::constant(9.945e4)?; 3];
/// let moment = Load::new(&rig, 1.0)?.moment(&leaning);
/// let (support, bounds) = (SupportKind::TorsionFree.into(), TensionBounds::new(8.0, 150.0)?);
/// let held = inverse_statics(&rig, &support, &leaning, &moment, &bounds, &tendons, 70.0)?;
/// assert!(held.unstretched.iter().all(|length| *length > 0.0));
/// // Far too heavy: the error names the tendons and bounds that exclude it.
/// let heavy = moment * 20.0;
/// assert!(inverse_statics(&rig, &support, &leaning, &heavy, &bounds, &tendons, 70.0).is_err());
/// # Ok::<(), leg_model::HoldError>(())
/// ```
///
/// # Errors
/// Those of [`elastic_torsion`](crate::elastic_torsion), [`inverse_kinematics`] and [`distribute`];
/// [`HoldError::OutOfBounds`] with the tendon and the bound if the tensions at the pretension leave their bounds;
/// [`HoldError::Infeasible`] if they do at every pretension; a tension that is beyond a tendon's curve.
pub fn inverse_statics<T: Scalar, E: Elasticity<T>, const N: usize>(
    rig: &Rig<T, N>,
    support: &Support<T>,
    direction: &Direction<T>,
    load_moment: &Vector3<T>,
    bounds: &TensionBounds<T>,
    tendons: &[E; N],
    pretension: T,
) -> Result<Hold<T, N>, HoldError> {
    let torsion = elastic_torsion(rig, support, direction, load_moment, bounds, pretension)?;
    let twist = support
        .twist(direction)
        .composed(&Twist::from_torsion(torsion));
    let geometry = rig.geometry.twisted(&twist);
    let plane = support.plane(direction);
    let moment = load_moment + support.joint_moment(direction, torsion);
    inverse_statics_in_plane(
        &geometry, &plane, direction, &moment, bounds, tendons, pretension,
    )
}

/// The load that measured tensions balance, with what an elastic joint takes of it: M̂ = −A f − M_joint, N·m.
///
/// `geometry` is twisted as the leg is, `torsion` (rad) its elastic part. Only the part of the result along the free
/// rotations means anything.
///
/// ```
/// use leg_model::nalgebra::Vector3;
/// use leg_model::{Direction, Rig, RigParameters, SupportKind, estimate_load};
///
/// let rig = Rig::new(&RigParameters::<f64, 3>::TABLE_1)?;
/// // Straight down equal tensions carry no moment, whatever hangs on the leg.
/// let (down, tensions) = (Direction::straight_down(), Vector3::repeat(70.0));
/// let support = SupportKind::TorsionFree.into();
/// let load = estimate_load(rig.geometry(), &support, &down, 0.0, &tensions)?;
/// assert!(load.dot(&load) < 1e-24);
/// # Ok::<(), leg_model::Error>(())
/// ```
///
/// # Errors
/// As [`inverse_kinematics`].
pub fn estimate_load<T: Scalar, const N: usize>(
    geometry: &Geometry<T, N>,
    support: &Support<T>,
    direction: &Direction<T>,
    torsion: T,
    tensions: &SVector<T, N>,
) -> Result<Vector3<T>, Error> {
    let moment_map = inverse_kinematics(geometry, direction)?.moment_map;
    let all = estimate_moment(&moment_map, tensions);
    Ok(all - support.joint_moment(direction, torsion))
}

/// [`inverse_statics`] on the fast path: `geometry` is twisted as the support twists it at `direction`, `plane` are its
/// free rotations there, and `moment` (N·m) is all that turns the leg but its tendons.
///
/// # Errors
/// As [`inverse_statics`].
#[inline(always)]
pub fn inverse_statics_in_plane<T: Scalar, E: Elasticity<T>, const N: usize>(
    geometry: &Geometry<T, N>,
    plane: &FreePlane<T>,
    direction: &Direction<T>,
    moment: &Vector3<T>,
    bounds: &TensionBounds<T>,
    tendons: &[E; N],
    pretension: T,
) -> Result<Hold<T, N>, HoldError> {
    let kinematics = inverse_kinematics(geometry, direction)?;
    let distribution = distribute(&kinematics.moment_map, plane, moment, bounds)?;
    hold(&kinematics, &distribution, bounds, tendons, pretension)
}

/// The last step of [`inverse_statics`], where kinematics and distribution are at hand.
///
/// # Errors
/// As [`inverse_statics`].
#[inline(always)]
pub fn hold<T: Scalar, E: Elasticity<T>, const N: usize>(
    kinematics: &Kinematics<T, N>,
    distribution: &Distribution<T, N>,
    bounds: &TensionBounds<T>,
    tendons: &[E; N],
    pretension: T,
) -> Result<Hold<T, N>, HoldError> {
    if !(distribution.pretension_min <= pretension && pretension <= distribution.pretension_max) {
        return Err(refusal(distribution, bounds, pretension));
    }
    let tensions = distribution.tensions(pretension);
    let mut unstretched = kinematics.lengths;
    for (i, tendon) in tendons.iter().enumerate() {
        unstretched[i] -= tendon.elongation(tensions[i])?;
    }
    Ok(Hold {
        tensions,
        unstretched,
    })
}

#[cold]
#[inline(never)]
fn refusal<T: Scalar, const N: usize>(
    distribution: &Distribution<T, N>,
    bounds: &TensionBounds<T>,
    pretension: T,
) -> HoldError {
    let limits = distribution.limits(bounds);
    let [lowest, highest] = limits;
    if !distribution.feasible() {
        HoldError::Infeasible(limits)
    } else if pretension < distribution.pretension_min {
        HoldError::OutOfBounds(lowest)
    } else {
        HoldError::OutOfBounds(highest)
    }
}
