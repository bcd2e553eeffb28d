//! What the control law is set to: the mechanism, the calibration of its sensors, gains and limits.

mod current_output;
mod default;
mod field;
mod gains;
mod out_of_range;
mod recorded;
mod sections;
mod tendon;

pub use current_output::{CURRENT_OUTPUTS, CurrentOutput, CurrentOutputs};
pub use field::Field;
pub use gains::{Gains, SECTIONS, SERVO};
pub use out_of_range::OutOfRange;
pub use recorded::{RECORDED_SIGNALS, RecordedSignal, SignalSet};
pub use sections::{
    AxisCalibration, BoardCalibration, Estimation, Homing, Limits, Motion, POSITION_GAIN_MAX_PER_S,
    SPEED_BY_POSITION, Servo,
};
pub use tendon::TendonParameters;

use leg_model::{Error, JointStiffness, Quantity, Reason, RigParameters, SupportKind};
use postcard_schema::Schema;
use sections::UNSTRETCHED;
use serde::{Deserialize, Serialize};

#[cfg(test)]
mod tests;

/// All settings.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, Schema)]
pub struct Settings {
    /// The mechanism.
    pub rig: RigParameters<f32, 3>,
    /// How its central support guides the leg.
    pub support: SupportKind,
    /// How the joint of the support resists.
    pub joint: JointStiffness<f32>,
    /// Its tendons.
    pub tendons: [TendonParameters; 3],
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
    /// What the current output of each motor's driver shows.
    pub current_outputs: CurrentOutputs,
    /// What they share.
    pub board: BoardCalibration,
    /// How the leg moves.
    pub motion: Motion,
    /// How each motor follows.
    pub servos: [Servo; 3],
    /// How pose and load are estimated.
    pub estimation: Estimation,
    /// What is taken as a fault.
    pub limits: Limits,
    /// How the zero is found.
    pub homing: Homing,
    /// Whether the leg may keep station after a command.
    pub keeps_station: bool,
    /// What the recorder keeps of the last ticks.
    pub recorded: SignalSet,
}

/// Sine of the greatest tilt that a rig file may give, 60°, with its rounding.
const TILT_MAX_SINE: f32 = 0.866_03;

/// Why settings are refused.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, Schema)]
pub enum SettingsError {
    /// The mechanism, its tendons or its tensions.
    Model(Error),
    /// A gain, a limit or a calibration.
    OutOfRange(OutOfRange),
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
        }
    }
}

impl core::error::Error for SettingsError {}

impl Settings {
    /// The same for a leg that has to be homed: a zero holds only from the start at which it was found.
    #[must_use]
    pub fn unhomed(&self) -> Self {
        let mut settings = self.clone();
        settings.forget_zero();
        settings
    }

    /// Forgets the zero: the leg has to home.
    pub fn forget_zero(&mut self) {
        for axis in &mut self.axes {
            axis.unstretched_at_zero_m = None;
        }
    }

    /// A value of the motor that has the most of it.
    #[must_use]
    pub fn greatest(&self, value: fn(&Servo) -> f32) -> f32 {
        self.servos.iter().map(value).fold(f32::MIN, f32::max)
    }

    /// A value of the motor that has the least of it.
    #[must_use]
    pub fn least(&self, value: fn(&Servo) -> f32) -> f32 {
        self.servos.iter().map(value).fold(f32::MAX, f32::min)
    }

    /// Gains and limits.
    #[must_use]
    pub fn gains(&self) -> Gains {
        Gains {
            motion: self.motion,
            servos: self.servos,
            estimation: self.estimation,
            limits: self.limits,
            homing: self.homing,
        }
    }

    /// Checks gains, limits, the greatest tilt and calibration. The mechanism is checked where it is built.
    ///
    /// # Errors
    /// The first value that is refused.
    pub fn check(&self) -> Result<(), SettingsError> {
        OutOfRange::check(0, 0, Motion::FIELDS, &self.motion.values())?;
        for (number, servo) in (1..).zip(&self.servos) {
            OutOfRange::check(1, number, Servo::FIELDS, &servo.values())?;
        }
        OutOfRange::check(2, 0, Estimation::FIELDS, &self.estimation.values())?;
        OutOfRange::check(3, 0, Limits::FIELDS, &self.limits.values())?;
        OutOfRange::check(4, 0, Homing::FIELDS, &self.homing.values())?;
        // Not where it is no number.
        if !(self.tilt_max_sine > 0.0 && self.tilt_max_sine <= TILT_MAX_SINE) {
            return Err(SettingsError::Model(Error::Refused {
                quantity: Quantity::Tilt,
                reason: Reason::OutOfRange,
            }));
        }
        let bounds = self.f_min_n..=self.f_max_n;
        // Bounds that are none are refused with the mechanism.
        if !bounds.is_empty() && !bounds.contains(&self.pretension_n) {
            return Err(SettingsError::Model(Error::Refused {
                quantity: Quantity::Pretension,
                reason: Reason::OutsideBounds,
            }));
        }
        for (number, axis) in (1..).zip(&self.axes) {
            OutOfRange::check(5, number, AxisCalibration::FIELDS, &axis.values())?;
            let zero = axis.unstretched_at_zero_m.unwrap_or(0.0);
            OutOfRange::check(6, number, &[UNSTRETCHED], &[zero])?;
        }
        OutOfRange::check(7, 0, BoardCalibration::FIELDS, &self.board.values())?;
        Ok(())
    }
}
