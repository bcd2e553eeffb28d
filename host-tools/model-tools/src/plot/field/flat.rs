//! Azimuth across, tilt upwards.

use super::PlotField;
use super::bands::Bands;
use super::isolines::{LINE_PX, isolines};
use super::runs::runs;
use crate::plot::canvas::{AXIS_TITLE_PX, Area, Drawn, LABEL_PX, MARGIN_PX};
use plotters::prelude::*;

pub(super) fn paint<B: DrawingBackend>(
    field: &PlotField,
    bands: &Bands,
    area: &Area<B>,
) -> Drawn<B> {
    let mut chart = ChartBuilder::on(area)
        .margin(MARGIN_PX)
        .set_label_area_size(LabelAreaPosition::Bottom, 70)
        .set_label_area_size(LabelAreaPosition::Left, 80)
        .build_cartesian_2d(0.0..360.0, 0.0..field.tilt_max_deg())?;
    let cells = runs(field, bands);
    chart.draw_series(cells.iter().map(|run| {
        let corners = [
            (run.azimuths_deg.0, run.tilts_deg.0),
            (run.azimuths_deg.1, run.tilts_deg.1),
        ];
        Rectangle::new(corners, run.shade.colour(bands).filled())
    }))?;
    for line in isolines(field, bands) {
        chart.draw_series(LineSeries::new(line, BLACK.stroke_width(LINE_PX)))?;
    }
    chart
        .configure_mesh()
        .disable_mesh()
        .axis_style(BLACK)
        .x_labels(19)
        .y_labels(7)
        .x_label_formatter(&|azimuth| format!("{azimuth:.0}"))
        .y_label_formatter(&|tilt| format!("{tilt:.0}"))
        .label_style(("sans-serif", LABEL_PX))
        .axis_desc_style(("sans-serif", AXIS_TITLE_PX))
        .x_desc("azimuth (°)")
        .y_desc("tilt (°)")
        .draw()
}
