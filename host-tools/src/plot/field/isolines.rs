//! Lines of equal value, by marching squares.

use super::Field;
use super::bands::Bands;
use contour::ContourBuilder;

/// The lines between the bands as points (azimuth, tilt), degrees. They end where values end.
pub(super) fn isolines(field: &Field, bands: &Bands) -> Vec<Vec<(f64, f64)>> {
    // The full turn is repeated, so that lines reach it.
    let values: Vec<f64> = field
        .values
        .chunks(field.azimuths)
        .flat_map(|row| row.iter().chain(row.first()))
        .map(|value| value.unwrap_or(f64::NAN))
        .collect();
    let rows = field.tilts_deg.len();
    let edge = field.tilt_max_deg();
    let (x_step, y_step) = (360.0 / field.azimuths as f64, edge / (rows - 1) as f64);
    // Marching squares take a value as that of a cell's middle.
    let lines = ContourBuilder::new(field.azimuths + 1, rows, true)
        .x_step(x_step)
        .y_step(y_step)
        .x_origin(-0.5 * x_step)
        .y_origin(-0.5 * y_step)
        .lines(&values, bands.inner())
        .unwrap_or_default();
    let inside = |&(x, y): &(f64, f64)| x > 0.0 && x < 360.0 && y > 0.0 && y < edge;
    let mut rings: Vec<Vec<(f64, f64)>> = Vec::new();
    for ring in lines.iter().flat_map(|line| &line.geometry().0) {
        rings.push(ring.0.iter().map(|point| (point.x, point.y)).collect());
    }
    // Where a ring runs along the border it is none of the value's lines.
    let pieces = rings
        .iter()
        .flat_map(|ring| ring.split(|point| !inside(point)));
    pieces
        .filter(|piece| piece.len() > 1)
        .map(<[_]>::to_vec)
        .collect()
}
