//! Formulas as the paper prints them, for comparison only: each is wrong, and its page says why.
//!
//! Nothing else in this crate computes with them. `leg paper` of the project's command line shows each beside the right
//! one.

use crate::structural_stiffness::sum_over_tendons;
use crate::{Direction, Error, Geometry, JointStiffness, Scalar};
use nalgebra::{Matrix3, SVector, Vector3};

/// K₂ as Eq. (15) prints it, `Σ f[n×][e×]`, N·m/rad; the right one is [`structural_stiffness`](crate::structural_stiffness).
///
/// It has the wrong sign for n from S to B and lacks the change of n, so it claims that pretension stiffens bending.
#[must_use]
pub fn structural_stiffness<T: Scalar, const N: usize>(
    geometry: &Geometry<T, N>,
    direction: &Direction<T>,
    tensions: &SVector<T, N>,
) -> Matrix3<T> {
    sum_over_tendons(geometry, direction, tensions, |tendon, base| {
        let e = tendon.end();
        let n = (base - e) * tendon.inverse_length;
        skew(&n) * skew(&e)
    })
}

/// [v×] (Eq. 16).
fn skew<T: Scalar>(v: &Vector3<T>) -> Matrix3<T> {
    let zero = T::zero();
    Matrix3::new(zero, -v.z, v.y, v.z, zero, -v.x, -v.y, v.x, zero)
}

/// Rᵀ diag(K_x, K_y, 1/(1/K_z + L/EA)) R (Eq. 18), for a leg with the rotation R.
///
/// It mixes N·m/rad with N/m, and turns the joint's axes in the wrong sense.
///
/// # Errors
/// [`Error::Singular`] when the joint is rigid along the leg, so that the third entry is infinite.
pub fn support_stiffness<T: Scalar>(
    joint: &JointStiffness<T>,
    rotation: &Matrix3<T>,
) -> Result<Matrix3<T>, Error> {
    if !(joint.axial_compliance_m_per_n > T::zero()) {
        return Err(Error::Singular);
    }
    let bending = joint.bending_nm_per_rad;
    let axial = T::one() / joint.axial_compliance_m_per_n;
    let third = rotation.row(2).transpose();
    Ok(Matrix3::identity() * bending + third * third.transpose() * (axial - bending))
}

/// [(K₁ + K₂)⁻¹ + K₃⁻¹]⁻¹ (Eq. 20), as (K₁ + K₂)(K₁ + K₂ + K₃)⁻¹K₃, which also serves a singular K₃.
///
/// In series a joint that turns freely leaves no stiffness at all: K₃ = 0 gives K = 0.
///
/// # Errors
/// [`Error::Singular`] if the sum of the two has no inverse.
pub fn series_stiffness<T: Scalar>(
    tendons: &Matrix3<T>,
    support: &Matrix3<T>,
) -> Result<Matrix3<T>, Error> {
    let sum = tendons + support;
    let column = |i| sum.column(i).into_owned();
    let (c1, c2, c3) = (column(0), column(1), column(2));
    let cofactors = Matrix3::from_columns(&[c2.cross(&c3), c3.cross(&c1), c1.cross(&c2)]);
    let determinant = c1.dot(&c2.cross(&c3));
    if determinant == T::zero() || !determinant.is_finite() {
        return Err(Error::Singular);
    }
    Ok(tendons * (cofactors.transpose() / determinant) * support)
}

/// R diag(K_bending, K_bending, K_torsion) Rᵀ: the joint's diagonal turned with the leg, N·m/rad.
///
/// These are Eqs. (17)–(19) with their axes turned in the right sense, not yet the derivative of the joint's moment
/// ([`Support::joint_stiffness`](crate::Support::joint_stiffness)). It equals the stiffness of the joint at the vertical.
#[must_use]
pub fn joint_stiffness_leg_fixed<T: Scalar>(
    joint: &JointStiffness<T>,
    direction: &Direction<T>,
) -> Matrix3<T> {
    let (bending, torsion) = (joint.bending_nm_per_rad, joint.torsion_nm_per_rad);
    let p = direction.vector();
    Matrix3::identity() * bending + p * p.transpose() * (torsion - bending)
}
