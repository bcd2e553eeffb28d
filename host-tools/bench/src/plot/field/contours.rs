//! Where a number over the workspace is at least as large as a level, by marching squares.

use contour::ContourBuilder;
use std::iter;

/// Points (azimuth, tilt), degrees.
pub(super) type Outline = Vec<(f64, f64)>;

/// A number of each pose.
pub(super) struct ContourGrid {
    columns: usize,
    rows: usize,
    edge_deg: f64,
    /// Row by row from tilt 0 on, with columns of the turns before and after, so that outlines reach 0° and 360°.
    values: Vec<f64>,
}

/// Columns of the turn before, and of the one after.
const BEFORE: usize = 1;
const AFTER: usize = 2;

impl ContourGrid {
    /// Numbers row by row from tilt 0 to the greatest one, in columns of which the full turn is not repeated.
    pub fn new(columns: usize, edge_deg: f64, values: &[f64]) -> Self {
        let wrapped = |row: &[f64]| {
            let places = (0..BEFORE + row.len() + AFTER).map(|i| i + row.len() - BEFORE);
            let turned = places.map(|place| row[place % row.len()]);
            turned.collect::<Vec<_>>()
        };
        Self {
            columns,
            rows: values.len() / columns,
            edge_deg,
            values: values.chunks(columns).flat_map(wrapped).collect(),
        }
    }

    /// The regions in which it is at least as large as the level.
    pub fn regions(&self, level: f64) -> Vec<Region> {
        let [column_deg, row_deg] = [
            360.0 / self.columns as f64,
            self.edge_deg / (self.rows - 1) as f64,
        ];
        // Marching squares take a value as that of a cell's middle.
        let builder = ContourBuilder::new(BEFORE + self.columns + AFTER, self.rows, true)
            .x_step(column_deg)
            .y_step(row_deg)
            .x_origin(-(BEFORE as f64 + 0.5) * column_deg)
            .y_origin(-0.5 * row_deg);
        let contours = builder.contours(&self.values, &[level]).unwrap_or_default();
        let polygons = contours.iter().flat_map(|contour| &contour.geometry().0);
        polygons
            .map(|polygon| {
                let rings = iter::once(polygon.exterior()).chain(polygon.interiors());
                Region {
                    rings: rings
                        .map(|ring| {
                            ring.0
                                .iter()
                                .map(|at| self.nearest_on_map((at.x, at.y)))
                                .collect()
                        })
                        .collect(),
                    edge_deg: self.edge_deg,
                }
            })
            .collect()
    }

    /// The nearest place of the map. A ring has a point wherever it leaves the map: between these it runs along the map's edge.
    fn nearest_on_map(&self, (azimuth_deg, tilt_deg): (f64, f64)) -> (f64, f64) {
        (
            azimuth_deg.clamp(0.0, 360.0),
            tilt_deg.clamp(0.0, self.edge_deg),
        )
    }
}

/// A region of the map.
pub(super) struct Region {
    /// Its outer ring, and those of its holes.
    rings: Vec<Outline>,
    edge_deg: f64,
}

impl Region {
    /// Its outline in one: a line goes to each hole, around it and back.
    pub fn outline(&self) -> Outline {
        let Some((outer, holes)) = self.rings.split_first() else {
            return Vec::new();
        };
        let there_and_back = holes
            .iter()
            .flat_map(|hole| hole.iter().chain(outer.first()));
        outer.iter().chain(there_and_back).copied().collect()
    }

    /// Its borders, without what runs along the map's edge.
    pub fn borders(&self) -> Vec<Outline> {
        let along = |a: f64, b: f64, edge: f64| a == edge && b == edge;
        let inside = |a: &(f64, f64), b: &(f64, f64)| {
            let beside = [0.0, 360.0].into_iter().any(|edge| along(a.0, b.0, edge));
            let beyond = [0.0, self.edge_deg]
                .into_iter()
                .any(|edge| along(a.1, b.1, edge));
            !beside && !beyond
        };
        let pieces = self.rings.iter().flat_map(|ring| ring.chunk_by(inside));
        let lines = pieces.filter(|piece| piece.len() > 1);
        lines.map(<[_]>::to_vec).collect()
    }
}
