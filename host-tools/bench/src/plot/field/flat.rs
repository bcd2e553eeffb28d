//! Azimuth across, tilt upwards.

use super::bands::Bands;
use super::layers::{Layer, layers};
use super::{LINE, PlotField};
use crate::plot::canvas::{AXIS_TITLE, Area, DrawResult, LABEL, MARGIN, THIN, TICK, px};
use plotters::prelude::*;

pub(super) fn paint<B: DrawingBackend>(
    field: &PlotField,
    bands: &Bands,
    area: &Area<B>,
) -> DrawResult<B> {
    let mut chart = ChartBuilder::on(area)
        .margin(MARGIN)
        .set_label_area_size(LabelAreaPosition::Bottom, px(70))
        .set_label_area_size(LabelAreaPosition::Left, px(80))
        .build_cartesian_2d(0.0..360.0, 0.0..field.tilt_max_deg())?;
    for layer in layers(field, bands) {
        match layer {
            Layer::Area(outline, colour) => {
                chart.draw_series([Polygon::new(outline, colour.filled())])?;
            }
            Layer::Line(points) => {
                chart.draw_series(LineSeries::new(points, BLACK.stroke_width(LINE)))?;
            }
        }
    }
    chart
        .configure_mesh()
        .disable_mesh()
        .axis_style(BLACK.stroke_width(THIN))
        .set_all_tick_mark_size(TICK)
        .x_labels(19)
        .y_labels(7)
        .x_label_formatter(&|azimuth| format!("{azimuth:.0}"))
        .y_label_formatter(&|tilt| format!("{tilt:.0}"))
        .label_style(("sans-serif", LABEL))
        .axis_desc_style(("sans-serif", AXIS_TITLE))
        .x_desc("azimuth (°)")
        .y_desc("tilt (°)")
        .draw()
}
