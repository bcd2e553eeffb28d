//! Pictures as SVG, PNG and PDF: line charts ([`Chart`]), maps of the workspace ([`field::PlotField`]) and Bode plots
//! ([`bode::BodePlot`]).

pub mod bode;
mod canvas;
mod error;
pub mod field;
mod picture;
mod spans;

pub use error::PlotError;
pub use spans::Span;

use canvas::{
    AXIS_TITLE, Area, DrawResult, GRID, LABEL, MARGIN, Painter, THIN, TICK, WIDTH, offset_px, px,
    range,
};
use leg_base::rounding::rounded;
use plotters::coord::ranged1d::BoldPoints;
use plotters::coord::types::RangedCoordf64;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};
use std::ops::Range;
use std::path::{Path, PathBuf};

const LEGEND_WIDTH: u32 = px(260);
const LEGEND_ROW: i32 = offset_px(36);
/// A line's sample in the legend, and its label beside it.
const SAMPLE: i32 = offset_px(40);
const SAMPLE_LABEL: i32 = offset_px(52);
/// Height of a shade's sample.
const SHADE_HEIGHT: i32 = offset_px(24);
const LINE: u32 = px(3);
/// Least room left of the vertical axis.
const LEFT_ROOM: u32 = px(90);
/// The two arms of a mark.
const MARK_ARMS: [[(i32, i32); 2]; 2] = {
    let (long, short) = (offset_px(10), offset_px(3) / 2);
    [
        [(-long, -short), (long, short)],
        [(-short, -long), (short, long)],
    ]
};

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

/// Draws the chart as `stem.svg`, `stem.png` (1280 × 800 pixels) and `stem.pdf`, each whole or not at all, and names the first.
///
/// # Errors
/// A [`PlotError`] when there is nothing to draw or a file cannot be written.
pub fn save(chart: &Chart, stem: &Path) -> Result<PathBuf, PlotError> {
    let ranges = axis_ranges(chart)?;
    canvas::save(&ChartPainter { chart, ranges }, stem)
}

/// A chart whose axes are known.
struct ChartPainter<'a> {
    chart: &'a Chart,
    /// Of the horizontal axis and of the vertical one.
    ranges: [Range<f64>; 2],
}

impl Painter for ChartPainter<'_> {
    fn paint<B: DrawingBackend>(&self, root: &Area<B>) -> DrawResult<B> {
        let Self { chart, ranges } = self;
        let mut body = canvas::titled(root, &chart.title)?;
        if !chart.subtitle.is_empty() {
            body = body.titled(&chart.subtitle, ("sans-serif", AXIS_TITLE))?;
        }
        let (plot, legend) = body.split_horizontally(WIDTH - LEGEND_WIDTH - MARGIN);
        let [x, y] = ranges.clone();
        let mut context = ChartBuilder::on(&plot)
            .margin(MARGIN)
            .set_label_area_size(LabelAreaPosition::Bottom, px(70))
            .set_label_area_size(LabelAreaPosition::Left, left_room(&plot, &y)?)
            .build_cartesian_2d(x, y.clone())?;
        spans::shade(&chart.spans, &y, &mut context)?;
        draw_axes(chart, &mut context)?;
        for (line, colour) in chart.lines.iter().zip(COLOURS.iter().cycle()) {
            draw_line(line, colour, &mut context)?;
        }
        spans::label(&chart.spans, &y, &mut context)?;
        draw_legend(chart, &ranges[0], &legend)
    }
}

type Plane = Cartesian2d<RangedCoordf64, RangedCoordf64>;

/// Most labels of the vertical axis.
const Y_LABELS: usize = 11;

/// A number beside an axis.
fn label(value: &f64) -> String {
    rounded(*value, 6).to_string()
}

/// Room left of the vertical axis: for its title, and the widest label beside that.
fn left_room<B: DrawingBackend>(
    area: &Area<B>,
    y: &Range<f64>,
) -> Result<u32, DrawingAreaErrorKind<B::ErrorType>> {
    let text = ("sans-serif", LABEL).into_text_style(area);
    let axis = RangedCoordf64::from(y.clone());
    let mut widest = 0;
    for value in axis.key_points(BoldPoints(Y_LABELS)) {
        let (width, _) = area.estimate_text_size(&label(&value), &text)?;
        widest = widest.max(width);
    }
    Ok(LEFT_ROOM.max(AXIS_TITLE + px(5) + widest + 2 * TICK))
}

fn draw_axes<B: DrawingBackend>(
    chart: &Chart,
    context: &mut ChartContext<B, Plane>,
) -> DrawResult<B> {
    context
        .configure_mesh()
        .light_line_style(TRANSPARENT)
        .bold_line_style(GRID.stroke_width(THIN))
        .axis_style(BLACK.stroke_width(THIN))
        .set_all_tick_mark_size(TICK)
        .x_labels(13)
        .y_labels(Y_LABELS)
        .x_label_formatter(&label)
        .y_label_formatter(&label)
        .label_style(("sans-serif", LABEL))
        .axis_desc_style(("sans-serif", AXIS_TITLE))
        .x_desc(&chart.x_title)
        .y_desc(&chart.y_title)
        .draw()
}

fn draw_line<B: DrawingBackend>(
    line: &ChartLine,
    colour: &RGBColor,
    context: &mut ChartContext<B, Plane>,
) -> DrawResult<B> {
    let points = line.points.iter().copied();
    context.draw_series(LineSeries::new(points, colour.stroke_width(LINE)))?;
    for arm in MARK_ARMS {
        let arm_at = |&mark| EmptyElement::at(mark) + Rectangle::new(arm, colour.filled());
        context.draw_series(line.marks.iter().map(arm_at))?;
    }
    Ok(())
}

fn draw_legend<B: DrawingBackend>(chart: &Chart, x: &Range<f64>, area: &Area<B>) -> DrawResult<B> {
    let text = ("sans-serif", LABEL)
        .into_text_style(area)
        .pos(Pos::new(HPos::Left, VPos::Center));
    let mut y = LEGEND_ROW;
    for (line, colour) in chart.lines.iter().zip(COLOURS.iter().cycle()) {
        let sample = vec![(0, y), (SAMPLE, y)];
        area.draw(&PathElement::new(sample, colour.stroke_width(LINE)))?;
        area.draw(&Text::new(
            line.label.as_str(),
            (SAMPLE_LABEL, y),
            text.clone(),
        ))?;
        y += LEGEND_ROW;
    }
    if chart.lines.iter().any(|line| !line.marks.is_empty()) {
        for arm in MARK_ARMS {
            area.draw(&(EmptyElement::at((SAMPLE / 2, y)) + Rectangle::new(arm, BLACK.filled())))?;
        }
        area.draw(&Text::new(
            chart.marks_label.as_str(),
            (SAMPLE_LABEL, y),
            text.clone(),
        ))?;
        y += LEGEND_ROW;
    }
    for (label, shade) in spans::seen(&chart.spans, x) {
        let sample = [(0, y - SHADE_HEIGHT / 2), (SAMPLE, y + SHADE_HEIGHT / 2)];
        area.draw(&Rectangle::new(sample, shade.filled()))?;
        area.draw(&Text::new(label, (SAMPLE_LABEL, y), text.clone()))?;
        y += LEGEND_ROW;
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
