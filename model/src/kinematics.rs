//! Inverse kinematics: the lengths of the tendons and their moments at a direction of the leg.

use crate::geometry::AnchorPair;
use crate::{Direction, Error, Geometry, HalfTangent, Scalar};
use nalgebra::{SMatrix, SVector, Vector3};

/// What the tendons do at a pose.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Kinematics<T, const N: usize> {
    /// Geometric length of each tendon, m (Eq. 4).
    pub lengths: SVector<T, N>,
    /// A = [e_i × n_i]: the moment about the joint centre of a unit tension in each tendon, m (the lower rows of
    /// Eq. 7). A rotation ψ of the leg changes the lengths by −Aᵀψ.
    pub moment_map: SMatrix<T, 3, N>,
}

impl<T: Scalar, const N: usize> Kinematics<T, N> {
    #[inline(always)]
    pub(crate) fn zero() -> Self {
        Self {
            lengths: SVector::zeros(),
            moment_map: SMatrix::zeros(),
        }
    }

    /// The error of a pose at which a tendon has no length.
    pub(crate) fn collapsed(&self) -> Option<Error> {
        let product = self
            .lengths
            .iter()
            .fold(T::one(), |product, &length| product * length);
        require_lengths(product).err()
    }

    #[inline(always)]
    pub(crate) fn set(&mut self, i: usize, tendon: &TendonAtPose<T>) {
        self.lengths[i] = tendon.length;
        self.moment_map[(0, i)] = tendon.moment[0];
        self.moment_map[(1, i)] = tendon.moment[1];
        self.moment_map[(2, i)] = tendon.moment[2];
    }
}

/// Lengths and moment map of a leg that points along `direction` without torsion (Eqs. 3, 4, 7).
///
/// A twisted leg goes in as [`Geometry::twisted`].
///
/// ```
/// use leg_model::{Direction, Rig, RigParameters, inverse_kinematics};
///
/// let rig = Rig::new(&RigParameters::<f64, 3>::TABLE_1)?;
/// let hanging = inverse_kinematics(rig.geometry(), &Direction::straight_down())?;
/// assert!(hanging.lengths.iter().all(|length| (length - 0.035).abs() < 1e-12));
/// # Ok::<(), leg_model::Error>(())
/// ```
///
/// # Errors
/// [`Error::TendonCollapsed`] if the two ends of a tendon meet.
#[inline(always)]
pub fn inverse_kinematics<T: Scalar, const N: usize>(
    geometry: &Geometry<T, N>,
    direction: &Direction<T>,
) -> Result<Kinematics<T, N>, Error> {
    let q = direction.half_tangent();
    let mut kinematics = Kinematics::zero();
    let mut product = T::one();
    for (i, pair) in geometry.tendons.iter().enumerate() {
        let tendon = TendonAtPose::new(pair, geometry, &q, direction.gain());
        kinematics.set(i, &tendon);
        product *= tendon.length;
    }
    require_lengths(product)?;
    Ok(kinematics)
}

/// Refuses a zero (or NaN) among the lengths by their product: one comparison for all of them.
#[inline(always)]
fn require_lengths<T: Scalar>(product: T) -> Result<(), Error> {
    if product > T::zero() {
        Ok(())
    } else {
        Err(Error::TendonCollapsed)
    }
}

/// One tendon at a pose.
pub(crate) struct TendonAtPose<T> {
    /// Lower end e, m.
    pub end: [T; 3],
    /// |B − e|, m.
    pub length: T,
    /// 1/|B − e|, 1/m.
    pub inverse_length: T,
    /// a = e × n = (e × B)/l, m.
    pub moment: [T; 3],
}

impl<T: Scalar> TendonAtPose<T> {
    /// The rotation as two reflections: with t = γ(L_joint − q·s), e = (s, L_joint) + t(q, −1) and
    /// l² = |b − s|² + (L_upper − L_joint)² + 2t(L_upper − q·b). Nothing in l² cancels.
    #[inline(always)]
    pub fn new<const N: usize>(
        pair: &AnchorPair<T>,
        geometry: &Geometry<T, N>,
        q: &HalfTangent<T>,
        gain: T,
    ) -> Self {
        let (upper, joint) = (geometry.upper, geometry.joint);
        let [base_x, base_y] = pair.base;
        let [leg_x, leg_y] = pair.leg;
        let t = gain * (joint - q.x * leg_x - q.y * leg_y);
        let end = [leg_x + t * q.x, leg_y + t * q.y, joint - t];
        let rise = t * (upper - q.x * base_x - q.y * base_y);
        let length = (pair.square + (rise + rise)).sqrt();
        let inverse_length = T::one() / length;
        let moment = [
            (end[1] * upper - end[2] * base_y) * inverse_length,
            (end[2] * base_x - end[0] * upper) * inverse_length,
            (end[0] * base_y - end[1] * base_x) * inverse_length,
        ];
        Self {
            end,
            length,
            inverse_length,
            moment,
        }
    }

    /// Lower end, m.
    pub fn end(&self) -> Vector3<T> {
        Vector3::from(self.end)
    }

    /// Moment of a unit tension, m.
    pub fn moment(&self) -> Vector3<T> {
        Vector3::from(self.moment)
    }
}
