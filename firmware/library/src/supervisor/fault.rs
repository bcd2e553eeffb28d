//! Every fault by name.

use postcard_schema::Schema;
use serde::{Deserialize, Serialize};

/// What a fault leads to, from the mildest to the gravest.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize, Schema)]
#[serde(rename_all = "snake_case")]
pub enum Reaction {
    /// The leg goes on with what is possible.
    Limit,
    /// The leg stays where it is, its tendons kept above the minimum tension.
    Hold,
    /// The tendons are let out until they barely pull, then the drivers are switched off.
    RampDown,
    /// The drivers are switched off at once; the screws hold.
    GateOff,
}

/// A fault. Its number is its code.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize, Schema)]
#[serde(rename_all = "snake_case")]
#[repr(u8)]
#[allow(missing_docs, reason = "the table says what each is")]
pub enum Fault {
    Slack = 1,
    OverTension,
    TensionJump,
    Residual,
    CellStale,
    CellStuck,
    CellSaturated,
    CurrentDisagrees,
    Following,
    EncoderStill,
    EncoderReversed,
    PoseLost,
    Infeasible,
    Unreachable,
    OverCurrent,
    OverTemperature,
    SupplyLow,
    SupplyHigh,
    LateTick,
    CommandTimeout,
    BadFrame,
    DriverFault,
    EmergencyStop,
    SettingsCorrupt,
    HomingFailed,
}

impl Fault {
    /// Every fault, in the order of the codes.
    pub const ALL: [Self; 25] = [
        Self::Slack,
        Self::OverTension,
        Self::TensionJump,
        Self::Residual,
        Self::CellStale,
        Self::CellStuck,
        Self::CellSaturated,
        Self::CurrentDisagrees,
        Self::Following,
        Self::EncoderStill,
        Self::EncoderReversed,
        Self::PoseLost,
        Self::Infeasible,
        Self::Unreachable,
        Self::OverCurrent,
        Self::OverTemperature,
        Self::SupplyLow,
        Self::SupplyHigh,
        Self::LateTick,
        Self::CommandTimeout,
        Self::BadFrame,
        Self::DriverFault,
        Self::EmergencyStop,
        Self::SettingsCorrupt,
        Self::HomingFailed,
    ];

    /// Its code.
    #[must_use]
    pub const fn code(self) -> u8 {
        self as u8
    }

    /// What it leads to.
    #[must_use]
    pub const fn reaction(self) -> Reaction {
        match self {
            Self::Infeasible | Self::Unreachable | Self::BadFrame => Reaction::Limit,
            Self::OverTension | Self::OverTemperature | Self::HomingFailed => Reaction::RampDown,
            Self::EncoderStill
            | Self::EncoderReversed
            | Self::OverCurrent
            | Self::DriverFault
            | Self::EmergencyStop
            | Self::SettingsCorrupt => Reaction::GateOff,
            _ => Reaction::Hold,
        }
    }
}
