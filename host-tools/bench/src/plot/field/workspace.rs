//! A quantity of the model over the workspace as a field to be drawn.

use super::{PlotField, PoseSample};
use leg_model::Error;
use leg_model_tools::workspace_map::{Cell, MapQuantity, WorkspaceMap};

/// What the shades without a value say: where another pretension would do, and where none does.
const SHADES: [&str; 2] = ["tension out of bounds", "no feasible pretension"];

impl PlotField {
    /// A quantity of a map of the workspace.
    #[must_use]
    pub fn workspace(map: &WorkspaceMap, quantity: MapQuantity, title: String) -> Self {
        let grid = map.grid;
        let [border_label, exterior_label] = SHADES.map(String::from);
        // The vertical, which is one pose, in every column of the first row.
        let azimuths = grid.azimuths as usize;
        let vertical = map.cells.iter().take(1).cycle().take(azimuths);
        let cells = vertical.chain(map.cells.iter().skip(1));
        let samples = cells.map(|cell| sample(quantity, cell));
        let tilts_deg = (0..grid.tilts).map(|row| map.tilt_deg(row));
        Self {
            title,
            quantity: quantity.words().into(),
            unit: quantity.unit().into(),
            border_label,
            exterior_label,
            azimuths,
            tilts_deg: tilts_deg.collect(),
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

#[cfg(test)]
mod tests {
    use super::SHADES;
    use crate::plot::field::scale::room_px;
    use clap::ValueEnum;
    use leg_model_tools::workspace_map::MapQuantity;

    #[test]
    fn heading_and_legend_of_every_map_fit_beside_it() {
        let headings = MapQuantity::value_variants().iter();
        let headings = headings.map(|quantity| (quantity.words(), false));
        for (words, in_legend) in headings.chain(SHADES.map(|words| (words, true))) {
            let room = room_px(words, in_legend);
            assert!(room > 0, "{words}: {room} px");
        }
    }
}
