//! The pieces of a streamed path.

use super::TICK_S;
use super::quintic::{MotionState, Quintic};
use leg_model::Scalar;

/// How the leg shall move at a tick.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Knot<T> {
    /// The tick.
    pub tick: u32,
    /// The motion, in half-tangent coordinates.
    pub motion: MotionState<T>,
}

/// A path, and its time in ticks.
#[derive(Clone, Copy, Debug)]
pub struct Segment<T> {
    /// The path.
    pub path: Quintic<T>,
    /// Ticks.
    pub ticks: i32,
}

impl<T: Scalar> Segment<T> {
    /// From one knot to another that is at most 2³¹ ticks later.
    pub fn connect(from: &Knot<T>, to: &Knot<T>) -> Self {
        let ticks = to.tick.wrapping_sub(from.tick) as i32;
        let time_s = T::from(ticks as f32 * TICK_S);
        Self {
            path: Quintic::connect(&from.motion, &to.motion, time_s),
            ticks,
        }
    }
}
