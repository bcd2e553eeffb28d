//! Lines of equal value, by marching squares.

use super::bands::Bands;
use super::{PlotField, PoseSample};
use contour::ContourBuilder;

/// How wide the lines are.
pub(super) const LINE_PX: u32 = 2;

/// The lines between the bands as points (azimuth, tilt), degrees. They end where the region or what is known ends.
pub(super) fn isolines(field: &PlotField, bands: &Bands) -> Vec<Vec<(f64, f64)>> {
    // A column of the turn before and two of the next one, so that lines reach 0° and 360°.
    let wrapped = |row: &[Option<PoseSample>]| {
        let columns = (0..row.len() + 3).map(|i| (i + row.len() - 1) % row.len());
        let values = columns.map(|i| row[i].and_then(|s| s.value).unwrap_or(f64::NAN));
        values.collect::<Vec<f64>>()
    };
    let values: Vec<f64> = field
        .samples
        .chunks(field.azimuths)
        .flat_map(wrapped)
        .collect();
    let rows = field.tilts_deg.len();
    let edge = field.tilt_max_deg();
    let (x_step, y_step) = (360.0 / field.azimuths as f64, edge / (rows - 1) as f64);
    // Marching squares take a value as that of a cell's middle.
    let lines = ContourBuilder::new(field.azimuths + 3, rows, true)
        .x_step(x_step)
        .y_step(y_step)
        .x_origin(-1.5 * x_step)
        .y_origin(-0.5 * y_step)
        .lines(&values, bands.inner())
        .unwrap_or_default();
    let shown = |&(x, y): &(f64, f64)| {
        // Where a ring runs along the border of the values it is none of the value's lines.
        let on_map = (0.0..=360.0).contains(&x) && y > 0.0 && y < edge;
        let sample = || field.interpolate(x / x_step, y / y_step);
        on_map && sample().and_then(|sample| sample.shown()).is_some()
    };
    let rings = lines.iter().flat_map(|line| &line.geometry().0);
    let mut pieces = Vec::new();
    for ring in rings {
        let points: Vec<_> = ring.0.iter().map(|point| (point.x, point.y)).collect();
        pieces.extend(points.split(|point| !shown(point)).map(<[_]>::to_vec));
    }
    pieces.retain(|piece| piece.len() > 1);
    pieces
}
