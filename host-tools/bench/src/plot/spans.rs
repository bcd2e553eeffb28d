//! Spans of a chart's horizontal axis: shaded and labelled, as the states of a leg over time.

use super::Plane;
use super::canvas::{DrawResult, offset_px, px};
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};
use std::ops::Range;

/// A span of the horizontal axis.
#[derive(Clone, Debug, PartialEq)]
pub struct Span {
    /// Written at its top, where there is room, and beside its shade in the legend.
    pub label: String,
    /// The number of its shade. Spans with the same label have the same one.
    pub shade: usize,
    /// Its begin and end.
    pub x: Range<f64>,
}

/// Light enough for lines and labels on them.
const SHADES: [RGBColor; 10] = [
    RGBColor(242, 242, 242),
    RGBColor(253, 243, 224),
    RGBColor(230, 245, 239),
    RGBColor(230, 240, 250),
    RGBColor(250, 233, 226),
    RGBColor(247, 236, 243),
    RGBColor(226, 243, 245),
    RGBColor(240, 242, 222),
    RGBColor(232, 232, 236),
    RGBColor(238, 235, 250),
];

const SPAN_LABEL: u32 = px(18);
/// Not black with less of it: a page lists what is transparent in an order of its own each time.
const SPAN_LABEL_COLOUR: RGBColor = RGBColor(95, 95, 95);

/// Width of a letter at most, on the average.
const LETTER: i32 = offset_px(10);

/// Part of the horizontal axis from which on a shade is seen: some two pixels.
const SEEN_PART: f64 = 0.002;

/// Part of the vertical axis that the labels take.
pub(super) const LABEL_PART: f64 = 0.06;

/// Each label once, with its shade, in the order of the spans.
fn shades(spans: &[Span]) -> Vec<(&str, RGBColor)> {
    let mut shades: Vec<(&str, RGBColor)> = Vec::new();
    for span in spans {
        if shades.iter().all(|(label, _)| *label != span.label) {
            shades.push((&span.label, SHADES[span.shade % SHADES.len()]));
        }
    }
    shades
}

/// The same for the legend: without those that are too short to be seen.
pub(super) fn seen<'a>(spans: &'a [Span], x: &Range<f64>) -> Vec<(&'a str, RGBColor)> {
    let mut seen = shades(spans);
    seen.retain(|(label, _)| {
        let of_label = spans.iter().filter(|span| span.label == *label);
        let length: f64 = of_label.map(|span| span.x.end - span.x.start).sum();
        length >= SEEN_PART * (x.end - x.start)
    });
    seen
}

/// Shades the spans, up to the top of the vertical axis. Draw it first.
pub(super) fn shade<B: DrawingBackend>(
    spans: &[Span],
    y: &Range<f64>,
    context: &mut ChartContext<B, Plane>,
) -> DrawResult<B> {
    let shades = shades(spans);
    for span in spans {
        let shade = shades.iter().find(|(label, _)| *label == span.label);
        let shade = shade.map_or(WHITE, |(_, shade)| *shade);
        let corners = [(span.x.start, y.start), (span.x.end, y.end)];
        context.draw_series([Rectangle::new(corners, shade.filled())])?;
    }
    Ok(())
}

/// Writes the labels of the spans that have room for them.
pub(super) fn label<B: DrawingBackend>(
    spans: &[Span],
    y: &Range<f64>,
    context: &mut ChartContext<B, Plane>,
) -> DrawResult<B> {
    let style = ("sans-serif", SPAN_LABEL)
        .into_font()
        .color(&SPAN_LABEL_COLOUR)
        .pos(Pos::new(HPos::Center, VPos::Top));
    let top = y.end - 0.01 * (y.end - y.start);
    for span in spans {
        let [begin, end] = [span.x.start, span.x.end].map(|x| context.backend_coord(&(x, top)).0);
        let width = LETTER * span.label.chars().count() as i32;
        if end - begin >= width {
            let middle = (span.x.start + span.x.end) / 2.0;
            let text = Text::new(span.label.clone(), (middle, top), style.clone());
            context.draw_series([text])?;
        }
    }
    Ok(())
}
