//! What the board reads before a tick: raw, as its peripherals give it.

use postcard_schema::Schema;
use serde::{Deserialize, Serialize};

/// Highest code of an analogue input: the sum of 16 conversions of 12 bits, as the converter's oversampling gives it.
pub const CODE_MAX: u16 = 16 * 4095;

/// Codes of a load cell this near to an end of the range are saturated: four steps of the 12-bit converter, whose sixteenfold sum a code is.
pub const SATURATED_CODES: u16 = 64;

/// Ticks of the control law in a second.
pub const TICK_HZ: u16 = 8_000;

/// One reading of every sensor, and what the board knows of itself.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, Schema)]
pub struct Sensors {
    /// Encoder counters of the motors; they wrap. A count up pulls the tendon in.
    pub encoder_counts: [u16; 3],
    /// Load cells, 0 to [`CODE_MAX`]; a code up is more tension.
    pub cell_codes: [u16; 3],
    /// Motor currents, 0 to [`CODE_MAX`]; more is more current, that pulls in where the output shows both directions. What code is none
    /// says [`CurrentZero`].
    pub current_codes: [u16; 3],
    /// Supply voltage, 0 to [`CODE_MAX`].
    pub supply_code: u16,
    /// Temperature of the drivers, 0 to [`CODE_MAX`].
    pub temperature_code: u16,
    /// Whether each load cell's code was converted since the last tick.
    pub cell_fresh: [bool; 3],
    /// Fault line of each motor driver.
    pub driver_fault: [bool; 3],
    /// Whether the emergency stop is pressed.
    pub emergency_stop: bool,
    /// Whether the last tick ended too late, or this one began too late.
    pub late: bool,
    /// Whether the stored settings were not whole at the start, so that others are used.
    pub settings_corrupt: bool,
}

/// Code of no current of an output that shows both directions: half of the highest.
pub const MIDDLE_CODE: f32 = CODE_MAX as f32 * 0.5;

/// Part of half of the converter's range by which a zero may be away from the nominal one. The kit of `BOARD.md` needs
/// 0.033 at the most: test `the_zero_of_a_current_is_within_what_is_taken`.
pub const CURRENT_ZERO_PART: f32 = 0.04;

/// What a motor's current read while the drivers were off after a start, and what is made of it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, Schema)]
pub enum CurrentZero {
    /// The start is not over, or motors were driven before it was: the nominal zero is in use.
    #[default]
    NotFound,
    /// Its mean code: the zero in use.
    Found(f32),
    /// Its mean code, too far from the nominal zero to be one: that stays in use.
    Refused(f32),
}

impl CurrentZero {
    /// Of a mean code, at an output with this nominal zero.
    #[must_use]
    pub fn from_mean(code: f32, nominal_code: f32) -> Self {
        if (code - nominal_code).abs() <= CURRENT_ZERO_PART * MIDDLE_CODE {
            Self::Found(code)
        } else {
            Self::Refused(code)
        }
    }

    /// The code of no current that is in use at an output with this nominal zero.
    #[must_use]
    pub const fn code(self, nominal_code: f32) -> f32 {
        match self {
            Self::Found(code) => code,
            Self::NotFound | Self::Refused(_) => nominal_code,
        }
    }
}

/// What a host is told of the sensors.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, Schema)]
pub struct SensorReading {
    /// What they read in the last tick.
    pub codes: Sensors,
    /// The zero of each motor's current.
    pub current_zeros: [CurrentZero; 3],
}

#[cfg(test)]
impl Sensors {
    /// Of a leg with these settings at rest without tension, at 24 V and 25 °C.
    pub fn resting(settings: &crate::settings::Settings) -> Self {
        let board = &settings.board;
        let temperature = (25.0 - board.temperature_at_zero_c) / board.temperature_c_per_code;
        Self {
            cell_codes: settings.axes.map(|axis| axis.cell_zero_code as u16),
            current_codes: settings
                .current_outputs
                .each()
                .map(|output| output.zero_code() as u16),
            supply_code: (24.0 / board.supply_v_per_code) as u16,
            temperature_code: temperature as u16,
            cell_fresh: [true; 3],
            ..Self::default()
        }
    }
}
