//! What a host commands the leg to do.

use crate::supervisor::State;
use postcard_schema::Schema;
use serde::{Deserialize, Serialize};

/// Which load the tendons are made to hold.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, Schema)]
#[serde(rename_all = "snake_case")]
pub enum Compensation {
    /// None: the leg sags under its own weight and its payload, as without a controller that knows of them.
    Off,
    /// The one estimated from the tensions: the loaded tip comes to its target.
    Estimated,
    /// The last estimate: the leg answers a push with its stiffness, and does not take it for a load.
    Frozen,
}

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

/// A point of a stream: how the leg shall move at a tick.
///
/// Between two points the direction follows a polynomial of fifth degree (in half-tangent coordinates) that has position, rate
/// and acceleration of both. After the last that came the leg comes to rest: smoothly, within its limits.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, Schema)]
pub struct SetPoint {
    /// Which point of the stream it is.
    pub part: StreamPart,
    /// The tick of the leg, as its telemetry counts: at least 16 after that of the point before, at most 80 000 after now.
    pub tick: u32,
    /// Horizontal components of the direction: sin θ cos φ and sin θ sin φ.
    pub direction: [f32; 2],
    /// Their rates, 1/s.
    pub rate: [f32; 2],
    /// Their accelerations, 1/s²; none for those that a smooth motion through the points has.
    pub acceleration: Option<[f32; 2]>,
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

/// A command. A tick obeys one, or refuses it by name.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, Schema)]
pub enum Command {
    /// Nothing: it shows that the host is there.
    KeepAlive,
    /// Follows commands from now on, from the present pose.
    Arm,
    /// Homes: searches for the zero, then tensions the leg straight down.
    Home,
    /// Goes to a direction, given by its horizontal components.
    Move {
        /// p_x = sin θ cos φ.
        x: f32,
        /// p_y = sin θ sin φ.
        y: f32,
    },
    /// Follows a stream of set-points: takes the next one.
    Follow(SetPoint),
    /// Comes to rest on the way, and goes on following commands.
    Hold,
    /// Sets the pretension, N.
    Pretension(f32),
    /// Demands a bending stiffness, N·m/rad: the smallest, or that against a push towards (cos, sin).
    Stiffness {
        /// N·m/rad.
        demand_nm_per_rad: f32,
        /// Direction of the push, of length 1; none for the smallest.
        towards: Option<[f32; 2]>,
    },
    /// Chooses the load that is held.
    Compensation(Compensation),
    /// Stays where it is until a clear, before whatever waits. A leg that is disarmed, held or off is at rest already; one
    /// that ramps down goes on with that, and refuses by its state.
    Stop,
    /// Relaxes the tendons and switches the drivers off.
    Disarm,
    /// Clears the faults whose cause is gone.
    Clear,
}

/// Why a command is not obeyed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, Schema)]
pub enum CommandRefusal {
    /// The leg does not know its zero.
    NotHomed,
    /// A fault has to be cleared first, or its cause is still there.
    Faulted,
    /// It means nothing in this state.
    State(State),
    /// The leg cannot lean that far.
    OutOfReach,
    /// A number is not finite, or is not above zero where it has to be, or a direction has another length than 1.
    Number,
    /// A stop came first.
    Superseded,
    /// The tendons are not taut yet.
    NotTaut,
    /// A stream is followed already.
    Following,
    /// No stream is followed: it has ended, or has not begun.
    NoStream,
    /// As many points wait as there is room for.
    StreamFull,
    /// The time of the point has passed.
    LatePoint,
    /// The time of the point is too far ahead.
    EarlyPoint,
    /// The point is not after the one before, or too near to it.
    PointOrder,
    /// The way to the point, or from it to rest, is beyond a limit of the motion.
    Limit(MotionLimit),
}

impl CommandRefusal {
    /// What is wrong, and what to do about it.
    #[must_use]
    pub const fn description(self) -> [&'static str; 2] {
        match self {
            Self::NotHomed => ["the leg does not know its zero", "home it"],
            Self::Faulted => ["a fault is latched", "remove its cause, then clear it"],
            Self::State(State::Boot) => ["the leg is still starting", "ask again"],
            Self::State(State::Disarmed) => ["the leg is disarmed", "arm it"],
            Self::State(State::Homing) => ["the leg is homing", "wait for its end, or stop it"],
            Self::State(State::Active) => ["the leg is armed already", "disarm it first"],
            Self::State(State::Held) => ["the leg is held", "clear it to go on"],
            Self::State(State::RampingDown) => {
                ["the leg is ramping down", "wait until it is disarmed"]
            }
            Self::State(State::Off) => ["the drivers are off after a fault", "clear it"],
            Self::OutOfReach => [
                "the leg cannot lean that far",
                "stay within the rig's greatest tilt",
            ],
            Self::Number => [
                "a number is not finite or not above zero",
                "give another number",
            ],
            Self::Superseded => ["a stop came first", "find out why, then command again"],
            Self::NotTaut => ["the tendons are not taut yet", "wait until they are"],
            Self::Following => ["a stream is followed already", "hold the leg first"],
            Self::NoStream => [
                "no stream is followed: it has ended, or has not begun",
                "begin a new one",
            ],
            Self::StreamFull => ["as many set-points wait as there is room for", "wait"],
            Self::LatePoint => ["the time of the set-point has passed", "send it earlier"],
            Self::EarlyPoint => [
                "the time of the set-point is more than 10 s ahead",
                "send it later",
            ],
            Self::PointOrder => [
                "the set-point is not 2 ms or more after the one before",
                "send points in their order, at 500 Hz or less",
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
