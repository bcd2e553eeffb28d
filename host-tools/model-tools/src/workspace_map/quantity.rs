//! What a map can show.

use super::Cell;
use clap::ValueEnum;
use serde::Serialize;

/// A quantity of a [`Cell`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum, Serialize)]
#[serde(rename_all = "snake_case")]
#[value(rename_all = "snake_case")]
pub enum Quantity {
    /// Linear deviation of the tip at the rig's level.
    Deviation,
    /// Smallest bending stiffness at the rig's level.
    StiffnessMin,
    /// Largest bending stiffness at the rig's level.
    StiffnessMax,
    /// Largest by smallest bending stiffness at the rig's level.
    Condition,
    /// Distance of the tensions at the rig's level from their bounds; negative beyond them.
    Margin,
    /// Lowest level that keeps the bounds.
    LevelMin,
    /// Highest level that keeps the bounds.
    LevelMax,
    /// Deviation of the tip at the rig's level without linearisation: much slower.
    DeviationNonlinear,
    /// Linear by nonlinear deviation: as slow.
    LinearOverNonlinear,
}

/// Below this the deviation is nothing but rounding, and nothing can be compared with it, mm.
const DEVIATION_ROUNDING_MM: f64 = 1e-9;

impl Quantity {
    /// Every quantity.
    pub const ALL: [Self; 9] = [
        Self::Deviation,
        Self::StiffnessMin,
        Self::StiffnessMax,
        Self::Condition,
        Self::Margin,
        Self::LevelMin,
        Self::LevelMax,
        Self::DeviationNonlinear,
        Self::LinearOverNonlinear,
    ];

    /// Those of every map; the others only if asked for.
    #[must_use]
    pub fn plain() -> &'static [Self] {
        Self::ALL.split_at(7).0
    }

    /// Whether it takes the nonlinear deviation.
    #[must_use]
    pub const fn is_nonlinear(self) -> bool {
        matches!(self, Self::DeviationNonlinear | Self::LinearOverNonlinear)
    }

    /// Its name in files and on the command line.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Deviation => "deviation",
            Self::StiffnessMin => "stiffness_min",
            Self::StiffnessMax => "stiffness_max",
            Self::Condition => "condition",
            Self::Margin => "margin",
            Self::LevelMin => "level_min",
            Self::LevelMax => "level_max",
            Self::DeviationNonlinear => "deviation_nonlinear",
            Self::LinearOverNonlinear => "linear_over_nonlinear",
        }
    }

    /// Its name in words.
    #[must_use]
    pub const fn words(self) -> &'static str {
        match self {
            Self::Deviation => "deviation of the tip",
            Self::StiffnessMin => "smallest bending stiffness",
            Self::StiffnessMax => "largest bending stiffness",
            Self::Condition => "condition number",
            Self::Margin => "tension margin",
            Self::LevelMin => "lowest feasible level",
            Self::LevelMax => "highest feasible level",
            Self::DeviationNonlinear => "nonlinear deviation",
            Self::LinearOverNonlinear => "linear by nonlinear",
        }
    }

    /// Its unit; none for a ratio.
    #[must_use]
    pub const fn unit(self) -> &'static str {
        match self {
            Self::Deviation | Self::DeviationNonlinear => "mm",
            Self::StiffnessMin | Self::StiffnessMax => "N·m/rad",
            Self::Condition => "",
            Self::Margin | Self::LevelMin | Self::LevelMax => "N",
            Self::LinearOverNonlinear => "%",
        }
    }

    /// Its value in a cell, whether or not that keeps the bounds.
    #[must_use]
    pub fn value(self, cell: &Cell) -> Option<f64> {
        let at_level = cell.at_level.ok();
        let nonlinear_mm = || cell.deviation_nonlinear_mm?.ok();
        match self {
            Self::Deviation => Some(at_level?.deviation_mm),
            Self::StiffnessMin => Some(at_level?.stiffness_min_nm_per_rad),
            Self::StiffnessMax => Some(at_level?.stiffness_max_nm_per_rad),
            Self::Condition => Some(at_level?.condition),
            Self::Margin => cell.margin_n,
            Self::LevelMin => Some(cell.level_min_n),
            Self::LevelMax => Some(cell.level_max_n),
            Self::DeviationNonlinear => nonlinear_mm(),
            Self::LinearOverNonlinear => nonlinear_mm()
                .filter(|deviation_mm| *deviation_mm > DEVIATION_ROUNDING_MM)
                .and_then(|deviation_mm| Some(100.0 * at_level?.deviation_mm / deviation_mm)),
        }
    }

    /// Its value in a cell, if it counts there: that of a range where there is one, that of the rig's level where it
    /// keeps the bounds. The margin counts everywhere: below zero it says how far the level is from keeping them.
    #[must_use]
    pub fn of(self, cell: &Cell) -> Option<f64> {
        let counts = match self {
            Self::Margin => true,
            Self::LevelMin | Self::LevelMax => cell.feasible,
            _ => cell.level_keeps_bounds,
        };
        self.value(cell).filter(|_| counts)
    }
}
