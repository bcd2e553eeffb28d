//! The commands of a scenario, in degrees.

use crate::range;
use leg_base::angles;
use leg_firmware::command::{Command, Compensation};
use leg_firmware::jog::{JogDemand, JogDrive};
use serde::Deserialize;
use strum::{IntoStaticStr, VariantNames};

/// A command to the leg. What the leg itself refuses is let through, so that the refusal can be seen.
#[derive(Clone, Debug, PartialEq, Deserialize, IntoStaticStr, VariantNames)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
#[strum(serialize_all = "snake_case")]
pub enum CommandStep {
    /// To follow commands.
    Arm,
    /// To find its zero.
    Home,
    /// To come to rest on its path.
    Hold,
    /// To stay where it is.
    Stop,
    /// To relax its tendons.
    Disarm,
    /// To clear the faults whose cause is gone.
    Clear,
    /// To keep station where it is.
    KeepStation,
    /// To move.
    Move {
        /// Degrees.
        #[serde(deserialize_with = "range::azimuth_deg")]
        azimuth_deg: f64,
        /// Degrees.
        #[serde(deserialize_with = "range::tilt_deg")]
        tilt_deg: f64,
    },
    /// To take a pretension, N.
    PretensionN(#[serde(deserialize_with = "range::pretension_n")] f64),
    /// To take a bending stiffness.
    Stiffness {
        /// N·m/rad.
        #[serde(deserialize_with = "range::demand_nm_per_rad")]
        nm_per_rad: f64,
        /// Azimuth of the push that it is meant for, degrees; left out for the smallest.
        #[serde(default, deserialize_with = "range::towards_deg")]
        towards_deg: Option<f64>,
    },
    /// Chooses the load that is compensated.
    Compensation(Compensation),
    /// To turn one motor, disarmed.
    Jog {
        /// From 1.
        motor: u8,
        /// How far its tendon is pulled in; negative pays out.
        #[serde(deserialize_with = "range::travel_mm")]
        travel_mm: f64,
        /// At the motor.
        #[serde(deserialize_with = "range::volts")]
        volts: f64,
    },
    /// The same by a step of its servo.
    ServoStep {
        /// From 1.
        motor: u8,
        /// How far its tendon is pulled in; negative pays out.
        #[serde(deserialize_with = "range::travel_mm")]
        travel_mm: f64,
    },
    /// The same by its servo at a constant speed, with a sine added to its voltage.
    ServoSine {
        /// From 1.
        motor: u8,
        /// How far its tendon is pulled in; negative pays out.
        #[serde(deserialize_with = "range::travel_mm")]
        travel_mm: f64,
        /// Of the tendon, without a sign.
        #[serde(deserialize_with = "range::mm_per_s")]
        mm_per_s: f64,
        /// Amplitude of the sine.
        #[serde(deserialize_with = "range::volts")]
        volts: f64,
        /// Its period, ticks of the board.
        period_ticks: u16,
    },
}

/// A jog of a motor.
fn jog(motor: u8, travel_mm: f64, drive: JogDrive) -> Command {
    Command::Jog(JogDemand {
        motor,
        travel_m: (travel_mm / 1000.0) as f32,
        drive,
    })
}

impl CommandStep {
    /// What the host sends.
    #[must_use]
    pub fn command(&self) -> Command {
        match *self {
            Self::Arm => Command::Arm,
            Self::Home => Command::Home,
            Self::Hold => Command::Hold,
            Self::Stop => Command::Stop,
            Self::Disarm => Command::Disarm,
            Self::Clear => Command::Clear,
            Self::KeepStation => Command::KeepStation,
            Self::Move {
                azimuth_deg,
                tilt_deg,
            } => {
                let [x, y] = angles::direction(azimuth_deg, tilt_deg).map(|c| c as f32);
                Command::Move { x, y }
            }
            Self::PretensionN(pretension_n) => Command::Pretension(pretension_n as f32),
            Self::Stiffness {
                nm_per_rad,
                towards_deg,
            } => Command::Stiffness {
                demand_nm_per_rad: nm_per_rad as f32,
                towards: towards_deg.map(|deg| angles::unit_vector(deg).map(|c| c as f32)),
            },
            Self::Compensation(compensation) => Command::Compensation(compensation),
            Self::Jog {
                motor,
                travel_mm,
                volts,
            } => jog(motor, travel_mm, JogDrive::Voltage(volts as f32)),
            Self::ServoStep { motor, travel_mm } => jog(motor, travel_mm, JogDrive::ServoStep),
            Self::ServoSine {
                motor,
                travel_mm,
                mm_per_s,
                volts,
                period_ticks,
            } => {
                let drive = JogDrive::ServoSine {
                    speed_m_per_s: (mm_per_s / 1000.0) as f32,
                    amplitude_v: volts as f32,
                    period_ticks,
                };
                jog(motor, travel_mm, drive)
            }
        }
    }
}
