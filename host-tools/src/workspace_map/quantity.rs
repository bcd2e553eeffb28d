//! What a map can show.

use super::{Cell, WorkspaceMap};
use crate::plot::field::Field;
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

    /// Its value in a cell. Where no level keeps the bounds only the margin has one.
    #[must_use]
    pub fn of(self, cell: &Cell) -> Option<f64> {
        let value = match self {
            Self::Margin => return Some(cell.margin_n),
            Self::Deviation => cell.deviation_mm,
            Self::StiffnessMin => cell.stiffness_min_nm_per_rad,
            Self::StiffnessMax => cell.stiffness_max_nm_per_rad,
            Self::Condition => cell.condition,
            Self::LevelMin => cell.level_min_n,
            Self::LevelMax => cell.level_max_n,
        };
        (cell.feasible && value.is_finite()).then_some(value)
    }
}

impl WorkspaceMap {
    /// A quantity over the workspace, to be drawn.
    #[must_use]
    pub fn field(&self, quantity: Quantity, title: String) -> Field {
        let last = f64::from(self.grid.tilts - 1);
        let tilt = |row| self.tilt_max_deg * f64::from(row) / last;
        let value = |cell: &Result<Cell, _>| cell.as_ref().ok().and_then(|cell| quantity.of(cell));
        let unit = match quantity.unit() {
            "" => String::new(),
            unit => format!(" ({unit})"),
        };
        Field {
            title,
            quantity: format!("{}{unit}", quantity.words()),
            nothing: "no feasible level".into(),
            azimuths: self.grid.azimuths as usize,
            tilts_deg: (0..self.grid.tilts).map(tilt).collect(),
            values: self.cells.iter().map(value).collect(),
        }
    }
}
