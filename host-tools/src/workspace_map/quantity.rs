//! What a map can show.

use super::{Cell, WorkspaceMap};
use crate::plot::field::{Field, Sample};
use clap::ValueEnum;
use serde::Serialize;

/// A quantity of a [`Cell`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum, Serialize)]
#[serde(rename_all = "snake_case")]
#[value(rename_all = "snake_case")]
pub enum Quantity {
    /// Deviation of the tip at the rig's level.
    Deviation,
    /// Smallest bending stiffness.
    StiffnessMin,
    /// Largest bending stiffness.
    StiffnessMax,
    /// Largest by smallest bending stiffness.
    Condition,
    /// Distance of the tensions at the rig's level from their bounds.
    Margin,
    /// Lowest level that keeps the bounds.
    LevelMin,
    /// Highest level that keeps the bounds.
    LevelMax,
}

impl Quantity {
    /// Every quantity.
    pub const ALL: [Self; 7] = [
        Self::Deviation,
        Self::StiffnessMin,
        Self::StiffnessMax,
        Self::Condition,
        Self::Margin,
        Self::LevelMin,
        Self::LevelMax,
    ];

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
        }
    }

    /// Its unit; none for a ratio.
    #[must_use]
    pub const fn unit(self) -> &'static str {
        match self {
            Self::Deviation => "mm",
            Self::StiffnessMin | Self::StiffnessMax => "N·m/rad",
            Self::Condition => "",
            Self::Margin | Self::LevelMin | Self::LevelMax => "N",
        }
    }

    /// Its value in a cell, feasible or not.
    #[must_use]
    pub const fn value(self, cell: &Cell) -> f64 {
        match self {
            Self::Deviation => cell.deviation_mm,
            Self::StiffnessMin => cell.stiffness_min_nm_per_rad,
            Self::StiffnessMax => cell.stiffness_max_nm_per_rad,
            Self::Condition => cell.condition,
            Self::Margin => cell.margin_n,
            Self::LevelMin => cell.level_min_n,
            Self::LevelMax => cell.level_max_n,
        }
    }

    /// Its value in a cell, if it counts there: where no level keeps the bounds only the margin does.
    #[must_use]
    pub fn of(self, cell: &Cell) -> Option<f64> {
        (self == Self::Margin || cell.feasible).then(|| self.value(cell))
    }

    /// What a map of it shows of a cell.
    fn sample(self, cell: &Cell) -> Sample {
        let room = match self {
            // It is shown everywhere: below zero it is what the level lacks.
            Self::Margin => 1.0,
            _ => cell.level_max_n - cell.level_min_n,
        };
        Sample {
            value: self.value(cell),
            room,
        }
    }
}

impl WorkspaceMap {
    /// A quantity over the workspace, to be drawn.
    #[must_use]
    pub fn field(&self, quantity: Quantity, title: String) -> Field {
        let grid = self.grid;
        let sample = |cell: &Result<Cell, _>| cell.as_ref().ok().map(|cell| quantity.sample(cell));
        let tilts = (0..grid.tilts).map(|row| super::tilt_deg(self.tilt_max_deg, grid, row));
        Field {
            title,
            quantity: quantity.words().into(),
            unit: quantity.unit().into(),
            outside: "no feasible level".into(),
            azimuths: grid.azimuths as usize,
            tilts_deg: tilts.collect(),
            samples: self.cells.iter().map(sample).collect(),
        }
    }
}
