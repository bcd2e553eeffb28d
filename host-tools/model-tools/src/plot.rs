//! Line charts as SVG and PNG.

pub mod bode;
mod canvas;
pub mod field;
mod spans;

pub use canvas::PlotError;
pub use spans::Span;

use canvas::{AXIS_TITLE_PX, Area, Drawn, GRID, LABEL_PX, MARGIN_PX, Painter, WIDTH_PX, range};
use plotters::coord::types::RangedCoordf64;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};
use std::ops::Range;
use std::path::{Path, PathBuf};

const LEGEND_WIDTH_PX: u32 = 260;
const LEGEND_ROW_PX: i32 = 36;
const LINE_PX: u32 = 3;
/// A line turns back where it goes on by more than 154° from how it came: beyond that, the joint of two strokes of [`LINE_PX`] reaches
/// more than twice their width.
const SHARP_COS: f64 = 0.9;
/// The two arms of a mark: rectangles along the pixels, so that a bitmap keeps them sharp.
const MARK_ARMS_PX: [[(i32, i32); 2]; 2] = [[(-10, -1), (10, 1)], [(-1, -10), (1, 10)]];

/// Okabe and Ito's colours, in an order that stays distinct for the colour-blind.
const COLOURS: [RGBColor; 6] = [
    RGBColor(0, 114, 178),
    RGBColor(230, 159, 0),
    RGBColor(0, 158, 115),
    RGBColor(213, 94, 0),
    RGBColor(204, 121, 167),
    RGBColor(86, 180, 233),
];

/// What to draw. Titles carry their units.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Chart {
    /// Above the chart.
    pub title: String,
    /// Under the title, smaller; none if it is empty.
    pub subtitle: String,
    /// Under the horizontal axis.
    pub x_title: String,
    /// Beside the vertical axis.
    pub y_title: String,
    /// The lines, in the legend's order.
    pub lines: Vec<ChartLine>,
    /// What the lines' marks mean, for the legend; left out when no line has any.
    pub marks_label: String,
    /// Shaded spans of the horizontal axis, in their order.
    pub spans: Vec<Span>,
}

/// One line of a [`Chart`].
#[derive(Clone, Debug, PartialEq)]
pub struct ChartLine {
    /// Its name in the legend.
    pub label: String,
    /// Its points (x, y), in the order in which they are joined.
    pub points: Vec<(f64, f64)>,
    /// Points (x, y) to mark in its colour with a cross: what it is compared with.
    pub marks: Vec<(f64, f64)>,
}

/// Draws the chart as `stem.svg` and `stem.png` (1280 × 800 pixels), each whole or not at all, and names the first.
///
/// # Errors
/// A [`PlotError`] when there is nothing to draw or a file cannot be written.
pub fn save_both(chart: &Chart, stem: &Path) -> Result<PathBuf, PlotError> {
    let ranges = axis_ranges(chart)?;
    canvas::save_both(&ChartPainter { chart, ranges }, stem)
}

/// A chart whose axes are known.
struct ChartPainter<'a> {
    chart: &'a Chart,
    /// Of the horizontal axis and of the vertical one.
    ranges: [Range<f64>; 2],
}

impl Painter for ChartPainter<'_> {
    fn paint<B: DrawingBackend>(&self, root: &Area<B>) -> Drawn<B> {
        let Self { chart, ranges } = self;
        let mut body = canvas::titled(root, &chart.title)?;
        if !chart.subtitle.is_empty() {
            body = body.titled(&chart.subtitle, ("sans-serif", AXIS_TITLE_PX))?;
        }
        let (plot, legend) = body.split_horizontally(WIDTH_PX - LEGEND_WIDTH_PX - MARGIN_PX);
        let [x, y] = ranges.clone();
        let mut context = ChartBuilder::on(&plot)
            .margin(MARGIN_PX)
            .set_label_area_size(LabelAreaPosition::Bottom, 70)
            .set_label_area_size(LabelAreaPosition::Left, 90)
            .build_cartesian_2d(x, y.clone())?;
        spans::shade(&chart.spans, &y, &mut context)?;
        draw_axes(chart, &mut context)?;
        for (line, colour) in chart.lines.iter().zip(COLOURS.iter().cycle()) {
            draw_line(line, colour, &mut context)?;
        }
        spans::label(&chart.spans, &y, &mut context)?;
        draw_legend(chart, &legend)
    }
}

type Plane = Cartesian2d<RangedCoordf64, RangedCoordf64>;

fn draw_axes<B: DrawingBackend>(chart: &Chart, context: &mut ChartContext<B, Plane>) -> Drawn<B> {
    let label = |value: &f64| format!("{}", (value * 1e6).round() / 1e6 + 0.0);
    context
        .configure_mesh()
        .light_line_style(TRANSPARENT)
        .bold_line_style(GRID)
        .axis_style(BLACK)
        .x_labels(13)
        .y_labels(11)
        .x_label_formatter(&label)
        .y_label_formatter(&label)
        .label_style(("sans-serif", LABEL_PX))
        .axis_desc_style(("sans-serif", AXIS_TITLE_PX))
        .x_desc(&chart.x_title)
        .y_desc(&chart.y_title)
        .draw()
}

fn draw_line<B: DrawingBackend>(
    line: &ChartLine,
    colour: &RGBColor,
    context: &mut ChartContext<B, Plane>,
) -> Drawn<B> {
    let stroke = colour.stroke_width(LINE_PX);
    let pixels = line.points.iter().map(|point| context.backend_coord(point));
    let turns = sharp_turns(&pixels.collect::<Vec<_>>());
    let mut begin = 0;
    for end in turns.into_iter().chain([line.points.len()]) {
        // The point of a turn belongs to both pieces.
        let piece = line.points.iter().take(end + 1).skip(begin);
        context.draw_series(LineSeries::new(piece.copied(), stroke))?;
        begin = end;
    }
    for arm in MARK_ARMS_PX {
        let arm_at = |&mark| EmptyElement::at(mark) + Rectangle::new(arm, colour.filled());
        context.draw_series(line.marks.iter().map(arm_at))?;
    }
    Ok(())
}

/// The points, by number, at which a line all but turns back. A bitmap's joint would reach far beyond such a point, and show a value
/// that is not there: the line is drawn in pieces.
fn sharp_turns(pixels: &[(i32, i32)]) -> Vec<usize> {
    let turns_back = |&[a, b, c]: &[(i32, i32); 3]| {
        let [came, goes] =
            [(b, a), (c, b)].map(|(to, from)| [to.0 - from.0, to.1 - from.1].map(f64::from));
        let along = came[0] * goes[0] + came[1] * goes[1];
        along < -SHARP_COS * came[0].hypot(came[1]) * goes[0].hypot(goes[1])
    };
    // Points on the same pixel tell no direction.
    let mut distinct: Vec<_> = pixels.iter().copied().enumerate().collect();
    distinct.dedup_by_key(|(_, pixel)| *pixel);
    let corners = distinct.windows(3).filter(|corner| match corner {
        [a, b, c] => turns_back(&[a.1, b.1, c.1]),
        _ => false,
    });
    corners
        .filter_map(|corner| corner.get(1).map(|(at, _)| *at))
        .collect()
}

fn draw_legend<B: DrawingBackend>(chart: &Chart, area: &Area<B>) -> Drawn<B> {
    let text = ("sans-serif", LABEL_PX)
        .into_text_style(area)
        .pos(Pos::new(HPos::Left, VPos::Center));
    let mut y = LEGEND_ROW_PX;
    for (line, colour) in chart.lines.iter().zip(COLOURS.iter().cycle()) {
        let sample = vec![(0, y), (40, y)];
        area.draw(&PathElement::new(sample, colour.stroke_width(LINE_PX)))?;
        area.draw(&Text::new(line.label.as_str(), (52, y), text.clone()))?;
        y += LEGEND_ROW_PX;
    }
    if chart.lines.iter().any(|line| !line.marks.is_empty()) {
        for arm in MARK_ARMS_PX {
            area.draw(&(EmptyElement::at((20, y)) + Rectangle::new(arm, BLACK.filled())))?;
        }
        area.draw(&Text::new(chart.marks_label.as_str(), (52, y), text))?;
    }
    Ok(())
}

/// The axes take in every point and mark, y = 0 as well, with some room above; the horizontal one the spans, too.
fn axis_ranges(chart: &Chart) -> Result<[Range<f64>; 2], PlotError> {
    let points = |line: &ChartLine| [line.points.as_slice(), line.marks.as_slice()].concat();
    let all: Vec<(f64, f64)> = chart.lines.iter().flat_map(points).collect();
    if all.is_empty() {
        return Err(PlotError::Empty);
    }
    let ends = chart
        .spans
        .iter()
        .flat_map(|span| [span.x.start, span.x.end]);
    let x = range(all.iter().map(|point| point.0).chain(ends)).ok_or(PlotError::Empty)?;
    let y = range(all.iter().map(|point| point.1).chain([0.0])).ok_or(PlotError::Empty)?;
    if x.0 >= x.1 {
        return Err(PlotError::Empty);
    }
    let labelled = if chart.spans.is_empty() {
        0.0
    } else {
        spans::LABEL_PART
    };
    let room = (0.06 + labelled) * (y.1 - y.0);
    let top = if room > 0.0 { y.1 + room } else { 1.0 };
    Ok([x.0..x.1, y.0..top])
}

#[cfg(test)]
mod tests;
