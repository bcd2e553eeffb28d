//! A tendon as a tensile test found it: a monotone curve δ(T).
//!
//! Stiffness is not monotone in tension, elongation is. So elongation is kept, as a cubic between each two points, and
//! the stiffness is the reciprocal of its slope.

use super::{Elasticity, check_stiffness};
use crate::range::{LENGTH_MAX, TENSION_MAX, check_magnitude};
use crate::{Error, Quantity, Reason, Scalar};

/// The most points that a curve may have: a power of two, for the search.
pub const CURVE_POINTS_MAX: usize = 16;

/// Between two points the curve rises if it is nowhere this many times as steep at one of them as on average (after
/// Fritsch and Carlson, 1980).
const STEEPNESS_MAX: f32 = 3.0;

/// Steps after which the search for a tension ends: more than halving alone needs.
const NEWTON_STEPS_MAX: u8 = 80;

/// One point of a curve.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize, postcard_schema::Schema)
)]
pub struct CurvePoint<T> {
    /// Tension, N.
    pub tension_n: T,
    /// Elongation under it, m.
    pub elongation_m: T,
    /// Tangent stiffness there, N/m.
    pub stiffness_n_per_m: T,
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

/// A curve whose points have been validated.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TendonCurve<T> {
    /// One piece from each point to the next. Those that are not used start above every tension.
    pieces: [Piece<T>; CURVE_POINTS_MAX],
    /// The highest tension that is known, N.
    tension_max: T,
    /// The elongation there, m.
    elongation_max: T,
}

/// The curve between two points, with s = T − start: δ = c₀ + c₁s + c₂s² + c₃s³.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Piece<T> {
    /// N.
    start: T,
    /// N.
    end: T,
    /// c₀ to c₃.
    elongation: [T; 4],
    /// ∫δ dT from zero to the start, J.
    complement: T,
}

impl<T: Scalar> TendonCurve<T> {
    /// A curve through `points`, from the slack tendon up.
    ///
    /// # Errors
    /// [`Quantity::TendonCurve`] with the reason if there are fewer than two or more than [`CURVE_POINTS_MAX`] points;
    /// what [`CurvePoint::check_first`] and [`CurvePoint::check_after`] refuse.
    pub fn new(points: &[CurvePoint<T>]) -> Result<Self, Error> {
        let refused = |reason| Error::refused(Quantity::TendonCurve, reason);
        let (Some(first), Some(last)) = (points.first(), points.last()) else {
            return Err(refused(Reason::TooFew));
        };
        if points.len() < 2 {
            return Err(refused(Reason::TooFew));
        }
        if points.len() > CURVE_POINTS_MAX {
            return Err(refused(Reason::TooMany));
        }
        first.check_first()?;
        let mut pieces = [Piece::beyond(); CURVE_POINTS_MAX];
        let mut complement = T::zero();
        for (piece, pair) in pieces.iter_mut().zip(points.windows(2)) {
            if let [before, after] = pair {
                after.check_after(before)?;
                *piece = Piece::new(before, after, complement);
                complement = piece.complement_at(after.tension_n);
            }
        }
        Ok(Self {
            pieces,
            tension_max: last.tension_n,
            elongation_max: last.elongation_m,
        })
    }

    /// The highest tension that is known, N.
    #[must_use]
    pub fn tension_max_n(&self) -> T {
        self.tension_max
    }

    /// The points that it goes through.
    pub fn points(&self) -> impl Iterator<Item = CurvePoint<T>> {
        let pieces = self
            .pieces
            .iter()
            .filter(|piece| piece.start < self.tension_max);
        let starts = pieces.map(|piece| piece.point_at(piece.start));
        let last = self.piece(self.tension_max).point_at(self.tension_max);
        starts.chain(core::iter::once(CurvePoint {
            elongation_m: self.elongation_max,
            ..last
        }))
    }

    /// The piece at a tension: the last one that does not start above it.
    #[inline(always)]
    fn piece(&self, tension: T) -> &Piece<T> {
        self.search(|piece| piece.start <= tension)
    }

    /// The last piece that is `reached`, by halving. Masks show the compiler that no index is out of range.
    #[inline(always)]
    fn search(&self, reached: impl Fn(&Piece<T>) -> bool) -> &Piece<T> {
        let mut found = 0;
        for step in [8, 4, 2, 1] {
            let next = (found + step) & (CURVE_POINTS_MAX - 1);
            if reached(&self.pieces[next]) {
                found = next;
            }
        }
        &self.pieces[found]
    }

    /// The piece at a tension and the tension itself, or zero below it.
    #[inline(always)]
    fn known(&self, tension: T) -> Result<(&Piece<T>, T), Error> {
        if !(tension <= self.tension_max) {
            return Err(Error::refused(Quantity::Tension, Reason::BeyondCurve));
        }
        let taut = if tension > T::zero() {
            tension
        } else {
            T::zero()
        };
        Ok((self.piece(taut), taut))
    }
}

impl<T: Scalar> Elasticity<T> for TendonCurve<T> {
    #[inline(always)]
    fn elongation(&self, tension: T) -> Result<T, Error> {
        let (piece, taut) = self.known(tension)?;
        let [_, first, ..] = piece.elongation;
        Ok(piece.elongation_at(taut) + (tension - taut) * first)
    }

    #[inline(always)]
    fn stiffness(&self, tension: T) -> Result<T, Error> {
        let (piece, taut) = self.known(tension)?;
        Ok(T::one() / piece.slope_at(taut))
    }

    fn tension(&self, elongation: T) -> Result<T, Error> {
        if elongation <= T::zero() {
            return Ok(T::zero());
        }
        if !(elongation <= self.elongation_max) {
            return Err(Error::refused(Quantity::Elongation, Reason::BeyondCurve));
        }
        let piece = self.search(|piece| piece.elongation[0] <= elongation);
        Ok(piece.tension_at(elongation))
    }

    fn energy(&self, elongation: T) -> Result<T, Error> {
        let tension = self.tension(elongation)?;
        let complement = self.piece(tension).complement_at(tension);
        let energy = tension * elongation - complement;
        Ok(if elongation > T::zero() {
            energy
        } else {
            T::zero()
        })
    }
}

impl<T: Scalar> Piece<T> {
    /// A piece that no tension and no elongation reaches.
    fn beyond() -> Self {
        Self {
            start: T::MAX,
            end: T::MAX,
            elongation: [T::MAX, T::zero(), T::zero(), T::zero()],
            complement: T::zero(),
        }
    }

    /// Hermite's cubic from one point to the next.
    fn new(before: &CurvePoint<T>, after: &CurvePoint<T>, complement: T) -> Self {
        let rise = after.tension_n - before.tension_n;
        let average = (after.elongation_m - before.elongation_m) / rise;
        let first = T::one() / before.stiffness_n_per_m;
        let last = T::one() / after.stiffness_n_per_m;
        let bend = first + last - T::TWO * average;
        let square = (average - first - bend) / rise;
        Self {
            start: before.tension_n,
            end: after.tension_n,
            elongation: [before.elongation_m, first, square, bend / (rise * rise)],
            complement,
        }
    }

    fn point_at(&self, tension: T) -> CurvePoint<T> {
        CurvePoint {
            tension_n: tension,
            elongation_m: self.elongation_at(tension),
            stiffness_n_per_m: T::one() / self.slope_at(tension),
        }
    }

    #[inline(always)]
    fn elongation_at(&self, tension: T) -> T {
        let s = tension - self.start;
        let [c0, c1, c2, c3] = self.elongation;
        c0 + s * (c1 + s * (c2 + s * c3))
    }

    #[inline(always)]
    fn slope_at(&self, tension: T) -> T {
        let s = tension - self.start;
        let [_, c1, c2, c3] = self.elongation;
        c1 + s * (c2 + c2 + T::from(3.0) * c3 * s)
    }

    /// ∫δ dT from zero to a tension, J.
    fn complement_at(&self, tension: T) -> T {
        let s = tension - self.start;
        let [c0, c1, c2, c3] = self.elongation;
        let [c1, c2, c3] = [c1 / T::from(2.0), c2 / T::from(3.0), c3 / T::from(4.0)];
        self.complement + s * (c0 + s * (c1 + s * (c2 + s * c3)))
    }

    /// The tension at an elongation of this piece, by Newton's steps between bounds that close in.
    fn tension_at(&self, elongation: T) -> T {
        let (mut low, mut high) = (self.start, self.end);
        let mut tension = self.start + (elongation - self.elongation[0]) / self.elongation[1];
        for _ in 0..NEWTON_STEPS_MAX {
            if !(tension > low && tension < high) {
                tension = T::HALF * (low + high);
            }
            let error = self.elongation_at(tension) - elongation;
            if error > T::zero() {
                high = tension;
            } else {
                low = tension;
            }
            let next = tension - error / self.slope_at(tension);
            if next == tension {
                break;
            }
            tension = next;
        }
        tension
    }
}
