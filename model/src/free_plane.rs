//! The rotations that a support with two freedoms allows.

use crate::solve::{Symmetric3, solve2, solve2_symmetric};
use crate::{Direction, Error, Scalar};
use nalgebra::{Matrix3, Vector3};

/// The rotations that a support with two freedoms allows: ψ = (ψ_x, ψ_y, ρ_xψ_x + ρ_yψ_y).
///
/// The plane is all that matters: tensions and rotations come out the same from any basis of it, and this one needs
/// neither a square root nor a normalisation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FreePlane<T> {
    pub(crate) rho_x: T,
    pub(crate) rho_y: T,
}

impl<T: Scalar> FreePlane<T> {
    /// The plane normal to the bisector z + Rz: ρ = q.
    #[must_use]
    #[inline(always)]
    pub fn torsion_free(direction: &Direction<T>) -> Self {
        let q = direction.half_tangent();
        Self {
            rho_x: q.x,
            rho_y: q.y,
        }
    }

    /// The axes x and (0, cos α, sin α) of a universal joint.
    #[must_use]
    #[inline(always)]
    pub fn universal(direction: &Direction<T>) -> Self {
        Self {
            rho_x: T::zero(),
            rho_y: -direction.y / direction.z,
        }
    }

    /// The plane normal to the leg: the rotations that move its tip.
    #[must_use]
    #[inline(always)]
    pub fn normal_to_leg(direction: &Direction<T>) -> Self {
        Self {
            rho_x: -direction.x / direction.z,
            rho_y: -direction.y / direction.z,
        }
    }

    /// The rotation with the components `x` and `y`.
    #[must_use]
    #[inline(always)]
    pub fn rotation(&self, [x, y]: [T; 2]) -> Vector3<T> {
        Vector3::new(x, y, self.rho_x * x + self.rho_y * y)
    }

    /// A vector normal to the plane, (−ρ_x, −ρ_y, 1).
    #[must_use]
    #[inline(always)]
    pub fn normal(&self) -> Vector3<T> {
        Vector3::new(-self.rho_x, -self.rho_y, T::one())
    }

    /// Pᵀm: what a moment does along the free rotations.
    #[must_use]
    #[inline(always)]
    pub fn project(&self, m: &Vector3<T>) -> [T; 2] {
        [m.x + self.rho_x * m.z, m.y + self.rho_y * m.z]
    }

    /// ψ = P(PᵀKP)⁻¹Pᵀm: the free rotation under a moment. K need not be symmetric.
    ///
    /// # Errors
    /// [`Error::Unstable`] unless PᵀKP is positive definite.
    #[inline(always)]
    pub fn solve(&self, k: &Matrix3<T>, m: &Vector3<T>) -> Result<Vector3<T>, Error> {
        let column = |i: usize| Vector3::new(k[(0, i)], k[(1, i)], k[(2, i)]);
        let [k11, k21] = self.project(&(column(0) + column(2) * self.rho_x));
        let [k12, k22] = self.project(&(column(1) + column(2) * self.rho_y));
        let free = solve2([[k11, k12], [k21, k22]], self.project(m))?;
        Ok(self.rotation(free))
    }

    /// [`Self::solve`] for a symmetric K and a moment (m_x, m_y, 0), as weights have.
    ///
    /// # Errors
    /// [`Error::Unstable`] unless PᵀKP is positive definite.
    #[inline(always)]
    pub fn solve_horizontal(&self, k: &Symmetric3<T>, m: [T; 2]) -> Result<Vector3<T>, Error> {
        let (right_x, right_y) = (k.xz + self.rho_x * k.zz, k.yz + self.rho_y * k.zz);
        let k11 = k.xx + self.rho_x * (k.xz + right_x);
        let k22 = k.yy + self.rho_y * (k.yz + right_y);
        let k12 = k.xy + self.rho_x * k.yz + self.rho_y * right_x;
        Ok(self.rotation(solve2_symmetric(k11, k12, k22, m)?))
    }
}
