//! Forward kinematics: the direction of the leg from the lengths of its tendons.
//!
//! Three lengths on two freedoms are overdetermined, so the direction is found by Gauss–Newton least squares in
//! half-tangent coordinates, which are smooth through the vertical. The residual is a free check: a tendon that
//! jumped or a count that was lost shows there.

use crate::geometry::AnchorPair;
use crate::pose::universal_torsion_gradient;
use crate::solve::NormalEquations;
use crate::{Direction, Error, Geometry, HalfTangent, Quantity, Reason, Scalar, Twist};
use nalgebra::SVector;

/// Steps after which a search without convergence ends.
pub const STEPS_MAX: u8 = 10;

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
/// # Errors
/// Lengths that are not positive are refused; [`Error::Singular`] if the tendons do not determine a direction;
/// [`Error::NotConverged`] if [`STEPS_MAX`] steps do not suffice or the leg would point above the horizon.
#[inline(always)]
pub fn forward_kinematics<T: Scalar, const N: usize>(
    geometry: &Geometry<T, N>,
    lengths: &SVector<T, N>,
    start: &Direction<T>,
) -> Result<ForwardKinematics<T>, Error> {
    let targets = targets(lengths)?;
    search(start, |q| {
        let mut equations = NormalEquations::zero();
        for (pair, target) in geometry.tendons.iter().zip(&targets) {
            let row = LengthRow::new(pair, target, geometry, q);
            equations.add(row.gradient, row.error, target.weight);
        }
        equations
    })
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
    let targets = targets(lengths)?;
    search(start, |q| {
        let geometry = geometry.twisted(&Twist::universal(q));
        let torsion = universal_torsion_gradient(q);
        let mut equations = NormalEquations::zero();
        for (pair, target) in geometry.tendons.iter().zip(&targets) {
            let row = LengthRow::new(pair, target, &geometry, q);
            let twist = row.by_torsion(pair, q);
            let [x, y] = row.gradient;
            let gradient = [x + twist * torsion[0], y + twist * torsion[1]];
            equations.add(gradient, row.error, target.weight);
        }
        equations
    })
}

/// A measured length, prepared.
struct Target<T> {
    /// L², m².
    square: T,
    /// 1/L², which turns errors of l²/2 into errors of l.
    weight: T,
}

#[inline(always)]
fn targets<T: Scalar, const N: usize>(lengths: &SVector<T, N>) -> Result<[Target<T>; N], Error> {
    let mut product = T::one();
    let targets = core::array::from_fn(|i| {
        let square = lengths[i] * lengths[i];
        product *= lengths[i];
        Target {
            square,
            weight: T::one() / square,
        }
    });
    // One comparison refuses a zero and a NaN among all of them.
    if product > T::zero() && product <= T::MAX {
        Ok(targets)
    } else {
        Err(Error::refused(Quantity::TendonLength, Reason::NotPositive))
    }
}

/// How l²/2 of one tendon stands to its target at a direction, and how it changes.
struct LengthRow<T> {
    /// −∂(l²/2)/∂q, over γ.
    gradient: [T; 2],
    /// (l² − L²)/2, m².
    error: T,
    /// L_upper − q·b, m.
    base_height: T,
}

impl<T: Scalar> LengthRow<T> {
    /// l²/2 = square/2 + γ(L_joint − q·s)(L_upper − q·b); see [`crate::kinematics`].
    #[inline(always)]
    fn new<const N: usize>(
        pair: &AnchorPair<T>,
        target: &Target<T>,
        geometry: &Geometry<T, N>,
        q: &HalfTangent<T>,
    ) -> Self {
        let ([base_x, base_y], [leg_x, leg_y]) = (pair.base, pair.leg);
        let leg_height = geometry.joint - q.x * leg_x - q.y * leg_y;
        let base_height = geometry.upper - q.x * base_x - q.y * base_y;
        let rise = q.gain * leg_height * base_height;
        Self {
            gradient: [
                leg_x * base_height + base_x * leg_height + rise * q.x,
                leg_y * base_height + base_y * leg_height + rise * q.y,
            ],
            error: T::HALF * (pair.square - target.square) + rise,
            base_height,
        }
    }

    /// −∂(l²/2)/∂τ, over γ, at the twisted anchors of `pair`.
    #[inline(always)]
    fn by_torsion(&self, pair: &AnchorPair<T>, q: &HalfTangent<T>) -> T {
        let ([base_x, base_y], [leg_x, leg_y]) = (pair.base, pair.leg);
        let across_base = base_y * leg_x - base_x * leg_y;
        let across_tilt = q.y * leg_x - q.x * leg_y;
        q.inverse_gain * across_base + self.base_height * across_tilt
    }
}

/// Gauss–Newton from `start`; `equations` are those of the lengths at a direction.
#[inline(always)]
fn search<T: Scalar>(
    start: &Direction<T>,
    equations: impl Fn(&HalfTangent<T>) -> NormalEquations<T>,
) -> Result<ForwardKinematics<T>, Error> {
    let mut q = start.half_tangent();
    for steps in 1..=STEPS_MAX {
        let solution = equations(&q).solve()?;
        let (dx, dy) = (solution.x * q.inverse_gain, solution.y * q.inverse_gain);
        q = HalfTangent::new(q.x + dx, q.y + dy);
        if dx * dx + dy * dy <= T::DIRECTION_STEP * T::DIRECTION_STEP {
            return found(&q, solution.remainder, steps);
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
    if q.gain <= T::one() {
        return Err(Error::NotConverged);
    }
    // Rounding can leave a remainder of nothing slightly below zero.
    let remainder = if remainder > T::zero() {
        remainder
    } else {
        T::zero()
    };
    Ok(ForwardKinematics {
        direction: q.direction(),
        residual_m: remainder.sqrt(),
        steps,
    })
}
