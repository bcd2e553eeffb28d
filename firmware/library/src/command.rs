//! What a host commands the leg to do.

use crate::jog::{JogDemand, JogRefusal};
use crate::set_point::{PointRefusal, SetPoint};
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
    /// Turns one motor of a disarmed leg slowly.
    Jog(JogDemand),
    /// Leaves a leg that rests: it keeps station without a host where its setting allows that and its sensors agree, and is
    /// stopped otherwise.
    KeepStation,
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
    /// The set-point is refused.
    Point(PointRefusal),
    /// The jog is refused.
    Jog(JogRefusal),
    /// A motor is jogged only while the leg is disarmed.
    NotDisarmed(State),
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
            Self::State(State::KeepingStation) => ["the leg keeps station", "arm it to go on"],
            Self::State(State::Held) => ["the leg is held", "clear it to go on"],
            Self::State(State::RampingDown) => {
                ["the leg is ramping down", "wait until it is disarmed"]
            }
            Self::State(State::Off) => ["the drivers are off after a fault", "clear it"],
            Self::State(State::Jogging) => ["a motor is jogged", "wait for its end, or stop it"],
            Self::OutOfReach => [
                "the leg cannot lean that far",
                "stay within the rig's greatest tilt",
            ],
            Self::Number => [
                "a number is not finite or not above zero",
                "give another number",
            ],
            Self::Superseded => ["a stop came first", "find out why, then command again"],
            Self::Point(refusal) => refusal.description(),
            Self::Jog(refusal) => refusal.description(),
            Self::NotDisarmed(State::Boot) => ["the leg is still starting", "ask again"],
            Self::NotDisarmed(State::Homing) => [
                "the leg is homing, and a motor is jogged while it is disarmed",
                "wait for its end, then disarm it",
            ],
            Self::NotDisarmed(State::Active) => [
                "the leg is armed, and a motor is jogged while it is disarmed",
                "disarm it",
            ],
            Self::NotDisarmed(State::KeepingStation) => [
                "the leg keeps station, and a motor is jogged while it is disarmed",
                "disarm it",
            ],
            Self::NotDisarmed(State::Held) => [
                "the leg is held, and a motor is jogged while it is disarmed",
                "disarm it",
            ],
            Self::NotDisarmed(State::RampingDown) => {
                ["the leg is ramping down", "wait until it is disarmed"]
            }
            Self::NotDisarmed(State::Jogging) => {
                ["another motor is jogged", "wait for its end, or stop it"]
            }
            Self::NotDisarmed(State::Disarmed | State::Off) => {
                ["the drivers are off after a fault", "clear it"]
            }
        }
    }
}
