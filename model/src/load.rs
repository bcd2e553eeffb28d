//! The moment of the weights about the joint centre.

use crate::range::{MASS_MAX, check_not_negative};
use crate::{Direction, Error, Quantity, Rig, Scalar};
use nalgebra::{Matrix3, SMatrix, SVector, Vector3};

/// The weights of the leg and its payload, which all hang on the leg's axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Load<T> {
    /// Σ weight × distance from the joint, N·m: the moment when the leg is horizontal.
    pub(crate) lever: T,
    /// Σ weight, N.
    pub(crate) weight: T,
}

impl<T: Scalar> Load<T> {
    /// The leg and a payload (kg) at its tip.
    ///
    /// # Errors
    /// A payload that is negative, not finite or above 10⁶ kg.
    pub fn new<const N: usize>(rig: &Rig<T, N>, payload_kg: T) -> Result<Self, Error> {
        check_not_negative(payload_kg, MASS_MAX, Quantity::Payload)?;
        Ok(Self {
            lever: rig.leg_moment + payload_kg * rig.gravity * rig.tip,
            weight: rig.leg_weight + payload_kg * rig.gravity,
        })
    }

    /// No weights.
    #[must_use]
    pub fn none() -> Self {
        Self {
            lever: T::zero(),
            weight: T::zero(),
        }
    }

    /// M = Σ R(0, 0, −L) × (0, 0, −mg), N·m. (Eq. 21 with its lever corrected.)
    #[must_use]
    #[inline(always)]
    pub fn moment(&self, direction: &Direction<T>) -> Vector3<T> {
        let [x, y] = self.horizontal_moment(direction);
        Vector3::new(x, y, T::zero())
    }

    /// Potential energy of the weights, J; zero with the leg horizontal.
    #[must_use]
    pub fn energy(&self, direction: &Direction<T>) -> T {
        self.lever * direction.z
    }

    /// The weights' pull along the leg, away from the joint, N.
    #[must_use]
    pub fn axial_force_n(&self, direction: &Direction<T>) -> T {
        self.weight * -direction.z
    }

    /// The moment without its vertical part, which is zero.
    #[inline(always)]
    pub(crate) fn horizontal_moment(&self, direction: &Direction<T>) -> [T; 2] {
        [-self.lever * direction.y, self.lever * direction.x]
    }

    /// `K_load = −Σ [F×][r×]`, N·m/rad: the weights turn with the leg. The paper leaves it out.
    #[must_use]
    pub fn stiffness(&self, direction: &Direction<T>) -> Matrix3<T> {
        let [x, y, z] = [direction.x, direction.y, direction.z].map(|c| self.lever * c);
        let zero = T::zero();
        Matrix3::new(-z, zero, x, zero, -z, y, zero, zero, zero)
    }
}

/// M̂ = −A f, N·m: the load that measured tensions balance. Only its part along the free axes means anything.
#[must_use]
#[inline(always)]
pub fn estimate_moment<T: Scalar, const N: usize>(
    moment_map: &SMatrix<T, 3, N>,
    tensions: &SVector<T, N>,
) -> Vector3<T> {
    let mut moment = Vector3::zeros();
    for i in 0..N {
        moment.x -= moment_map[(0, i)] * tensions[i];
        moment.y -= moment_map[(1, i)] * tensions[i];
        moment.z -= moment_map[(2, i)] * tensions[i];
    }
    moment
}
