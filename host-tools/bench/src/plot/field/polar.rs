//! From above: azimuth round, tilt outwards.

use super::bands::Bands;
use super::layers::{Layer, layers};
use super::{LINE, PlotField};
use crate::plot::canvas::{Area, DrawResult, LABEL, THIN, offset_px};
use leg_base::angles;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

/// Room for the labels round the map, in parts of its radius.
const ROOM: f64 = 1.14;

/// A piece of a circle is drawn in steps of this, degrees.
const ARC_DEG: f64 = 2.0;

/// Width of rings and spokes: less than a pixel, so that the colours show through.
const SPOKE: u32 = THIN / 2;

pub(super) fn paint<B: DrawingBackend>(
    field: &PlotField,
    bands: &Bands,
    area: &Area<B>,
) -> DrawResult<B> {
    let edge = field.tilt_max_deg();
    let (width, height) = area.dim_in_pixel();
    let side = width.min(height);
    let (left, top) = ((width - side) / 2, (height - side) / 2);
    let square = area.margin(top, height - side - top, left, width - side - left);
    let reach = -ROOM * edge..ROOM * edge;
    let mut chart = ChartBuilder::on(&square).build_cartesian_2d(reach.clone(), reach)?;
    for layer in layers(field, bands) {
        match layer {
            Layer::Area(outline, colour) => {
                chart.draw_series([Polygon::new(bent(&outline), colour.filled())])?;
            }
            Layer::Line(points) => {
                let line = LineSeries::new(bent(&points), BLACK.stroke_width(LINE));
                chart.draw_series(line)?;
            }
        }
    }
    let text = ("sans-serif", LABEL)
        .into_text_style(area)
        .pos(Pos::new(HPos::Center, VPos::Center));
    for azimuth in (0..360).step_by(30).map(f64::from) {
        let spoke = [place(azimuth, 0.0), place(azimuth, edge)];
        chart.draw_series(LineSeries::new(spoke, WHITE.stroke_width(SPOKE)))?;
        let label_place = place(azimuth, 1.08 * edge);
        chart.draw_series([Text::new(
            format!("{azimuth:.0}°"),
            label_place,
            text.clone(),
        )])?;
    }
    for ring in rings(edge) {
        chart.draw_series(LineSeries::new(circle(ring), WHITE.stroke_width(SPOKE)))?;
    }
    chart.draw_series(LineSeries::new(circle(edge), BLACK.stroke_width(THIN)))?;
    let (wide, high) = (offset_px(22), offset_px(13));
    for ring in rings(edge) {
        // On white: no one colour of text can be read on every band.
        let label = EmptyElement::at(place(75.0, ring))
            + Rectangle::new([(-wide, -high), (wide, high)], WHITE.filled())
            + Text::new(format!("{ring:.0}°"), (0, 0), text.clone());
        chart.draw_series([label])?;
    }
    Ok(())
}

/// Tilts to mark: every ten degrees or, in a small workspace, every five.
fn rings(edge: f64) -> impl Iterator<Item = f64> {
    let step = if edge > 15.0 { 10.0 } else { 5.0 };
    (1..)
        .map(move |i| step * f64::from(i))
        .take_while(move |tilt| *tilt <= edge)
}

fn circle(tilt_deg: f64) -> impl Iterator<Item = (f64, f64)> {
    (0..=180).map(move |step| place(2.0 * f64::from(step), tilt_deg))
}

/// Where a pose is, seen from above.
fn place(azimuth_deg: f64, tilt_deg: f64) -> (f64, f64) {
    let [x, y] = angles::unit_vector(azimuth_deg);
    (tilt_deg * x, tilt_deg * y)
}

/// Points as seen from above, with places between those that are far apart: a tilt all round is a circle there.
fn bent(points: &[(f64, f64)]) -> Vec<(f64, f64)> {
    let mut seen = Vec::new();
    for (from, to) in points.iter().zip(points.iter().skip(1)) {
        let steps = ((to.0 - from.0).abs() / ARC_DEG).ceil().max(1.0);
        let part = |step: u32| f64::from(step) / steps;
        let between = |part: f64| {
            (
                from.0 + (to.0 - from.0) * part,
                from.1 + (to.1 - from.1) * part,
            )
        };
        let places = (0..steps as u32).map(part).map(between);
        seen.extend(places.map(|(azimuth, tilt)| place(azimuth, tilt)));
    }
    seen.extend(points.last().map(|(azimuth, tilt)| place(*azimuth, *tilt)));
    seen
}
