//! The states and the events that lead from one to another.

use super::reaction::Reaction;
use postcard_schema::Schema;
use serde::{Deserialize, Serialize};

/// What the leg is allowed to do.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, Schema)]
#[serde(rename_all = "snake_case")]
pub enum State {
    /// The first ticks: the sensors are read, nothing is driven.
    Boot,
    /// Ready; the drivers are off and the screws hold.
    Disarmed,
    /// The zero is searched for.
    Homing,
    /// Commands are followed.
    Active,
    /// The leg compensates its load slowly where it was left; it needs no host.
    KeepingStation,
    /// The leg stays where it is, its motors at rest on their screws.
    Held,
    /// The tendons are paid out until they are slack.
    RampingDown,
    /// The drivers are off after a fault; the screws hold.
    Off,
    /// One motor of a leg that was disarmed turns slowly.
    Jogging,
}

/// What happens to the leg.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Event {
    /// The first ticks are over.
    Ready,
    /// The host arms a leg that knows its zero, or lets one follow commands again that keeps station.
    Arm,
    /// The host leaves a leg that rests where it was led.
    KeepStation,
    /// The host starts homing.
    Home,
    /// The host has one motor turned.
    Jog,
    /// That motor has come to its end.
    Jogged,
    /// Homing has found the zero.
    Homed,
    /// The host stops the leg.
    Stop,
    /// The host disarms the leg, or it was led down for that.
    Disarm,
    /// The host disarms a leg that is held or keeps station and knows its pose: it is led down first.
    LeadDown,
    /// Every tendon is paid out.
    Relaxed,
    /// The last fault is cleared, the zero is not known.
    Clear,
    /// The last fault is cleared, the zero is known.
    ClearHomed,
    /// A fault asks for it.
    Reaction(Reaction),
}

use Event::{
    Arm, Clear, ClearHomed, Disarm, Home, Homed, Jog, Jogged, KeepStation, LeadDown, Ready,
    Relaxed, Stop,
};
use State::{Active, Boot, Disarmed, Held, Homing, Jogging, KeepingStation, Off, RampingDown};

impl State {
    /// Every state.
    pub const ALL: [Self; 9] = [
        Boot,
        Disarmed,
        Homing,
        Active,
        KeepingStation,
        Held,
        RampingDown,
        Off,
        Jogging,
    ];

    /// The state after an event; none if the event means nothing here. This is the whole table.
    #[must_use]
    #[inline(always)]
    pub const fn next(self, event: Event) -> Option<Self> {
        Some(match (self, event) {
            (Boot, Ready) => Disarmed,
            (Disarmed, Arm) => Active,
            (Disarmed, Home) => Homing,
            (Disarmed, Jog) => Jogging,
            (Jogging, Jogged | Stop | Disarm) => Disarmed,
            // No tendon is led anywhere: the screws hold.
            (Jogging, Event::Reaction(Reaction::Hold | Reaction::RampDown)) => Off,
            (Homing, Homed) => Active,
            (Active, KeepStation) => KeepingStation,
            (KeepingStation, Arm | LeadDown) => Active,
            (Homing | Active | KeepingStation, Stop) => Held,
            (Homing | Active | KeepingStation | Held, Disarm) => RampingDown,
            (RampingDown, Relaxed) => Disarmed,
            (Held, ClearHomed | LeadDown) => Active,
            (Held, Clear) => RampingDown,
            (Off, Clear | ClearHomed) => Disarmed,
            (Homing | Active | KeepingStation, Event::Reaction(Reaction::Hold)) => Held,
            (Homing | Active | KeepingStation | Held, Event::Reaction(Reaction::RampDown)) => {
                RampingDown
            }
            (Off, Event::Reaction(_)) => return None,
            (_, Event::Reaction(Reaction::GateOff)) => Off,
            _ => return None,
        })
    }

    /// Whether the drivers are on.
    #[must_use]
    #[inline(always)]
    pub const fn driven(self) -> bool {
        matches!(
            self,
            Homing | Active | KeepingStation | Held | RampingDown | Jogging
        )
    }

    /// Whether the leg follows its host, whose silence is a fault then.
    #[must_use]
    #[inline(always)]
    pub const fn follows(self) -> bool {
        matches!(self, Homing | Active | Jogging)
    }

    /// Whether the motors are led to where the control law wants them.
    #[must_use]
    #[inline(always)]
    pub const fn led(self) -> bool {
        matches!(self, Homing | Active | KeepingStation)
    }
}
