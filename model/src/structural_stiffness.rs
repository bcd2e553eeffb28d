//! Structural stiffness K₂: what the tensions add while the mechanism turns (Eqs. 10–16).

use crate::kinematics::TendonAtPose;
use crate::{Direction, Geometry, Scalar};
use nalgebra::{Matrix3, SVector, Vector3};

/// K₂ exactly, N·m/rad.
///
/// The derivative of the tendons' moment at constant tensions,
/// `Σ f(−[n×][e×] + (1/l)[e×](I − nnᵀ)[e×]ᵀ)`, is Σ (f/l)((e·B)I − eBᵀ − aaᵀ) with a = e × n, because the squares
/// of e cancel. Its antisymmetric part is half the moment of the tendons.
#[must_use]
pub fn structural_stiffness<T: Scalar, const N: usize>(
    geometry: &Geometry<T, N>,
    direction: &Direction<T>,
    tensions: &SVector<T, N>,
) -> Matrix3<T> {
    sum_over_tendons(geometry, direction, tensions, |tendon, base| {
        let (e, a) = (tendon.end(), tendon.moment());
        let spread = Matrix3::identity() * e.dot(&base) - e * base.transpose() - a * a.transpose();
        spread * tendon.inverse_length
    })
}

/// Σ f·term(tendon, B).
pub(crate) fn sum_over_tendons<T: Scalar, const N: usize>(
    geometry: &Geometry<T, N>,
    direction: &Direction<T>,
    tensions: &SVector<T, N>,
    term: impl Fn(&TendonAtPose<T>, Vector3<T>) -> Matrix3<T>,
) -> Matrix3<T> {
    let q = direction.half_tangent();
    let pairs = geometry.tendons.iter().zip(tensions.iter());
    pairs.fold(Matrix3::zeros(), |sum, (pair, &tension)| {
        let tendon = TendonAtPose::new(pair, geometry, &q, direction.gain());
        let base = Vector3::new(pair.base[0], pair.base[1], geometry.upper);
        sum + term(&tendon, base) * tension
    })
}
