//! From above: azimuth round, tilt outwards.

use super::PlotField;
use super::bands::Bands;
use super::isolines::{LINE_PX, isolines};
use super::runs::{Run, runs};
use crate::plot::canvas::{Area, Drawn, LABEL_PX};
use leg_base::angles;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

/// Room for the labels round the map, in parts of its radius.
const ROOM: f64 = 1.14;

/// A piece of a circle is drawn in steps of this, degrees.
const ARC_DEG: f64 = 2.0;

/// How far a piece reaches under the next, in parts of the radius.
const OVERLAP: f64 = 0.006;

pub(super) fn paint<B: DrawingBackend>(
    field: &PlotField,
    bands: &Bands,
    area: &Area<B>,
) -> Drawn<B> {
    let edge = field.tilt_max_deg();
    let (width, height) = area.dim_in_pixel();
    let side = width.min(height);
    let (left, top) = ((width - side) / 2, (height - side) / 2);
    let square = area.margin(top, height - side - top, left, width - side - left);
    let reach = -ROOM * edge..ROOM * edge;
    let mut chart = ChartBuilder::on(&square).build_cartesian_2d(reach.clone(), reach)?;
    for run in runs(field, bands) {
        // The next row paints over what is too much: no gaps between the pieces.
        let run = Run {
            tilts_deg: (
                run.tilts_deg.0,
                (run.tilts_deg.1 + OVERLAP * edge).min(edge),
            ),
            ..run
        };
        let colour = run.shade.colour(bands);
        chart.draw_series([Polygon::new(sector(&run), colour.filled())])?;
    }
    for line in isolines(field, bands) {
        let points = line.into_iter().map(|(azimuth, tilt)| place(azimuth, tilt));
        chart.draw_series(LineSeries::new(points, BLACK.stroke_width(LINE_PX)))?;
    }
    let text = ("sans-serif", LABEL_PX)
        .into_text_style(area)
        .pos(Pos::new(HPos::Center, VPos::Center));
    for azimuth in (0..360).step_by(30).map(f64::from) {
        let spoke = [place(azimuth, 0.0), place(azimuth, edge)];
        chart.draw_series(LineSeries::new(spoke, WHITE.mix(0.5).stroke_width(1)))?;
        let label_place = place(azimuth, 1.08 * edge);
        chart.draw_series([Text::new(
            format!("{azimuth:.0}°"),
            label_place,
            text.clone(),
        )])?;
    }
    for ring in rings(edge) {
        chart.draw_series(LineSeries::new(
            circle(ring),
            WHITE.mix(0.5).stroke_width(1),
        ))?;
    }
    chart.draw_series(LineSeries::new(circle(edge), BLACK.stroke_width(1)))?;
    for ring in rings(edge) {
        // On white: no one colour of text can be read on every band.
        let label = EmptyElement::at(place(75.0, ring))
            + Rectangle::new([(-22, -13), (22, 13)], WHITE.mix(0.85).filled())
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

/// The outline of a run: along its outer arc and back along the inner one.
fn sector(run: &Run) -> Vec<(f64, f64)> {
    let (first, last) = run.azimuths_deg;
    let steps = ((last - first) / ARC_DEG).ceil().max(1.0) as usize;
    let azimuth = |step: usize| first + (last - first) * step as f64 / steps as f64;
    let (inside, outside) = run.tilts_deg;
    let outer = (0..=steps).map(|step| place(azimuth(step), outside));
    let inner = (0..=steps).rev().map(|step| place(azimuth(step), inside));
    outer.chain(inner).collect()
}
