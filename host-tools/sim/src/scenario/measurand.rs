//! What a scenario can measure.

use serde::{Deserialize, Serialize};

/// What can be measured. Averages are over a quarter of a second.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Measurand {
    /// Distance of the average tip from its target, mm.
    TipErrorMm,
    /// Largest distance of the tip from where it was at the mark, mm.
    TipMovedMm,
    /// Largest distance of the true tip from where the last path that was streamed had it at that time, mm.
    FollowErrorMm,
    /// How far behind that path the true tip was in time, on average, ms.
    FollowLagMs,
    /// Lowest true tension since the mark, N.
    TensionMinN,
    /// Highest true tension since the mark, N.
    TensionMaxN,
    /// Longest time since the mark that a true tension was more than 5 % beyond its bounds, ms.
    OutsideMs,
    /// Payload that the leg estimates, kg.
    PayloadKg,
    /// Pretension, N.
    PretensionN,
    /// Stiffness that the leg reports, N·m/rad.
    StiffnessNmPerRad,
    /// Largest error of the lengths that homing found, mm.
    HomingErrorMm,
}

impl Measurand {
    /// Its unit.
    #[must_use]
    pub const fn unit(self) -> &'static str {
        match self {
            Self::TipErrorMm | Self::FollowErrorMm | Self::TipMovedMm | Self::HomingErrorMm => "mm",
            Self::TensionMinN | Self::TensionMaxN | Self::PretensionN => "N",
            Self::OutsideMs | Self::FollowLagMs => "ms",
            Self::PayloadKg => "kg",
            Self::StiffnessNmPerRad => "N·m/rad",
        }
    }
}
