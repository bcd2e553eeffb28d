//! The points of a tendon's curve.

use super::check_stiffness;
use crate::range::{LENGTH_MAX, TENSION_MAX, check_magnitude};
use crate::{Error, Quantity, Reason, Scalar};

/// Between two points the curve rises if it is nowhere this many times as steep at one of them as on average (after
/// Fritsch and Carlson, 1980).
const STEEPNESS_MAX: f32 = 3.0;

/// One point of a curve.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "schema", derive(postcard_schema::Schema))]
pub struct CurvePoint<T> {
    /// Tension, N.
    pub tension_n: T,
    /// Elongation under it, m.
    pub elongation_m: T,
    /// Tangent stiffness there, N/m.
    pub stiffness_n_per_m: T,
}

impl<T> CurvePoint<T> {
    /// The same numbers in another type, each by `convert`.
    #[must_use]
    pub fn map<U>(self, mut convert: impl FnMut(T) -> U) -> CurvePoint<U> {
        CurvePoint {
            tension_n: convert(self.tension_n),
            elongation_m: convert(self.elongation_m),
            stiffness_n_per_m: convert(self.stiffness_n_per_m),
        }
    }
}

impl<T: Scalar> CurvePoint<T> {
    /// The same point of a tendon of another length and section: twice as long is twice as soft, twice the section
    /// half as soft.
    #[must_use]
    pub fn scaled(&self, length_ratio: T, section_ratio: T) -> Self {
        let softening = length_ratio / section_ratio;
        Self {
            tension_n: self.tension_n,
            elongation_m: self.elongation_m * softening,
            stiffness_n_per_m: self.stiffness_n_per_m / softening,
        }
    }

    /// Whether this point may come first: it has to be the slack tendon, without tension and elongation.
    ///
    /// # Errors
    /// [`Quantity::TendonCurve`], [`Reason::NotFromZero`]; a stiffness that no tendon has.
    pub fn check_first(&self) -> Result<(), Error> {
        if self.tension_n != T::zero() || self.elongation_m != T::zero() {
            return Err(Error::refused(Quantity::TendonCurve, Reason::NotFromZero));
        }
        check_stiffness(self.stiffness_n_per_m)
    }

    /// Whether this point may follow `before`.
    ///
    /// # Errors
    /// [`Quantity::TendonCurve`] out of range, [`Reason::NotRising`] or [`Reason::NotMonotone`] (the stiffnesses at the
    /// two points are so far below the average between them that the curve would turn back); a stiffness that no
    /// tendon has.
    pub fn check_after(&self, before: &Self) -> Result<(), Error> {
        check_magnitude(self.tension_n, TENSION_MAX, Quantity::TendonCurve)?;
        check_magnitude(self.elongation_m, LENGTH_MAX, Quantity::TendonCurve)?;
        check_stiffness(self.stiffness_n_per_m)?;
        let rise = self.tension_n - before.tension_n;
        let stretch = self.elongation_m - before.elongation_m;
        if !(rise > T::zero() && stretch > T::zero()) {
            return Err(Error::refused(Quantity::TendonCurve, Reason::NotRising));
        }
        let average = rise / stretch;
        let softest = average / T::from(STEEPNESS_MAX);
        if before.stiffness_n_per_m > softest && self.stiffness_n_per_m > softest {
            Ok(())
        } else {
            Err(Error::refused(Quantity::TendonCurve, Reason::NotMonotone))
        }
    }
}
