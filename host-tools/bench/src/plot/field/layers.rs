//! A map as areas and lines upon each other. Each hides what is below it, so that no gap shows between two of them.

use super::bands::Bands;
use super::contours::{ContourGrid, Outline};
use super::{PlotField, PoseSample};
use plotters::style::RGBColor;
use std::ops::Range;

/// None of the colours of the bands, and none of the greys.
pub(super) const BORDER: RGBColor = RGBColor(236, 200, 196);
pub(super) const EXTERIOR: RGBColor = RGBColor(205, 205, 205);
pub(super) const NO_RESULT: RGBColor = RGBColor(120, 120, 120);

/// How far a row of squares reaches under the next, in parts of the greatest tilt.
const OVERLAP: f64 = 0.006;

/// A part of a map.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Layer {
    /// What is inside an outline.
    Area(Outline, RGBColor),
    /// A line of equal value.
    Line(Outline),
}

/// The map from its ground up.
pub(super) fn layers(field: &PlotField, bands: &Bands) -> Vec<Layer> {
    let whole = rectangle(0.0..360.0, 0.0..field.tilt_max_deg());
    let mut layers = vec![Layer::Area(whole, bands.colour(0))];
    let values = grid(field, |sample| sample.value.unwrap_or_default());
    for (level, band) in bands.inner().iter().zip(1..) {
        for region in values.regions(*level) {
            layers.push(Layer::Area(region.outline(), bands.colour(band)));
            let lines = region.borders();
            let shown = lines.iter().flat_map(|line| shown_pieces(field, line));
            layers.extend(shown.map(|piece| Layer::Line(piece.to_vec())));
        }
    }
    let no_value = |sample: &Option<PoseSample>| sample.is_some_and(|known| known.value.is_none());
    layers.extend(squares(field, no_value));
    // What has no room at all hides what has none at this pretension.
    layers.extend(exterior(field, BORDER, |sample| sample.room));
    layers.extend(exterior(field, EXTERIOR, |sample| {
        sample.room.max(sample.wider_room)
    }));
    layers.extend(squares(field, Option::is_none));
    layers
}

/// Where there is less than no room: where none is left is still inside.
fn exterior(field: &PlotField, colour: RGBColor, room: fn(&PoseSample) -> f64) -> Vec<Layer> {
    let regions = grid(field, |sample| -room(sample)).regions(f64::MIN_POSITIVE);
    let areas = regions
        .iter()
        .map(|region| Layer::Area(region.outline(), colour));
    areas.collect()
}

/// The pieces of a line of which anything is shown: what is hidden would show at the edge of the map.
fn shown_pieces<'a>(
    field: &PlotField,
    line: &'a [(f64, f64)],
) -> impl Iterator<Item = &'a [(f64, f64)]> {
    let (width, height) = field.square_deg();
    let is_shown = move |&(azimuth, tilt): &(f64, f64)| {
        let sample = field.interpolate(azimuth / width, tilt / height);
        sample.is_some_and(|known| known.shown().is_some())
    };
    let pieces = line.chunk_by(move |from, to| is_shown(from) || is_shown(to));
    pieces.filter(|piece| piece.len() > 1)
}

/// A number of each pose; zero where nothing is known.
fn grid(field: &PlotField, number: impl Fn(&PoseSample) -> f64) -> ContourGrid {
    let numbers = field
        .samples
        .iter()
        .map(|sample| sample.as_ref().map_or(0.0, &number));
    ContourGrid::new(
        field.azimuths,
        field.tilt_max_deg(),
        &numbers.collect::<Vec<_>>(),
    )
}

/// The squares between four poses, those of a row as one, of which one is such: there nothing is known.
fn squares(field: &PlotField, such: impl Fn(&Option<PoseSample>) -> bool) -> Vec<Layer> {
    let (columns, edge) = (field.azimuths, field.tilt_max_deg());
    let (width, height) = field.square_deg();
    let mut areas = Vec::new();
    for row in 0..field.tilts_deg.len() - 1 {
        let is_such = |column: &usize| {
            let corners = [(0, 0), (1, 0), (0, 1), (1, 1)];
            corners.iter().any(|(right, up)| {
                such(&field.samples[(row + up) * columns + (column + right) % columns])
            })
        };
        let all: Vec<usize> = (0..columns).collect();
        let runs = all.chunk_by(|left, right| is_such(left) == is_such(right));
        for run in runs.filter(|run| run.first().is_some_and(is_such)) {
            let (first, past) = (run[0] as f64, (run[0] + run.len()) as f64);
            let top = ((row + 1) as f64 * height + OVERLAP * edge).min(edge);
            let outline = rectangle(first * width..past * width, row as f64 * height..top);
            areas.push(Layer::Area(outline, NO_RESULT));
        }
    }
    areas
}

fn rectangle(azimuths_deg: Range<f64>, tilts_deg: Range<f64>) -> Outline {
    let (left, right) = (azimuths_deg.start, azimuths_deg.end);
    let (low, high) = (tilts_deg.start, tilts_deg.end);
    vec![(left, low), (right, low), (right, high), (left, high)]
}
