//! Cells of equal colour side by side, as one piece: a picture of a thousand pieces, not of a hundred thousand.

use super::Field;
use super::bands::Bands;

/// Finer rows and columns than the poses, with values between them: the edges of the bands look smooth.
const FINER: usize = 4;

/// A row of cells of one colour.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Run {
    /// First and last azimuth, degrees.
    pub azimuths_deg: (f64, f64),
    /// Lowest and highest tilt, degrees.
    pub tilts_deg: (f64, f64),
    /// The band; none where there is no value.
    pub band: Option<usize>,
}

/// All runs of a field.
pub(super) fn runs(field: &Field, bands: &Bands) -> Vec<Run> {
    let rows = (field.tilts_deg.len() - 1) * FINER;
    let height = field.tilt_max_deg() / rows as f64;
    let row = |row| (row as f64 * height, (row + 1) as f64 * height);
    (0..rows)
        .flat_map(|index| row_of(field, bands, index, row(index)))
        .collect()
}

fn row_of(field: &Field, bands: &Bands, row: usize, tilts_deg: (f64, f64)) -> Vec<Run> {
    let columns = field.azimuths * FINER;
    let width = 360.0 / columns as f64;
    let middle = |index: usize| (index as f64 + 0.5) / FINER as f64;
    let mut runs: Vec<Run> = Vec::new();
    for column in 0..columns {
        let value = field.at(middle(column), middle(row));
        let band = value.map(|value| bands.band(value));
        let end = (column + 1) as f64 * width;
        match runs.last_mut() {
            Some(run) if run.band == band => run.azimuths_deg.1 = end,
            _ => runs.push(Run {
                azimuths_deg: (column as f64 * width, end),
                tilts_deg,
                band,
            }),
        }
    }
    runs
}
