//! What a streamed set-point may ask for: a path to it within the limits, and one from it to rest.

use super::bounds::max;
use super::plan::{LONGEST_S, MotionLimits, REACHED, SHORTEST_S, cycles, half_tangent};
use super::quintic::{MotionState, Peaks, Quintic};
use super::segment::Segment;
use super::{CYCLE_TICKS, TICK_S};
use crate::set_point::{MotionLimit, PointRefusal, SetPoint};
use crate::settings::Settings;
use leg_model::{Direction, Scalar};

/// What the rounding of two set-points in f32 may change in their distance, as half-tangents: four units in the last place of
/// 0.5. The limits are kept up to what that makes of acceleration and jerk: 0.024 1/s² and 14 1/s³ over 10 ms, 0.1 1/s² and
/// 115 1/s³ over the shortest 5 ms.
const ROUNDING: f32 = 1.2e-7;

/// A path between two points of a circle at the edge bulges out of it, and so does the path on which the leg then stops: by no more
/// than this part of the reach, or the point is refused.
const BULGE: f32 = 1.005;

/// The limits of a stream.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StreamLimits<T> {
    peaks: Peaks<T>,
    /// (sin θ)² at the greatest tilt.
    reach_sine_square: T,
    /// The square of its half-tangent, with the bulge.
    reach_square: T,
}

impl<T: Scalar> StreamLimits<T> {
    /// The settings' limits.
    pub fn new(settings: &Settings) -> Self {
        let sine = T::from(settings.tilt_max_sine) * T::from(REACHED);
        let reach = half_tangent(sine) * T::from(BULGE);
        Self {
            peaks: MotionLimits::new(settings).peaks,
            reach_sine_square: sine * sine,
            reach_square: reach * reach,
        }
    }

    /// The motion at a set-point, in half-tangent coordinates q = p/(1 + z), with z = √(1 − p²) of the direction's horizontal
    /// components p. Without an acceleration, that is zero.
    ///
    /// # Errors
    /// A number that is not finite, a direction out of reach.
    pub fn motion(&self, point: &SetPoint) -> Result<MotionState<T>, PointRefusal> {
        let acceleration = point.acceleration.unwrap_or([0.0; 2]);
        let numbers = [point.direction, point.rate, acceleration];
        if !numbers.iter().flatten().all(|number| number.is_finite()) {
            return Err(PointRefusal::Number);
        }
        let [p, v, a] = numbers.map(|pair| pair.map(T::from));
        if square(p) > self.reach_sine_square {
            return Err(PointRefusal::OutOfReach);
        }
        let [x, y] = p;
        let direction = Direction::from_xy(x, y).map_err(|_| PointRefusal::OutOfReach)?;
        // z² + p² = 1, twice differentiated.
        let z = -direction.vector().z;
        let per_z = T::one() / z;
        let z_rate = -dot(p, v) * per_z;
        let z_acceleration = -(square(v) + dot(p, a) + z_rate * z_rate) * per_z;
        // w = 1/(1 + z) and q = w p, twice differentiated.
        let w = T::one() / (T::one() + z);
        let w_rate = -w * w * z_rate;
        let w_acceleration = -w * (T::TWO * w_rate * z_rate + w * z_acceleration);
        let coordinate = |i: usize| {
            [
                w * p[i],
                w * v[i] + w_rate * p[i],
                w * a[i] + T::TWO * w_rate * v[i] + w_acceleration * p[i],
            ]
        };
        let [[qx, vx, ax], [qy, vy, ay]] = [coordinate(0), coordinate(1)];
        Ok(MotionState {
            position: [qx, qy],
            rate: [vx, vy],
            acceleration: [ax, ay],
        })
    }

    /// Whether a path keeps every limit all the way: the control points of its derivatives do, and each derivative stays within
    /// the convex hull of its own.
    ///
    /// # Errors
    /// The limit that it leaves.
    #[inline(never)]
    pub fn keeps(&self, path: &Quintic<T>) -> Result<(), PointRefusal> {
        let [xs, ys] = path.control_points();
        check_in_circle(&xs, &ys, self.reach_square).ok_or(PointRefusal::OutOfReach)?;
        let ([rates_x, bends_x, jerks_x], [rates_y, bends_y, jerks_y]) =
            (differences(&xs), differences(&ys));
        let peaks = &self.peaks;
        let duration_s = path.duration_s();
        let rounding = T::from(ROUNDING);
        let rate = peaks.rate * duration_s * T::from(1.0 / 5.0) + rounding;
        let bend = peaks.acceleration * duration_s * duration_s * T::from(1.0 / 20.0) + rounding;
        let jerk = peaks.jerk * duration_s * duration_s * duration_s * T::from(1.0 / 60.0)
            + T::TWO * rounding;
        let limit = |limit| PointRefusal::Limit(limit);
        check_in_circle(&rates_x, &rates_y, rate * rate).ok_or(limit(MotionLimit::Speed))?;
        check_in_circle(&bends_x, &bends_y, bend * bend).ok_or(limit(MotionLimit::Acceleration))?;
        check_in_circle(&jerks_x, &jerks_y, jerk * jerk).ok_or(limit(MotionLimit::Jerk))
    }

    /// Whether the leg can come to rest from a motion within the limits.
    ///
    /// # Errors
    /// The limit that is left.
    pub fn keeps_to_rest(&self, motion: &MotionState<T>) -> Result<(), PointRefusal> {
        let time_s = self.time_to_rest_s(motion);
        let step = |share: f32| time_s * T::from(share);
        // The control points of the rate are v, v + aT/4 and three times zero.
        let fastest = moved(motion.rate, motion.acceleration, step(0.25));
        if square(fastest) > self.peaks.rate * self.peaks.rate {
            return Err(PointRefusal::Limit(MotionLimit::Speed));
        }
        let first = moved(motion.position, motion.rate, step(0.2));
        let rest = moved(first, fastest, step(0.2));
        let inside = time_s < T::from(LONGEST_S)
            && square(first) <= self.reach_square
            && square(rest) <= self.reach_square;
        inside.then_some(()).ok_or(PointRefusal::OutOfReach)
    }

    /// The path from a motion to rest within the limits: see [`MotionState::rest_after`].
    pub fn rest_segment(&self, motion: &MotionState<T>) -> Segment<T> {
        let ticks = cycles(self.time_to_rest_s(motion)) * i32::from(CYCLE_TICKS);
        let time_s = T::from(ticks as f32 * TICK_S);
        let rest = motion.rest_after(time_s);
        Segment {
            path: Quintic::new(motion, rest.position, time_s),
            ticks,
        }
    }

    /// The time T to rest: enough for acceleration and jerk whatever the directions of rate v and acceleration a.
    ///
    /// The acceleration is (1 − s)²(a(1 − 4s) − 12s·v/T): with v/T up to 0.45 of the limit and a up to the limit, it keeps the
    /// limit. The jerk is greatest at the start: 12v/T² + 6a/T.
    fn time_to_rest_s(&self, motion: &MotionState<T>) -> T {
        let [v, a] = [motion.rate, motion.acceleration].map(|pair| square(pair).sqrt());
        let six_a = T::from(6.0) * a;
        let jerk = self.peaks.jerk;
        let by_jerk = (six_a + (six_a * six_a + T::from(48.0) * jerk * v).sqrt()) / (T::TWO * jerk);
        let by_acceleration = v / (T::from(0.45) * self.peaks.acceleration);
        max(max(by_jerk, by_acceleration), T::from(SHORTEST_S))
    }
}

/// The differences of control points: those of the first, second and third derivative but for their factors. What there is
/// none of is zero.
#[inline(always)]
fn differences<T: Scalar>(points: &[T; 6]) -> [[T; 5]; 3] {
    let zero = T::zero();
    let [a, b, c, d, e, f] = *points;
    let first = [b - a, c - b, d - c, e - d, f - e];
    let [a, b, c, d, e] = first;
    let [a, b, c, d] = [b - a, c - b, d - c, e - d];
    let third = [b - a, c - b, d - c, zero, zero];
    [first, [a, b, c, d, zero], third]
}

/// Whether every point is within a circle about zero.
#[inline(always)]
fn check_in_circle<T: Scalar, const N: usize>(
    xs: &[T; N],
    ys: &[T; N],
    radius_square: T,
) -> Option<()> {
    let mut points = xs.iter().zip(ys);
    points
        .all(|(&x, &y)| square([x, y]) <= radius_square)
        .then_some(())
}

/// A point moved on by a step along a direction.
#[inline(always)]
fn moved<T: Scalar>([x, y]: [T; 2], [dx, dy]: [T; 2], step: T) -> [T; 2] {
    [x + dx * step, y + dy * step]
}

#[inline(always)]
fn dot<T: Scalar>([ax, ay]: [T; 2], [bx, by]: [T; 2]) -> T {
    ax * bx + ay * by
}

#[inline(always)]
fn square<T: Scalar>(pair: [T; 2]) -> T {
    dot(pair, pair)
}

#[cfg(test)]
mod tests;
