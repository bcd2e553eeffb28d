//! What the current outputs of the motors' drivers show.

use crate::sensors::MIDDLE_CODE;
use postcard_schema::Schema;
use serde::{Deserialize, Serialize};

/// What an output shows of a motor's current.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum CurrentOutput {
    /// The current with its sign: half of the highest code is none.
    #[default]
    Bidirectional,
    /// How much it is, while the bridge drives and while it brakes: code 0 is none.
    Magnitude,
    /// How much it is, in the part of the period alone in which the bridge drives: while it brakes, nothing.
    MagnitudeWhenDriven,
}

/// All of them.
pub const CURRENT_OUTPUTS: [CurrentOutput; 3] = [
    CurrentOutput::Bidirectional,
    CurrentOutput::Magnitude,
    CurrentOutput::MagnitudeWhenDriven,
];

impl CurrentOutput {
    /// Code of no current by the data sheet: the zero that is found at each start is near it.
    #[must_use]
    pub const fn zero_code(self) -> f32 {
        match self {
            Self::Bidirectional => MIDDLE_CODE,
            Self::Magnitude | Self::MagnitudeWhenDriven => 0.0,
        }
    }

    const fn bits(self) -> u8 {
        match self {
            Self::Bidirectional => 0,
            Self::Magnitude => 1,
            Self::MagnitudeWhenDriven => 2,
        }
    }

    /// Bits that no output has are those of one that shows both directions.
    const fn from_bits(bits: u8) -> Self {
        match bits & 3 {
            1 => Self::Magnitude,
            2 => Self::MagnitudeWhenDriven,
            _ => Self::Bidirectional,
        }
    }
}

/// The output of each motor: in one byte, as settings fill a message.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, Schema)]
pub struct CurrentOutputs(u8);

impl CurrentOutputs {
    /// Those of the three motors.
    #[must_use]
    pub const fn new([first, second, third]: [CurrentOutput; 3]) -> Self {
        Self(first.bits() | second.bits() << 2 | third.bits() << 4)
    }

    /// Whether one shows no more than a magnitude.
    #[must_use]
    #[inline(always)]
    pub const fn has_magnitudes(self) -> bool {
        self.0 != 0
    }

    /// Whether that of a motor, from 0, does not show short pulses.
    #[must_use]
    pub fn hides_short_pulses(self, motor: usize) -> bool {
        self.each().get(motor) == Some(&CurrentOutput::MagnitudeWhenDriven)
    }

    /// The output of each motor.
    #[must_use]
    pub const fn each(self) -> [CurrentOutput; 3] {
        [
            CurrentOutput::from_bits(self.0),
            CurrentOutput::from_bits(self.0 >> 2),
            CurrentOutput::from_bits(self.0 >> 4),
        ]
    }
}
