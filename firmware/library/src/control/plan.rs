//! The time that a path needs so that rate, acceleration and jerk keep their limits.

use super::CYCLE_S;
use super::bounds::max;
use super::quintic::{Peaks, Quintic};
use crate::settings::Settings;
use leg_model::Scalar;

/// Intervals between the places at which a trajectory is checked; see [`MARGIN`].
pub const PLACES: u8 = 16;

/// Part of each limit that a trajectory may use, as it is checked at [`PLACES`] only. The test
/// `trajectories_keep_their_limits` holds both.
const MARGIN: f32 = 0.98;

/// How much more time the next attempt is given. Jerk falls with the third power of time, so by a third an attempt; a
/// trajectory takes at most 15 % more time than its limits ask.
const LONGER: f32 = 1.15;

/// Shortest trajectory, s: forty cycles, so that rounding up to whole cycles changes it little.
pub const SHORTEST_S: f32 = 0.02;

/// Longest trajectory, s: one that would need more is given up, and the leg stays on the old one. Its ticks, 4.8 million, are
/// exact in f32.
pub const LONGEST_S: f32 = 600.0;

/// A direction may be beyond the greatest tilt by this part of its sine: what is rounded in f32 refuses none that is at it, whichever precision
/// asks.
pub const REACHED: f32 = 1.000_001;

/// A path may leave the greatest tilt by this part of its half-tangent, 0.003° of 30°: rounding in f32 shall not refuse one to it.
const ROUNDED: f32 = 1.0001;

/// The limits as squares, in half-tangent coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MotionLimits<T> {
    /// The limits themselves.
    pub(super) peaks: Peaks<T>,
    squares: Peaks<T>,
    /// The square of the greatest tilt's half-tangent, with what rounding may add.
    reach_square: T,
}

impl<T: Scalar> MotionLimits<T> {
    /// The settings' limits. A half-tangent changes by at least half of the angle, so half of each limit holds everywhere.
    pub fn new(settings: &Settings) -> Self {
        let motion = &settings.motion;
        let half = |limit: f32| T::from(0.5 * MARGIN * limit);
        let square = |value: T| value * value;
        let peaks = Peaks {
            rate: half(motion.speed_rad_per_s),
            acceleration: half(motion.acceleration_rad_per_s2),
            jerk: half(motion.jerk_rad_per_s3),
        };
        Self {
            peaks,
            squares: Peaks {
                rate: square(peaks.rate),
                acceleration: square(peaks.acceleration),
                jerk: square(peaks.jerk),
            },
            reach_square: square(half_tangent(T::from(settings.tilt_max_sine)) * T::from(ROUNDED)),
        }
    }

    /// Whether a path may lead beyond the greatest tilt, or farther than it starts where that is beyond. It stays in the hull of its start, its
    /// end and two points that its start and its time determine.
    #[inline(always)]
    pub fn leads_too_far(&self, path: &Quintic<T>) -> bool {
        let square = |[x, y]: [T; 2]| x * x + y * y;
        let [start, farther @ ..] = path.hull_to_rest();
        let reach_square = max(square(start), self.reach_square);
        farther.iter().any(|&point| square(point) > reach_square)
    }

    /// Whether a path keeps the others at one of its places, 0 to `PLACES`.
    #[inline(always)]
    pub fn kept(&self, path: &Quintic<T>, place: u8) -> bool {
        let part = T::from(f32::from(place) * (1.0 / PLACES as f32));
        let squares = path.squares(part);
        squares.rate <= self.squares.rate
            && squares.acceleration <= self.squares.acceleration
            && squares.jerk <= self.squares.jerk
    }

    /// A time that is too short for a path, or just enough, s.
    #[inline(always)]
    pub fn shortest_s(&self, start: [T; 2], end: [T; 2]) -> T {
        let (x, y) = (end[0] - start[0], end[1] - start[1]);
        // The fastest place of a path from rest to rest is at 15/8 of the average. A little more, so that rounding does
        // not decide.
        let s = (x * x + y * y).sqrt() * T::from(1.89) / self.peaks.rate;
        max(s, T::from(SHORTEST_S))
    }
}

/// The half-tangent of a tilt, of its sine.
pub fn half_tangent<T: Scalar>(sine: T) -> T {
    sine / (T::one() + (T::one() - sine * sine).sqrt())
}

/// The next time to try, s.
#[inline(always)]
pub fn longer<T: Scalar>(duration_s: T) -> T {
    duration_s * T::from(LONGER)
}

/// Whole cycles in a time, rounded up: from one to those of [`LONGEST_S`].
#[inline(always)]
pub fn cycles<T: Scalar>(duration_s: T) -> i32 {
    const MOST: i32 = (LONGEST_S / CYCLE_S) as i32 + 1;
    // Whole cycles, and one less: the search for the first that is long enough starts before it, however these are rounded.
    let mut cycles = (duration_s * T::from(1.0 / CYCLE_S)).whole().clamp(2, MOST) - 1;
    while cycles < MOST && T::from(cycles as f32 * CYCLE_S) < duration_s {
        cycles += 1;
    }
    cycles
}
