//! Forward kinematics: the direction of the leg from the lengths of its tendons.
//!
//! Three lengths on two freedoms are overdetermined, so the direction is found by Gauss–Newton least squares in
//! half-tangent coordinates, which are smooth through the vertical and make each tendon's equation a polynomial of
//! second degree ([`LengthPolynomial`]). The residual is a free check: a tendon that jumped or a count that was lost
//! shows there.

use crate::geometry::AnchorPair;
use crate::length_polynomial::LengthPolynomial;
use crate::pose::universal_torsion_gradient;
use crate::solve::NormalEquations;
use crate::{Direction, Error, Geometry, HalfTangent, Quantity, Reason, Scalar, Twist};
use nalgebra::SVector;

/// Steps after which a search without convergence ends.
const STEPS_MAX: u8 = 10;

/// What forward kinematics found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ForwardKinematics<T> {
    /// Direction of the leg.
    pub direction: Direction<T>,
    /// Root of the sum of squares of what remains between measured and modelled lengths, m.
    pub residual_m: T,
    /// Steps taken.
    pub steps: u8,
}

/// Direction of a leg without torsion (or with a known one: [`Geometry::twisted`]) from the lengths of its tendons:
/// Eqs. (3–4) inverted in the sense of least squares.
///
/// `start` is the last known direction.
///
/// ```
/// use leg_model::nalgebra::Vector3;
/// use leg_model::{Direction, Rig, RigParameters, forward_kinematics};
///
/// let rig = Rig::new(&RigParameters::<f64, 3>::TABLE_1)?;
/// let measured_m = Vector3::new(0.0349, 0.0351, 0.0350);
/// let found = forward_kinematics(rig.geometry(), &measured_m, &Direction::straight_down())?;
/// // The leg leans towards the shortest tendon; no direction fits all three lengths exactly.
/// assert!(found.direction.vector().x > 0.0);
/// assert!(found.residual_m < 1e-4);
/// # Ok::<(), leg_model::Error>(())
/// ```
///
/// # Errors
/// Lengths that are not positive are refused; [`Error::Singular`] if the tendons do not determine a direction;
/// [`Error::NotConverged`] if ten steps do not suffice or the leg would point above the horizon.
#[inline(always)]
pub fn forward_kinematics<T: Scalar, const N: usize>(
    geometry: &Geometry<T, N>,
    lengths: &SVector<T, N>,
    start: &Direction<T>,
) -> Result<ForwardKinematics<T>, Error> {
    require_positive(lengths)?;
    let targets = core::array::from_fn(|i| MeasuredTendon::new(&geometry.tendons[i], lengths[i]));
    search(start, &Straight::<T, N> { targets })
}

/// Direction of a leg on a universal joint, whose twist follows from its direction.
///
/// # Errors
/// As [`forward_kinematics`].
#[inline(always)]
pub fn forward_kinematics_universal<T: Scalar, const N: usize>(
    geometry: &Geometry<T, N>,
    lengths: &SVector<T, N>,
    start: &Direction<T>,
) -> Result<ForwardKinematics<T>, Error> {
    require_positive(lengths)?;
    search(start, &Twisting { geometry, lengths })
}

/// Each length on its own: a product could hide two negative ones.
#[inline(always)]
fn require_positive<T: Scalar, const N: usize>(lengths: &SVector<T, N>) -> Result<(), Error> {
    for &length in lengths.iter() {
        if !(length > T::zero()) {
            return Err(Error::refused(Quantity::TendonLength, Reason::NotPositive));
        }
    }
    Ok(())
}

/// A tendon that was measured.
struct MeasuredTendon<T> {
    polynomial: LengthPolynomial<T>,
    /// 1/L²: with it, an error of F counts as one of the length.
    weight: T,
}

impl<T: Scalar> MeasuredTendon<T> {
    #[inline(always)]
    fn new(pair: &AnchorPair<T>, length: T) -> Self {
        let square = length * length;
        Self {
            polynomial: pair.polynomial.with_length_square(square),
            weight: T::one() / square,
        }
    }
}

/// The equations of all tendons at a direction.
trait Equations<T> {
    fn assemble(&self, q: &HalfTangent<T>) -> NormalEquations<T>;
}

/// A leg without torsion.
struct Straight<T, const N: usize> {
    targets: [MeasuredTendon<T>; N],
}

impl<T: Scalar, const N: usize> Equations<T> for Straight<T, N> {
    #[inline(always)]
    fn assemble(&self, q: &HalfTangent<T>) -> NormalEquations<T> {
        let mut equations = NormalEquations::new();
        for target in &self.targets {
            let error = target.polynomial.evaluate(q);
            equations.add(error.gradient, error.twice, target.weight);
        }
        equations
    }
}

/// A leg whose torsion follows from its direction.
struct Twisting<'a, T, const N: usize> {
    geometry: &'a Geometry<T, N>,
    lengths: &'a SVector<T, N>,
}

impl<T: Scalar, const N: usize> Equations<T> for Twisting<'_, T, N> {
    #[inline(always)]
    fn assemble(&self, q: &HalfTangent<T>) -> NormalEquations<T> {
        let geometry = self.geometry.twisted(&Twist::universal(q));
        let torsion = universal_torsion_gradient(q);
        let mut equations = NormalEquations::new();
        for (pair, &length) in geometry.tendons.iter().zip(self.lengths) {
            let target = MeasuredTendon::new(pair, length);
            let error = target.polynomial.evaluate(q);
            let by_torsion = derivative_by_torsion(pair, geometry.upper, q);
            let gradient = [
                error.gradient[0] + by_torsion * torsion[0],
                error.gradient[1] + by_torsion * torsion[1],
            ];
            equations.add(gradient, error.twice, target.weight);
        }
        equations
    }
}

/// ∂F/∂τ at the twisted anchors of `pair`.
#[inline(always)]
fn derivative_by_torsion<T: Scalar>(pair: &AnchorPair<T>, upper: T, q: &HalfTangent<T>) -> T {
    let ([base_x, base_y], [leg_x, leg_y]) = (pair.base, pair.leg);
    let across_base = base_x * leg_y - base_y * leg_x;
    let across_tilt = q.x * leg_y - q.y * leg_x;
    let base_height = upper - q.x * base_x - q.y * base_y;
    let half = q.inverse_gain() * across_base + base_height * across_tilt;
    half + half
}

/// Gauss–Newton from `start`.
#[inline(always)]
fn search<T: Scalar>(
    start: &Direction<T>,
    equations: &impl Equations<T>,
) -> Result<ForwardKinematics<T>, Error> {
    let mut q = start.half_tangent();
    for step_count in 0..STEPS_MAX {
        let step = equations.assemble(&q).solve()?;
        q = HalfTangent {
            x: q.x - step.x,
            y: q.y - step.y,
        };
        if step.x * step.x + step.y * step.y <= T::DIRECTION_STEP * T::DIRECTION_STEP {
            return found(&q, step.remainder, step_count + 1);
        }
    }
    Err(Error::NotConverged)
}

#[inline(always)]
fn found<T: Scalar>(
    q: &HalfTangent<T>,
    remainder: T,
    steps: u8,
) -> Result<ForwardKinematics<T>, Error> {
    let half_gain = T::one() / (T::one() + q.x * q.x + q.y * q.y);
    let gain = half_gain + half_gain;
    // Also refuses NaN.
    if !(gain > T::one()) {
        return Err(Error::NotConverged);
    }
    let direction = Direction {
        x: gain * q.x,
        y: gain * q.y,
        z: T::one() - gain,
    };
    Ok(ForwardKinematics {
        direction,
        // l − L is γF/2L. Rounding can leave a remainder of nothing slightly below zero.
        residual_m: T::HALF * half_gain * remainder.abs().sqrt(),
        steps,
    })
}
