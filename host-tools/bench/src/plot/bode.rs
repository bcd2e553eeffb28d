//! Bode plots: gain and phase over frequency.

use super::canvas::{
    self, AXIS_TITLE, Area, DrawResult, GRID, LABEL, MARGIN, Painter, THIN, TICK, WIDTH, offset_px,
    px, range,
};
use super::error::PlotError;
use super::{COLOURS, LEGEND_ROW, LEGEND_WIDTH, LINE};
use plotters::coord::combinators::LogCoord;
use plotters::coord::types::RangedCoordf64;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};
use std::ops::Range;
use std::path::{Path, PathBuf};

/// Colour of the lines that are not named.
const OTHERS: RGBColor = RGBColor(190, 190, 190);

/// Colour of the lines of margins: gain 1 and phase −180°.
const LIMIT: RGBColor = RGBColor(90, 90, 90);

/// Gains below are not drawn, dB.
const LOWEST_DB: f64 = -60.0;

/// A line's sample in the legend, and its label beside it.
const SAMPLE: i32 = offset_px(30);
const SAMPLE_LABEL: i32 = offset_px(40);

/// The phases of a plot, degrees: a loop becomes unstable at −180°, in the middle of what matters.
const PHASES_DEG: Range<f64> = -270.0..90.0;

/// What to draw.
#[derive(Clone, Debug, PartialEq)]
pub struct BodePlot {
    /// Above the plot.
    pub title: String,
    /// What the thin lines are, for the legend.
    pub others_label: String,
    /// All transfers, in thin lines.
    pub others: Vec<Vec<BodePoint>>,
    /// Those that are named, in thick lines.
    pub named: Vec<BodeLine>,
}

/// A point of a transfer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BodePoint {
    /// Hz.
    pub hz: f64,
    /// dB.
    pub gain_db: f64,
    /// Degrees, −180 to 180.
    pub phase_deg: f64,
}

/// A transfer with a margin.
#[derive(Clone, Debug, PartialEq)]
pub struct BodeLine {
    /// Lines of its text in the legend.
    pub label: Vec<String>,
    /// Its points, in the order of their frequencies.
    pub points: Vec<BodePoint>,
    /// The margin to mark.
    pub margin: Option<BodeMargin>,
}

/// A margin at a frequency, Hz.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum BodeMargin {
    /// Of the gain, dB.
    Gain(f64, f64),
    /// Of the phase, degrees.
    Phase(f64, f64),
}

/// Draws the plot as `stem.svg`, `stem.png` (1280 × 800 pixels) and `stem.pdf`, each whole or not at all, and names the first.
///
/// # Errors
/// A [`PlotError`] when there is nothing to draw or a file cannot be written.
pub fn save(plot: &BodePlot, stem: &Path) -> Result<PathBuf, PlotError> {
    let points = || plot.all().flatten();
    let (from, to) = range(points().map(|point| point.hz)).ok_or(PlotError::Empty)?;
    let gains = points().map(|point| point.gain_db.max(LOWEST_DB));
    let (low, high) = range(gains.chain([-20.0, 10.0])).ok_or(PlotError::Empty)?;
    if from >= to || from <= 0.0 {
        return Err(PlotError::Empty);
    }
    let painter = BodePainter {
        plot,
        hz: from..to,
        gains_db: low - 2.0..high + 2.0,
    };
    canvas::save(&painter, stem)
}

impl BodePlot {
    fn all(&self) -> impl Iterator<Item = &Vec<BodePoint>> {
        let named = self.named.iter().map(|line| &line.points);
        self.others.iter().chain(named)
    }
}

/// A plot whose axes are known.
struct BodePainter<'a> {
    plot: &'a BodePlot,
    hz: Range<f64>,
    gains_db: Range<f64>,
}

type Plane = Cartesian2d<LogCoord<f64>, RangedCoordf64>;

/// One of the two quantities.
#[derive(Clone, Copy, PartialEq)]
enum Panel {
    Gain,
    Phase,
}

impl Panel {
    fn value(self, point: &BodePoint) -> f64 {
        self.drawn(match self {
            Self::Gain => point.gain_db.max(LOWEST_DB),
            Self::Phase => turned(point.phase_deg),
        })
    }

    /// What is one on the axis: of phases a quarter of a turn, so that the labels are at multiples of it.
    const fn unit(self) -> f64 {
        match self {
            Self::Gain => 1.0,
            Self::Phase => 90.0,
        }
    }

    fn drawn(self, value: f64) -> f64 {
        value / self.unit()
    }

    /// Where the closed loop is at its limit.
    fn limit(self) -> f64 {
        self.drawn(match self {
            Self::Gain => 0.0,
            Self::Phase => -180.0,
        })
    }

    /// The ends of the line that marks a margin, if it is of this quantity.
    fn mark(self, line: &BodeLine) -> Option<[(f64, f64); 2]> {
        let (hz, to) = match (self, line.margin?) {
            (Self::Gain, BodeMargin::Gain(hz, margin)) => (hz, margin),
            (Self::Phase, BodeMargin::Phase(hz, margin)) => (hz, margin),
            _ => return None,
        };
        // On the side on which the curve is.
        let near = |point: &&BodePoint| (point.hz / hz).ln().abs();
        let nearest = line
            .points
            .iter()
            .min_by(|a, b| near(a).total_cmp(&near(b)))?;
        let side = (self.value(nearest) - self.limit()).signum();
        Some([
            (hz, self.limit()),
            (hz, self.limit() + side * self.drawn(to)),
        ])
    }
}

/// A phase within those that are drawn.
fn turned(phase_deg: f64) -> f64 {
    let from = PHASES_DEG.start;
    from + (phase_deg - from).rem_euclid(360.0)
}

impl Painter for BodePainter<'_> {
    fn paint<B: DrawingBackend>(&self, root: &Area<B>) -> DrawResult<B> {
        let body = canvas::titled(root, &self.plot.title)?;
        let (both, legend) = body.split_horizontally(WIDTH - LEGEND_WIDTH - MARGIN);
        let (_, height) = both.dim_in_pixel();
        let (gain, phase) = both.split_vertically(height / 2 - px(10));
        self.panel(&gain, Panel::Gain, "gain (dB)", "")?;
        self.panel(&phase, Panel::Phase, "phase (°)", "frequency (Hz)")?;
        self.legend(&legend)
    }
}

impl BodePainter<'_> {
    fn panel<B: DrawingBackend>(
        &self,
        area: &Area<B>,
        panel: Panel,
        y_title: &str,
        x_title: &str,
    ) -> DrawResult<B> {
        let (y, labels) = match panel {
            Panel::Gain => (self.gains_db.clone(), 9),
            Panel::Phase => (
                panel.drawn(PHASES_DEG.start)..panel.drawn(PHASES_DEG.end),
                5,
            ),
        };
        let mut context = ChartBuilder::on(area)
            .margin_right(MARGIN)
            .margin_top(px(8))
            .set_label_area_size(
                LabelAreaPosition::Bottom,
                if x_title.is_empty() { px(32) } else { px(66) },
            )
            .set_label_area_size(LabelAreaPosition::Left, px(90))
            .build_cartesian_2d(self.hz.clone().log_scale(), y)?;
        context
            .configure_mesh()
            .light_line_style(TRANSPARENT)
            .bold_line_style(GRID.stroke_width(THIN))
            .axis_style(BLACK.stroke_width(THIN))
            .set_all_tick_mark_size(TICK)
            .y_labels(labels)
            .y_label_formatter(&|value: &f64| format!("{:.0}", value * panel.unit()))
            .x_label_formatter(&|hz: &f64| format!("{hz}"))
            .label_style(("sans-serif", LABEL))
            .axis_desc_style(("sans-serif", AXIS_TITLE))
            .x_desc(x_title)
            .y_desc(y_title)
            .draw()?;
        for points in &self.plot.others {
            curve(points, panel, OTHERS.stroke_width(THIN), &mut context)?;
        }
        let limit = [self.hz.start, self.hz.end].map(|hz| (hz, panel.limit()));
        context.draw_series(LineSeries::new(limit, LIMIT.stroke_width(THIN)))?;
        for (line, colour) in self.plot.named.iter().zip(COLOURS.iter().cycle()) {
            curve(&line.points, panel, colour.stroke_width(LINE), &mut context)?;
        }
        for (line, colour) in self.plot.named.iter().zip(COLOURS.iter().cycle()) {
            if let Some(mark) = panel.mark(line) {
                context.draw_series(LineSeries::new(mark, BLACK.stroke_width(LINE)))?;
                let ends = mark.map(|end| Circle::new(end, px(6), colour.filled()));
                context.draw_series(ends)?;
            }
        }
        Ok(())
    }

    fn legend<B: DrawingBackend>(&self, area: &Area<B>) -> DrawResult<B> {
        let text = ("sans-serif", LABEL)
            .into_text_style(area)
            .pos(Pos::new(HPos::Left, VPos::Center));
        let mut y = LEGEND_ROW;
        for (line, colour) in self.plot.named.iter().zip(COLOURS.iter().cycle()) {
            let sample = vec![(0, y), (SAMPLE, y)];
            area.draw(&PathElement::new(sample, colour.stroke_width(LINE)))?;
            for words in &line.label {
                area.draw(&Text::new(words.as_str(), (SAMPLE_LABEL, y), text.clone()))?;
                y += LEGEND_ROW - offset_px(8);
            }
            y += offset_px(12);
        }
        area.draw(&PathElement::new(
            vec![(0, y), (SAMPLE, y)],
            OTHERS.stroke_width(THIN),
        ))?;
        area.draw(&Text::new(
            self.plot.others_label.as_str(),
            (SAMPLE_LABEL, y),
            text,
        ))
    }
}

/// A curve; where the phase leaves what is drawn it goes on at the other end.
fn curve<B: DrawingBackend>(
    points: &[BodePoint],
    panel: Panel,
    style: ShapeStyle,
    context: &mut ChartContext<B, Plane>,
) -> DrawResult<B> {
    let half = match panel {
        Panel::Gain => f64::INFINITY,
        Panel::Phase => panel.drawn(180.0),
    };
    let joined = |a: &BodePoint, b: &BodePoint| (panel.value(a) - panel.value(b)).abs() < half;
    for piece in points.chunk_by(joined) {
        let line = piece.iter().map(|point| (point.hz, panel.value(point)));
        context.draw_series(LineSeries::new(line, style))?;
    }
    Ok(())
}
