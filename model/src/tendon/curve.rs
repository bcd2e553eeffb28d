//! A tendon as a tensile test found it: a monotone curve δ(T).
//!
//! Stiffness is not monotone in tension, elongation is. So elongation is kept, as a cubic between each two points, and
//! the stiffness is the reciprocal of its slope.

use super::piece::Piece;
use super::{CurvePoint, Elasticity};
use crate::{Error, Quantity, Reason, Scalar};

/// The most points that a curve may have: a power of two, for the search.
pub const CURVE_POINTS_MAX: usize = 16;

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
        let mut pieces = [Piece::unused(); CURVE_POINTS_MAX];
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

    /// See [`Tendon::scale`](super::Tendon::scale).
    pub(super) fn scale(&mut self, elongation_factor: T) {
        for piece in &mut self.pieces {
            piece.scale(elongation_factor);
        }
        self.elongation_max *= elongation_factor;
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
