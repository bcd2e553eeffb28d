//! Set-points: how a leg shall move at a tick.

use postcard_schema::Schema;
use serde::{Deserialize, Serialize};

/// Which point of a stream a set-point is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, Schema)]
pub enum StreamPart {
    /// The first: the leg goes to it from where it is and however it moves.
    First,
    /// One that others follow.
    Next,
    /// The last: the leg comes to rest after it.
    Last,
}

/// What a set-point asks of the tendons, as the commands of the same names do.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, Schema)]
pub enum StreamTension {
    /// A pretension, N.
    Pretension(f32),
    /// A stiffness where the leg is softest, N·m/rad.
    Stiffness(f32),
}

impl StreamTension {
    /// Whether it may be asked for: a finite pretension that is not below 0, or a finite stiffness above 0.
    #[must_use]
    pub fn is_possible(self) -> bool {
        match self {
            Self::Pretension(pretension_n) => pretension_n >= 0.0 && pretension_n.is_finite(),
            Self::Stiffness(stiffness) => stiffness > 0.0 && stiffness.is_finite(),
        }
    }
}

/// A point of a stream: how the leg shall move at a tick.
///
/// Between two points the direction follows a polynomial of fifth degree (in half-tangent coordinates) that has position, rate
/// and acceleration of both. The limits are checked by the control points of that: points 20 ms apart lose nothing by it, points
/// half a second apart half of the speed. After the last that came the leg comes to rest: smoothly, within its limits.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, Schema)]
pub struct SetPoint {
    /// Which point of the stream it is.
    pub part: StreamPart,
    /// The tick of the leg, as its telemetry counts: at least 40 after that of the point before, at most 80 000 after now.
    pub tick: u32,
    /// Horizontal components of the direction: sin θ cos φ and sin θ sin φ.
    pub direction: [f32; 2],
    /// Their rates, 1/s.
    pub rate: [f32; 2],
    /// Their accelerations, 1/s²; none for those that a smooth motion through the points has.
    pub acceleration: Option<[f32; 2]>,
    /// What the pretension is made for from the point before on, and from where the stream begins for the first, at no more than
    /// `pretension_rate_n_per_s`; none for what it was. It stays after the stream, until another point or a command asks for something else.
    pub tension: Option<StreamTension>,
}

/// A limit on the motion of a set-point stream: those of a move.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, Schema)]
pub enum MotionLimit {
    /// `speed_rad_per_s`.
    Speed,
    /// `acceleration_rad_per_s2`.
    Acceleration,
    /// `jerk_rad_per_s3`.
    Jerk,
}

/// Why a set-point is not taken. The stream goes on with those before it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, Schema)]
pub enum PointRefusal {
    /// A number is not finite, a pretension is below 0, or a stiffness not above 0.
    Number,
    /// The direction, or the way to it or from it to rest, leans too far.
    OutOfReach,
    /// The tendons are not taut yet.
    NotTaut,
    /// A stream is followed already.
    Following,
    /// No stream is followed: it has ended, or has not begun.
    NoStream,
    /// As many points wait as there is room for.
    Full,
    /// The time of the point has passed.
    Late,
    /// The time of the point is too far ahead.
    Early,
    /// The point is not after the one before, or too near to it.
    Order,
    /// The way to the point, or from it to rest, is beyond a limit of the motion.
    Limit(MotionLimit),
}

impl PointRefusal {
    /// What is wrong, and what to do about it.
    #[must_use]
    pub const fn description(self) -> [&'static str; 2] {
        match self {
            Self::Number => [
                "a number of the set-point is not finite, its pretension is below 0, or its stiffness not above 0",
                "give another number",
            ],
            Self::OutOfReach => [
                "the leg cannot lean that far, or not come to rest before",
                "stay within the rig's greatest tilt, and slow down before it",
            ],
            Self::NotTaut => ["the tendons are not taut yet", "wait until they are"],
            Self::Following => ["a stream is followed already", "hold the leg first"],
            Self::NoStream => [
                "no stream is followed: it has ended, or has not begun",
                "begin a new one",
            ],
            Self::Full => ["as many set-points wait as there is room for", "wait"],
            Self::Late => ["the time of the set-point has passed", "send it earlier"],
            Self::Early => [
                "the time of the set-point is more than 10 s ahead",
                "send it later",
            ],
            Self::Order => [
                "the set-point is not 5 ms or more after the one before",
                "send points in their order, at 200 Hz or less",
            ],
            Self::Limit(MotionLimit::Speed) => [
                "the set-point asks for more than speed_rad_per_s",
                "take more time",
            ],
            Self::Limit(MotionLimit::Acceleration) => [
                "the set-point asks for more than acceleration_rad_per_s2",
                "take more time; begin at rest where the leg is",
            ],
            Self::Limit(MotionLimit::Jerk) => [
                "the set-point asks for more than jerk_rad_per_s3",
                "take more time; begin at rest where the leg is",
            ],
        }
    }
}
