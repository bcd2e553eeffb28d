//! The colours of a map with the levels between them: those of its lines.

use super::bands::Bands;
use super::layers::{BORDER, EXTERIOR, NO_RESULT};
use super::{PlotField, PoseSample};
use crate::plot::canvas::{Area, DrawResult, LABEL, THIN, offset_px, px};
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

pub(super) const SCALE_WIDTH: u32 = px(310);
const LEFT: i32 = offset_px(30);
const BAR: i32 = offset_px(36);
const TOP: i32 = offset_px(80);
/// Below the bar, for what has no colour.
const LEGEND: i32 = offset_px(130);
const LINE: i32 = offset_px(32);
/// Between a colour and its words.
const GAP: i32 = offset_px(10);

pub(super) fn paint<B: DrawingBackend>(
    field: &PlotField,
    bands: &Bands,
    area: &Area<B>,
) -> DrawResult<B> {
    let heading = [(&field.quantity, 1), (&field.unit, 0)];
    for (words, lines_above) in heading {
        let y = TOP - offset_px(26) - LINE * lines_above;
        area.draw(&Text::new(words.as_str(), (LEFT, y), text(area)))?;
    }
    let (_, height) = area.dim_in_pixel();
    let step = (height as i32 - TOP - LEGEND) / bands.count().max(1) as i32;
    let bottom = TOP + step * bands.count() as i32;
    for band in 0..bands.count() {
        let y = bottom - step * band as i32;
        let corners = [(LEFT, y - step), (LEFT + BAR, y)];
        area.draw(&Rectangle::new(corners, bands.colour(band).filled()))?;
        area.draw(&Rectangle::new(corners, BLACK.stroke_width(THIN)))?;
    }
    for (level, label) in bands.labels().iter().enumerate() {
        label_at(area, label, bottom - step * level as i32)?;
    }
    paint_legend(field, area, bottom)
}

/// What has no colour, if there is any of it.
fn paint_legend<B: DrawingBackend>(
    field: &PlotField,
    area: &Area<B>,
    bottom: i32,
) -> DrawResult<B> {
    let any = |is: fn(&PoseSample) -> bool| field.samples.iter().flatten().any(is);
    let no_value = |sample: &PoseSample| sample.room >= 0.0 && sample.value.is_none();
    let no_result = any(no_value) || field.samples.iter().any(Option::is_none);
    let entries = [
        (
            any(PoseSample::is_border),
            BORDER,
            field.border_label.as_str(),
        ),
        (
            any(PoseSample::is_exterior),
            EXTERIOR,
            field.exterior_label.as_str(),
        ),
        (no_result, NO_RESULT, "no result"),
    ];
    let shown = entries.into_iter().filter(|(shown, ..)| *shown);
    for ((_, colour, words), line) in shown.zip(0..) {
        let y = bottom + offset_px(45) + (LINE + offset_px(4)) * line;
        let half = offset_px(12);
        let corners = [(LEFT, y - half), (LEFT + BAR, y + half)];
        area.draw(&Rectangle::new(corners, colour.filled()))?;
        label_at(area, words, y)?;
    }
    Ok(())
}

fn label_at<B: DrawingBackend>(area: &Area<B>, words: &str, y: i32) -> DrawResult<B> {
    area.draw(&Text::new(words, (LEFT + BAR + GAP, y), text(area)))
}

fn text<B: DrawingBackend>(area: &Area<B>) -> TextStyle<'static> {
    ("sans-serif", LABEL)
        .into_text_style(area)
        .pos(Pos::new(HPos::Left, VPos::Center))
}

/// How much room a text leaves beside the map, px: above the scale, or in its legend.
#[cfg(test)]
pub(super) fn room_px(words: &str, in_legend: bool) -> i32 {
    if crate::plot::canvas::provide_font().is_err() {
        return i32::MIN;
    }
    let mut svg = String::new();
    let area = SVGBackend::with_string(&mut svg, (1, 1)).into_drawing_area();
    let width = area
        .estimate_text_size(words, &text(&area))
        .map_or(i32::MAX, |(width, _)| width as i32);
    let colour = if in_legend { BAR + GAP } else { 0 };
    (SCALE_WIDTH as i32 - LEFT - colour - width) / offset_px(1)
}
