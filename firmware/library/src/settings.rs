//! What the control law is set to: the mechanism, the calibration of its sensors, gains and limits.

mod default;
mod section;
mod sections;

pub use section::{Field, OutOfRange};
pub use sections::{Estimation, Homing, Limits, Motion, SECTIONS, Servo};

use crate::messages::{RigMessage, SupportMessage, TendonsMessage};
use core::ops::RangeInclusive;
use leg_model::{Error, Quantity, Reason};
use postcard_schema::Schema;
use serde::{Deserialize, Serialize};

#[cfg(test)]
mod tests;

/// What one code or count may stand for, but for its sign, in any unit: no sensor is beyond it, and no reading overflows.
const SCALES: RangeInclusive<f32> = 1e-12..=1e3;

/// Greatest offset of a calibration, in any unit.
const OFFSET_MAX: f32 = 1e6;

/// Calibration of one axis: its encoder, its load cell and its motor's current.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, Schema)]
pub struct AxisCalibration {
    /// How far one encoder count pulls the tendon in, m; negative for an encoder that counts the other way.
    pub m_per_count: f32,
    /// Length of the tendon without tension when the board started (counter at zero), m; none until it is homed.
    pub unstretched_at_zero_m: Option<f32>,
    /// Tension by code of the load cell, N.
    pub cell_n_per_code: f32,
    /// Code of the load cell without tension.
    pub cell_zero_code: f32,
    /// Current by code of the motor's current, A; half of the highest code is no current.
    pub current_a_per_code: f32,
}

/// Scales of what all axes share.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, Schema)]
pub struct BoardCalibration {
    /// Supply voltage by code, V.
    pub supply_v_per_code: f32,
    /// Temperature by code, °C.
    pub temperature_c_per_code: f32,
    /// Temperature at code 0, °C.
    pub temperature_at_zero_c: f32,
}

/// All settings.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, Schema)]
pub struct Settings {
    /// The mechanism.
    pub rig: RigMessage,
    /// Its central support.
    pub support: SupportMessage,
    /// Its tendons.
    pub tendons: TendonsMessage,
    /// Lowest tension allowed, N.
    pub f_min_n: f32,
    /// Highest tension allowed, N.
    pub f_max_n: f32,
    /// Pretension until another is commanded, N.
    pub pretension_n: f32,
    /// How far the leg may lean: the sine of the greatest tilt.
    pub tilt_max_sine: f32,
    /// The three axes.
    pub axes: [AxisCalibration; 3],
    /// What they share.
    pub board: BoardCalibration,
    /// How the leg moves.
    pub motion: Motion,
    /// How a motor follows.
    pub servo: Servo,
    /// How pose and load are estimated.
    pub estimation: Estimation,
    /// What is taken as a fault.
    pub limits: Limits,
    /// How the zero is found.
    pub homing: Homing,
}

/// Why settings are refused.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, Schema)]
pub enum SettingsError {
    /// The mechanism, its tendons or its tensions.
    Model(Error),
    /// A gain or a limit.
    OutOfRange(OutOfRange),
    /// A calibration that is not finite, zero or beyond what any sensor has; the axis counts from 1, 0 stands for what the axes share.
    Calibration {
        /// The axis.
        axis: u8,
    },
}

impl From<Error> for SettingsError {
    fn from(error: Error) -> Self {
        Self::Model(error)
    }
}

impl From<OutOfRange> for SettingsError {
    fn from(error: OutOfRange) -> Self {
        Self::OutOfRange(error)
    }
}

impl core::fmt::Display for SettingsError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::Model(error) => error.fmt(f),
            Self::OutOfRange(error) => error.fmt(f),
            Self::Calibration { axis: 0 } => f.write_str(
                "the calibration of supply or temperature is zero or beyond any sensor's",
            ),
            Self::Calibration { axis } => {
                write!(
                    f,
                    "the calibration of axis {axis} is zero or beyond any sensor's"
                )
            }
        }
    }
}

impl core::error::Error for SettingsError {}

impl Settings {
    /// The same for a leg that has to be homed: a zero holds only from the start at which it was found.
    #[must_use]
    pub fn without_zero(&self) -> Self {
        let mut settings = self.clone();
        for axis in &mut settings.axes {
            axis.unstretched_at_zero_m = None;
        }
        settings
    }

    /// Checks gains, limits and calibration. The mechanism is checked where it is built.
    ///
    /// # Errors
    /// The first value that is refused.
    pub fn check(&self) -> Result<(), SettingsError> {
        self.motion.check()?;
        self.servo.check()?;
        self.estimation.check()?;
        self.limits.check()?;
        self.homing.check()?;
        let bounds = self.f_min_n..=self.f_max_n;
        // Bounds that are none are refused with the mechanism.
        if !bounds.is_empty() && !bounds.contains(&self.pretension_n) {
            return Err(SettingsError::Model(Error::Refused {
                quantity: Quantity::Pretension,
                reason: Reason::OutsideBounds,
            }));
        }
        let scale = |value: f32| SCALES.contains(&value.abs());
        let offset = |value: f32| value.abs() <= OFFSET_MAX;
        let shared = [
            self.board.supply_v_per_code,
            self.board.temperature_c_per_code,
        ];
        if !shared.into_iter().all(scale) || !offset(self.board.temperature_at_zero_c) {
            return Err(SettingsError::Calibration { axis: 0 });
        }
        for (axis, calibration) in (1..).zip(&self.axes) {
            let zero = calibration.unstretched_at_zero_m.unwrap_or(0.0);
            let scales = [
                calibration.m_per_count,
                calibration.cell_n_per_code,
                calibration.current_a_per_code,
            ];
            let offsets = offset(zero) && offset(calibration.cell_zero_code);
            if !scales.into_iter().all(scale) || !offsets {
                return Err(SettingsError::Calibration { axis });
            }
        }
        Ok(())
    }
}
