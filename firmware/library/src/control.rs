//! The control law: from what the sensors read to what the motors do, in one pure tick.

mod axis;
pub(crate) mod bounds;
mod damping;
mod debounce;
mod estimate;
mod filter;
mod friction;
mod homing;
mod inertia;
mod jog_bounds;
mod load_estimate;
mod magnitude;
mod measure;
mod mechanism;
mod payload_estimate;
mod payload_moments;
mod plan;
mod play;
mod pretension;
mod quintic;
mod segment;
mod stream;
mod stream_limits;
mod swing_speed;
mod target;
mod tendon_damping;
mod trajectory;
mod unloaded;

pub use axis::{Axis, AxisGoal, AxisInput, AxisView, LIMITED_AHEAD_M};
pub use damping::{MOVING_SWINGING_M, SWINGING_M, SwingDamping};
pub use debounce::Debounce;
pub use estimate::{Estimate, Estimator, LengthError};
pub use filter::LowPass;
pub use friction::{FRICTION_ALLOWANCE, Friction, PULL_ALLOWANCE};
pub use homing::{HaulLimit, HomingSequence, HomingStep};
pub use inertia::Turn;
pub use jog_bounds::{JOG_RISE_S, JOG_TIME_MAX_S, JogBounds, step_range_m};
pub use load_estimate::{LoadEstimate, LoadEstimation};
pub use magnitude::{Applied, Magnitude, SHOWN_PART};
pub use measure::{Measured, Measurement, ZERO_READINGS};
pub use mechanism::Mechanism;
pub use payload_estimate::UNKNOWN_MOVED_KG;
pub use plan::{MotionLimits, REACHED};
pub use play::Play;
pub use pretension::{PretensionDemand, PretensionSearch};
pub use quintic::{MotionState, Quintic};
pub use segment::Knot;
pub use stream::{POINTS_MAX, Stream};
pub use stream_limits::StreamLimits;
pub use target::{Target, TargetDemand, TargetGenerator};
pub use trajectory::{Point, Trajectory};
pub use unloaded::Unloaded;

use crate::sensors::TICK_HZ;

/// Time of a tick, s.
pub const TICK_S: f32 = 1.0 / TICK_HZ as f32;

/// Ticks in which estimate, pretension, target and the plan of the trajectory are each renewed once, one a tick.
pub const CYCLE_TICKS: u8 = 4;

/// Time of a cycle, s.
pub const CYCLE_S: f32 = CYCLE_TICKS as f32 * TICK_S;

/// Time of two cycles, s: the offsets of the lengths and the load have one of them, the search for the pretension the other.
pub const SLOW_STEP_S: f32 = 2.0 * CYCLE_S;

/// Ticks in a time in s, at least one.
#[must_use]
pub fn ticks(time_s: f32) -> u32 {
    let ticks = time_s * f32::from(TICK_HZ);
    if ticks >= 1.0 { ticks as u32 } else { 1 }
}
