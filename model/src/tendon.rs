//! The elasticity of a tendon.

mod constant;
mod curve;
mod piece;
mod point;
mod published;

pub use constant::ConstantStiffness;
pub use curve::{CURVE_POINTS_MAX, TendonCurve};
pub use point::CurvePoint;

use crate::range::{STIFFNESS, check_positive};
use crate::{Error, Quantity, Reason, Scalar};

/// The elastic law of a tendon. It cannot push.
///
/// Asked by tension, the law goes on in a straight line below zero, which no tendon has: so a sum over tendons stays
/// smooth where one of them is asked too much, and what is allowed is checked by
/// [`TensionBounds`](crate::TensionBounds). Asked by elongation, as in nature, a tendon that is not stretched is slack.
pub trait Elasticity<T: Scalar> {
    /// δ(T): how much longer it is under a tension in N than without, m.
    ///
    /// # Errors
    /// A tension beyond what is known of the tendon: nothing is guessed. One that is not a number is beyond every curve;
    /// a constant stiffness, which knows every tension, hands it on.
    fn elongation(&self, tension: T) -> Result<T, Error>;

    /// Tangent stiffness k = dT/dδ under a tension in N, N/m.
    ///
    /// # Errors
    /// As [`Self::elongation`]; a constant stiffness ignores the tension.
    fn stiffness(&self, tension: T) -> Result<T, Error>;

    /// Tension at an elongation in m, N; none when slack.
    ///
    /// # Errors
    /// An elongation that is not a number or beyond what is known of the tendon.
    fn tension(&self, elongation: T) -> Result<T, Error>;

    /// Elastic energy at an elongation in m: ∫T dδ, J.
    ///
    /// # Errors
    /// As [`Self::tension`].
    fn energy(&self, elongation: T) -> Result<T, Error>;
}

/// A tendon: of constant stiffness, or as a tensile test found it.
#[derive(Clone, Copy, Debug, PartialEq)]
#[allow(
    clippy::large_enum_variant,
    reason = "a curve is kept in place: there is no allocation on the board"
)]
pub enum Tendon<T> {
    /// The same stiffness at every tension.
    Constant(ConstantStiffness<T>),
    /// A monotone curve δ(T).
    Curve(TendonCurve<T>),
}

impl<T: Scalar> Tendon<T> {
    /// A tendon of a constant stiffness in N/m.
    ///
    /// # Errors
    /// As [`ConstantStiffness::new`].
    pub fn constant(stiffness_n_per_m: T) -> Result<Self, Error> {
        ConstantStiffness::new(stiffness_n_per_m).map(Self::Constant)
    }

    /// A tendon with a curve through `points`.
    ///
    /// ```
    /// use leg_model::{CurvePoint, Elasticity, Tendon};
    ///
    /// let paper = Tendon::curve(&CurvePoint::<f64>::PAPER)?;
    /// assert!((paper.stiffness(70.0)? - 9.945e4).abs() < 1e-6);
    /// // Nothing is guessed beyond its last point.
    /// assert!(paper.elongation(1e3).is_err());
    /// # Ok::<(), leg_model::Error>(())
    /// ```
    ///
    /// # Errors
    /// As [`TendonCurve::new`].
    pub fn curve(points: &[CurvePoint<T>]) -> Result<Self, Error> {
        TendonCurve::new(points).map(Self::Curve)
    }

    /// Has it stretch `elongation_factor` times as much under each tension: a measured one of about 1.
    ///
    /// ```
    /// use leg_model::{Elasticity, Tendon};
    ///
    /// let mut tendon = Tendon::constant(1e5)?;
    /// tendon.scale(1.25);
    /// assert_eq!(tendon.stiffness(70.0)?, 8e4);
    /// # Ok::<(), leg_model::Error>(())
    /// ```
    pub fn scale(&mut self, elongation_factor: T) {
        match self {
            Self::Constant(constant) => constant.scale(elongation_factor),
            Self::Curve(curve) => curve.scale(elongation_factor),
        }
    }
}

impl<T: Scalar> Elasticity<T> for Tendon<T> {
    fn elongation(&self, tension: T) -> Result<T, Error> {
        match self {
            Self::Constant(constant) => constant.elongation(tension),
            Self::Curve(curve) => curve.elongation(tension),
        }
    }

    fn stiffness(&self, tension: T) -> Result<T, Error> {
        match self {
            Self::Constant(constant) => constant.stiffness(tension),
            Self::Curve(curve) => curve.stiffness(tension),
        }
    }

    fn tension(&self, elongation: T) -> Result<T, Error> {
        match self {
            Self::Constant(constant) => constant.tension(elongation),
            Self::Curve(curve) => curve.tension(elongation),
        }
    }

    fn energy(&self, elongation: T) -> Result<T, Error> {
        match self {
            Self::Constant(constant) => constant.energy(elongation),
            Self::Curve(curve) => curve.energy(elongation),
        }
    }
}

/// Refuses what is no stiffness of a tendon.
pub(crate) fn check_stiffness<T: Scalar>(stiffness: T) -> Result<(), Error> {
    let [softest, stiffest] = STIFFNESS;
    check_positive(stiffness, stiffest, Quantity::TendonStiffness)?;
    if stiffness < T::from(softest) {
        return Err(Error::refused(
            Quantity::TendonStiffness,
            Reason::OutOfRange,
        ));
    }
    Ok(())
}
