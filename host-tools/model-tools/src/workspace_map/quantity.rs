//! What a map can show.

use super::Cell;
use clap::ValueEnum;
use serde::Serialize;

/// A quantity of a [`Cell`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum, Serialize)]
#[serde(rename_all = "snake_case")]
#[value(rename_all = "snake_case")]
pub enum MapQuantity {
    /// Linear deviation of the tip at the rig's pretension.
    Deviation,
    /// Smallest bending stiffness at the rig's pretension.
    StiffnessMin,
    /// Largest bending stiffness at the rig's pretension.
    StiffnessMax,
    /// Largest by smallest bending stiffness at the rig's pretension.
    Condition,
    /// Distance of the tensions at the rig's pretension from their bounds; negative beyond them.
    Margin,
    /// Lowest pretension that keeps the bounds.
    #[value(alias = "level_min")]
    PretensionMin,
    /// Highest pretension that keeps the bounds.
    #[value(alias = "level_max")]
    PretensionMax,
    /// Deviation of the tip at the rig's pretension without linearisation: much slower.
    DeviationNonlinear,
    /// Linear by nonlinear deviation: as slow.
    LinearOverNonlinear,
}

/// Below this the deviation is nothing but rounding, and nothing can be compared with it, mm.
const DEVIATION_ROUNDING_MM: f64 = 1e-9;

impl MapQuantity {
    /// Those of every map; the others only if asked for.
    #[must_use]
    pub fn plain() -> &'static [Self] {
        Self::value_variants().split_at(7).0
    }

    /// Whether it takes the nonlinear deviation.
    #[must_use]
    pub const fn is_nonlinear(self) -> bool {
        matches!(self, Self::DeviationNonlinear | Self::LinearOverNonlinear)
    }

    /// Its name in files and on the command line.
    #[must_use]
    pub const fn name(self) -> &'static str {
        self.texts()[0]
    }

    /// Its name in words.
    #[must_use]
    pub const fn words(self) -> &'static str {
        self.texts()[1]
    }

    /// Its unit; none for a ratio.
    #[must_use]
    pub const fn unit(self) -> &'static str {
        self.texts()[2]
    }

    /// Name, name in words, unit.
    const fn texts(self) -> [&'static str; 3] {
        match self {
            Self::Deviation => ["deviation", "deviation of the tip", "mm"],
            Self::StiffnessMin => ["stiffness_min", "smallest bending stiffness", "N·m/rad"],
            Self::StiffnessMax => ["stiffness_max", "largest bending stiffness", "N·m/rad"],
            Self::Condition => ["condition", "condition number", ""],
            Self::Margin => ["margin", "tension margin", "N"],
            Self::PretensionMin => ["pretension_min", "lowest feasible pretension", "N"],
            Self::PretensionMax => ["pretension_max", "highest feasible pretension", "N"],
            Self::DeviationNonlinear => ["deviation_nonlinear", "nonlinear deviation", "mm"],
            Self::LinearOverNonlinear => ["linear_over_nonlinear", "linear by nonlinear", "%"],
        }
    }

    /// Its value in a cell, whether or not that keeps the bounds.
    #[must_use]
    pub fn value(self, cell: &Cell) -> Option<f64> {
        let at_pretension = cell.at_pretension.ok();
        let nonlinear_mm = || cell.deviation_nonlinear_mm?.ok();
        match self {
            Self::Deviation => Some(at_pretension?.deviation_mm),
            Self::StiffnessMin => Some(at_pretension?.stiffness_min_nm_per_rad),
            Self::StiffnessMax => Some(at_pretension?.stiffness_max_nm_per_rad),
            Self::Condition => Some(at_pretension?.condition),
            Self::Margin => cell.margin_n,
            Self::PretensionMin => Some(cell.pretension_min_n),
            Self::PretensionMax => Some(cell.pretension_max_n),
            Self::DeviationNonlinear => nonlinear_mm(),
            Self::LinearOverNonlinear => nonlinear_mm()
                .filter(|deviation_mm| *deviation_mm > DEVIATION_ROUNDING_MM)
                .and_then(|deviation_mm| Some(100.0 * at_pretension?.deviation_mm / deviation_mm)),
        }
    }

    /// Its value in a cell, if it counts there: that of a range where there is one, that of the rig's pretension where it
    /// keeps the bounds. The margin counts everywhere: below zero it says how far the pretension is from keeping them.
    #[must_use]
    pub fn counted_value(self, cell: &Cell) -> Option<f64> {
        let counts = match self {
            Self::Margin => true,
            Self::PretensionMin | Self::PretensionMax => cell.feasible,
            _ => cell.pretension_keeps_bounds,
        };
        self.value(cell).filter(|_| counts)
    }
}
