//! The time that a way needs so that rate, acceleration and jerk keep their limits.

use super::quintic::{Motion, Peaks, Quintic};
use crate::settings;
use leg_model::Scalar;

/// Places at which a way is looked at; between two of them a polynomial of fifth degree changes by less than the margin.
pub const PLACES: u8 = 16;

/// Limits are held to this part.
const MARGIN: f32 = 0.98;

/// How much more time the next try is given.
const LONGER: f32 = 1.15;

/// The limits as squares, in half-tangent coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits<T> {
    squares: Peaks<T>,
    rate: T,
}

impl<T: Scalar> Limits<T> {
    /// The settings' limits. A half-tangent changes by at least half of the angle, so half of each limit holds everywhere.
    pub fn new(motion: &settings::Motion) -> Self {
        let half = |limit: f32| T::from(0.5 * MARGIN * limit);
        let square = |value: T| value * value;
        let rate = half(motion.speed_rad_per_s);
        Self {
            squares: Peaks {
                rate: square(rate),
                acceleration: square(half(motion.acceleration_rad_per_s2)),
                jerk: square(half(motion.jerk_rad_per_s3)),
            },
            rate,
        }
    }

    /// Whether a way keeps them at one of its places, 0 to [`PLACES`].
    #[inline(always)]
    pub fn kept(&self, way: &Quintic<T>, place: u8) -> bool {
        let part = T::from(f32::from(place) * (1.0 / PLACES as f32));
        let squares = way.squares(part);
        squares.rate <= self.squares.rate
            && squares.acceleration <= self.squares.acceleration
            && squares.jerk <= self.squares.jerk
    }

    /// A time that is too short for a way, or just enough, s.
    #[inline(always)]
    pub fn shortest_s(&self, start: &Motion<T>, end: [T; 2]) -> T {
        let (x, y) = (end[0] - start.position[0], end[1] - start.position[1]);
        // The fastest place of a way from rest to rest is at 15/8 of the average. A little more, so that rounding does
        // not decide.
        let s = (x * x + y * y).sqrt() * T::from(1.89) / self.rate;
        if s > T::from(0.02) { s } else { T::from(0.02) }
    }
}

/// The next time to try, s.
#[inline(always)]
pub fn longer<T: Scalar>(duration_s: T) -> T {
    duration_s * T::from(LONGER)
}
