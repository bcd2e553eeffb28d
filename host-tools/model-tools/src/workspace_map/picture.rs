//! A map as a field to be drawn.

use super::{Cell, MapQuantity, WorkspaceMap, tilt_deg};
use crate::plot::field::{PlotField, PoseSample};
use leg_model::Error;

/// What the shades without a value say: where another pretension would do, and where none does.
pub(super) const SHADES: [&str; 2] = ["tension out of bounds", "no feasible pretension"];

impl WorkspaceMap {
    /// A quantity over the workspace, to be drawn.
    #[must_use]
    pub fn field(&self, quantity: MapQuantity, title: String) -> PlotField {
        let grid = self.grid;
        let [border_label, exterior_label] = SHADES.map(String::from);
        let places =
            (0..grid.tilts).flat_map(|row| (0..grid.azimuths).map(move |column| (row, column)));
        let samples = places.map(|(row, column)| sample(quantity, self.cell(row, column)));
        let tilts = (0..grid.tilts).map(|row| tilt_deg(self.tilt_max_deg, grid, row));
        PlotField {
            title,
            quantity: quantity.words().into(),
            unit: quantity.unit().into(),
            border_label,
            exterior_label,
            azimuths: grid.azimuths as usize,
            tilts_deg: tilts.collect(),
            samples: samples.collect(),
        }
    }
}

fn sample(quantity: MapQuantity, cell: &Result<Cell, Error>) -> Option<PoseSample> {
    let cell = cell.as_ref().ok()?;
    let range_n = cell.pretension_max_n - cell.pretension_min_n;
    let (room, wider_room) = match quantity {
        // It is shown everywhere: below zero it is what the pretension lacks.
        MapQuantity::Margin => (1.0, 1.0),
        MapQuantity::PretensionMin | MapQuantity::PretensionMax => (range_n, range_n),
        _ => (cell.pretension_room_n, range_n),
    };
    Some(PoseSample {
        value: quantity.value(cell),
        room,
        wider_room,
    })
}
