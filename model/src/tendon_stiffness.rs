//! Tendon stiffness K₁: the leg's stiffness from the elasticity of its tendons.

use crate::Scalar;
use nalgebra::{Matrix3, SMatrix, SVector};

/// K₁ = A diag(k) Aᵀ, N·m/rad (Eq. 9).
#[must_use]
pub fn tendon_stiffness<T: Scalar, const N: usize>(
    moment_map: &SMatrix<T, 3, N>,
    stiffnesses: &SVector<T, N>,
) -> Matrix3<T> {
    moment_map
        .column_iter()
        .zip(stiffnesses.iter())
        .fold(Matrix3::zeros(), |sum, (a, &k)| sum + a * a.transpose() * k)
}
