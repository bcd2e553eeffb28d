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
    /// The last estimate: the leg answers a push with its stiffness, and does not take it for a load. A leg that is armed or cleared takes what its
    /// tendons show then. Once another one is chosen, it stays until the leg rests.
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
    /// Leads the leg straight down where its sensors agree and no fault is latched, relaxes the tendons and switches the drivers off.
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
            Self::Superseded => [
                "a stop or a disarm came first",
                "find out why, then command again",
            ],
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

#[cfg(test)]
mod tests {
    use super::CommandRefusal;
    use crate::jog::JogRefusal;
    use crate::set_point::PointRefusal;
    use crate::supervisor::State;

    /// A word by which a user knows a state.
    fn word(state: State) -> &'static str {
        match state {
            State::Boot => "starting",
            State::Disarmed => "disarmed",
            State::Homing => "homing",
            State::Active => "armed",
            State::KeepingStation => "station",
            State::Held => "held",
            State::RampingDown => "ramping down",
            State::Off => "off",
            State::Jogging => "jogged",
        }
    }

    #[test]
    fn a_refusal_by_a_state_names_it_and_the_way_out_of_it() {
        for state in State::ALL {
            let [wrong, remedy] = CommandRefusal::State(state).description();
            assert!(wrong.contains(word(state)), "{state:?}: {wrong}");
            let out = match state {
                State::Boot => "ask again",
                State::Disarmed | State::KeepingStation => "arm it",
                State::Active => "disarm it",
                State::Held | State::Off => "clear it",
                State::Homing | State::RampingDown | State::Jogging => "wait",
            };
            assert!(remedy.contains(out), "{state:?}: {remedy}");
        }
    }

    #[test]
    fn a_refusal_of_a_jog_by_a_state_names_it_and_the_way_to_disarmed() {
        for state in State::ALL {
            // A leg that is disarmed refuses a jog for a fault alone, which has switched its drivers off.
            let shown = if state == State::Disarmed {
                State::Off
            } else {
                state
            };
            let [wrong, remedy] = CommandRefusal::NotDisarmed(state).description();
            assert!(wrong.contains(word(shown)), "{state:?}: {wrong}");
            let out = match shown {
                State::Boot => "ask again",
                State::Active | State::KeepingStation | State::Held => "disarm it",
                State::Off => "clear it",
                _ => "wait",
            };
            assert!(remedy.contains(out), "{state:?}: {remedy}");
        }
    }

    #[test]
    fn the_other_refusals_say_what_is_wrong_and_what_to_do() {
        for (refusal, wrong, remedy) in [
            (CommandRefusal::NotHomed, "its zero", "home it"),
            (CommandRefusal::Faulted, "a fault is latched", "clear it"),
            (CommandRefusal::OutOfReach, "lean that far", "greatest tilt"),
            (CommandRefusal::Number, "not finite", "another number"),
            (CommandRefusal::Superseded, "a stop", "command again"),
        ] {
            let [says, advises] = refusal.description();
            assert!(says.contains(wrong), "{refusal:?}: {says}");
            assert!(advises.contains(remedy), "{refusal:?}: {advises}");
        }
        let point = PointRefusal::NoStream;
        let described = CommandRefusal::Point(point).description();
        assert_eq!(described, point.description());
        let jog = JogRefusal::Motor;
        assert_eq!(CommandRefusal::Jog(jog).description(), jog.description());
    }
}
