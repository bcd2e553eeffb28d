//! A jog: one motor turns slowly while the leg is disarmed, to see whether its wires are right and what it and its servo are.

use crate::sensors::TICK_HZ;
use postcard_schema::Schema;
use serde::{Deserialize, Serialize};

/// Farthest that a jog turns, m of tendon.
pub const JOG_TRAVEL_MAX_M: f32 = 0.01;

/// Shortest and longest period of the sine of a jog, ticks: 500 Hz and 1 Hz.
pub const SINE_PERIOD_TICKS: [u16; 2] = [TICK_HZ / 500, TICK_HZ];

/// Time until a sine is measured, s: ten times what a motor and its servo take to settle.
pub const SINE_SETTLE_S: f32 = 0.2;

/// What a jog shall do.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, Schema)]
pub struct JogDemand {
    /// The motor, from 1.
    pub motor: u8,
    /// How far it shall pull its tendon in, m; below zero it pays out.
    pub travel_m: f32,
    /// What turns it.
    pub drive: JogDrive,
}

/// What turns the motor of a jog.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, Schema)]
pub enum JogDrive {
    /// A voltage, without its sign, V.
    Voltage(f32),
    /// Its servo, by a step of the reference.
    ServoStep,
    /// Its servo, at a constant speed. A sine is added to the voltage that the servo asks for.
    ServoSine {
        /// Speed of the tendon, without its sign, m/s.
        speed_m_per_s: f32,
        /// Amplitude of the sine, V.
        amplitude_v: f32,
        /// Its period, ticks.
        period_ticks: u16,
    },
}

/// Why a jog is refused.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, Schema)]
pub enum JogRefusal {
    /// There is no motor of that number.
    Motor,
    /// The travel is none, or too far.
    Travel,
    /// The voltage is none, or so high that the motor counts as driven.
    Voltage,
    /// A step is so short that the dead band hides it, or so far that it would be a fault.
    Step,
    /// The speed is none.
    Speed,
    /// The amplitude is none, or so high at that speed that the motor counts as driven.
    Amplitude,
    /// The period is too short or too long.
    Period,
}

impl JogRefusal {
    /// What is wrong, and what to do about it.
    #[must_use]
    pub const fn description(self) -> [&'static str; 2] {
        match self {
            Self::Motor => ["there is no motor of that number", "give 1, 2 or 3"],
            Self::Travel => [
                "a jog turns by no more than 10 mm of tendon, and by more than nothing",
                "give another travel",
            ],
            Self::Voltage => [
                "the voltage is not above zero, or above driven_part of what drives current_a through resistance_ohm",
                "give another voltage",
            ],
            Self::Step => [
                "a step is no less than 20 times dead_band_m, and no more than half of following_m",
                "give another travel",
            ],
            Self::Speed => ["the speed is not above zero", "give another speed"],
            Self::Amplitude => [
                "the amplitude is not above zero, or with what the speed induces above driven_part of what drives current_a through resistance_ohm",
                "give another amplitude, or less speed",
            ],
            Self::Period => [
                "the period of the sine is not within 16 to 8000 ticks",
                "give another period",
            ],
        }
    }
}

/// What ended a jog.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, Schema)]
#[serde(rename_all = "snake_case")]
pub enum JogEnd {
    /// Nothing: it goes on.
    Running,
    /// The travel was reached.
    Arrived,
    /// The motor's encoder counted nothing for 0.1 s.
    NoCounts,
    /// It counted the other way.
    WrongWay,
    /// The encoder of another motor, from 1, counted.
    OtherEncoder(u8),
    /// A load cell, from 1, showed more than the highest tension of homing.
    Tension(u8),
    /// The motor drew more than homing allows for 30 ms.
    Current,
    /// It took longer than it should.
    Time,
    /// A fault, a command or the silence of the host.
    CutOff,
}

/// How a servo answered a jog.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, Schema)]
#[serde(rename_all = "snake_case")]
pub enum ServoResponse<T> {
    /// To a step.
    Step {
        /// How far the motor went beyond its end, m.
        overshoot_m: T,
        /// The time from which it stayed within 5 % of the step, s.
        settled_s: T,
    },
    /// To a sine.
    Sine {
        /// Whole periods that were measured.
        periods: u16,
        /// The voltage that the servo asked for: the parts of it that go with the cosine and the sine, V.
        returned_v: [T; 2],
        /// The same of the voltage at the motor: what the servo asked for, with what was added, V.
        injected_v: [T; 2],
    },
}

impl<T: Copy> ServoResponse<T> {
    /// The same in another precision.
    fn map<U>(&self, number: impl Fn(T) -> U) -> ServoResponse<U> {
        match *self {
            Self::Step {
                overshoot_m,
                settled_s,
            } => ServoResponse::Step {
                overshoot_m: number(overshoot_m),
                settled_s: number(settled_s),
            },
            Self::Sine {
                periods,
                returned_v,
                injected_v,
            } => ServoResponse::Sine {
                periods,
                returned_v: returned_v.map(&number),
                injected_v: injected_v.map(&number),
            },
        }
    }
}

/// What a jog measured.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, Schema)]
pub struct JogReport<T> {
    /// What was asked for.
    pub demand: JogDemand,
    /// What ended it.
    pub end: JogEnd,
    /// How long the motor was driven, s.
    pub time_s: T,
    /// How far each encoder has counted since the start, as pull, m.
    pub pulled_m: [T; 3],
    /// The tension of each tendon at the start and at the end, N.
    pub tensions_n: [[T; 3]; 2],
    /// How long the voltage was full and the motor up to speed, s: `current_a`, `speed_m_per_s` and `tension_n` are means over
    /// that time.
    pub steady_s: T,
    /// The current of the motor, A; the last one where `steady_s` is 0.
    pub current_a: T,
    /// The speed of its tendon by its encoder, m/s.
    pub speed_m_per_s: T,
    /// The tension of its tendon, N.
    pub tension_n: T,
    /// How its servo answered, where that turned it to the end.
    pub servo: Option<ServoResponse<T>>,
}

impl<T: Copy> JogReport<T> {
    /// The same in another precision.
    pub fn map<U>(&self, number: impl Fn(T) -> U) -> JogReport<U> {
        JogReport {
            demand: self.demand,
            end: self.end,
            time_s: number(self.time_s),
            pulled_m: self.pulled_m.map(&number),
            tensions_n: self.tensions_n.map(|tensions| tensions.map(&number)),
            steady_s: number(self.steady_s),
            current_a: number(self.current_a),
            speed_m_per_s: number(self.speed_m_per_s),
            tension_n: number(self.tension_n),
            servo: self.servo.map(|servo| servo.map(&number)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{JogRefusal, SINE_PERIOD_TICKS};

    #[test]
    fn a_refused_period_names_the_shortest_and_the_longest() {
        let [shortest, longest] = SINE_PERIOD_TICKS;
        let [wrong, _] = JogRefusal::Period.description();
        assert!(
            wrong.contains(&format!("{shortest} to {longest} ticks")),
            "{wrong}"
        );
    }
}
