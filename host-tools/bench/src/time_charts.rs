//! Charts of quantities over time, from one list of samples, over the phases of the leg.

use crate::plot::{Chart, ChartLine, PlotError, Span};
use leg_base::description;
use leg_firmware::supervisor::State;
use leg_firmware::telemetry::Telemetry;
use std::path::{Path, PathBuf};

/// A quantity of a sample, with its label; none where there is nothing to draw.
type Curve<S> = (&'static str, fn(&S) -> Option<f64>);

/// A chart.
pub(crate) struct TimeChart<S: 'static> {
    /// Of its files.
    pub name: &'static str,
    /// Above it.
    pub title: &'static str,
    pub y_title: &'static str,
    pub curves: &'static [Curve<S>],
}

/// More points than this do not show in a chart of a leg that moves.
pub(crate) const POINTS_MAX: usize = 1600;

/// Draws charts, each as SVG, PNG and PDF, and names the SVG files; one of which nothing is known is left out, unless that is all of them.
/// `title` is that of the run, `at` gives time, s, and phase of a sample, if that is known: a state in words, or [`phase`]. Of more
/// samples than `points_max` some are left out evenly.
pub(crate) fn save<S>(
    charts: &[TimeChart<S>],
    title: &str,
    samples: &[S],
    points_max: usize,
    at: fn(&S) -> (f64, Option<&'static str>),
    directory: &Path,
) -> Result<Vec<PathBuf>, PlotError> {
    let line = |&(label, quantity): &Curve<S>| ChartLine {
        label: label.into(),
        points: samples
            .iter()
            .step_by(samples.len().div_ceil(points_max).max(1))
            .filter_map(|sample| Some((at(sample).0, quantity(sample)?)))
            .collect(),
        marks: Vec::new(),
    };
    let spans = phases(samples.iter().map(at));
    let fill = |chart: &TimeChart<S>| {
        let lines = chart.curves.iter().map(line);
        let filled = Chart {
            title: chart.title.into(),
            subtitle: title.into(),
            x_title: "time (s)".into(),
            y_title: chart.y_title.into(),
            lines: lines.filter(|line| !line.points.is_empty()).collect(),
            spans: spans.clone(),
            ..Chart::default()
        };
        (chart.name, filled)
    };
    let mut drawn: Vec<_> = charts.iter().map(fill).collect();
    drawn.retain(|(_, chart)| !chart.lines.is_empty());
    if drawn.is_empty() {
        return Err(PlotError::Empty);
    }
    let save = |(name, chart): &(&str, Chart)| crate::plot::save(chart, &directory.join(name));
    drawn.iter().map(save).collect()
}

const MOVING: &str = "moving";

/// Every phase: each has its own shade, the same in all charts.
const PHASES: [&str; 10] = [
    description::state(State::Boot),
    description::state(State::Disarmed),
    description::state(State::Homing),
    description::state(State::Active),
    MOVING,
    description::state(State::Held),
    description::state(State::KeepingStation),
    description::state(State::RampingDown),
    description::state(State::Off),
    description::state(State::Jogging),
];

/// The state of a leg in words; where its trajectory moves, that.
pub(crate) const fn phase(report: &Telemetry<f32>) -> &'static str {
    match (report.state, report.moving) {
        (State::Active, true) => MOVING,
        (state, _) => description::state(state),
    }
}

/// The number of a phase's shade.
fn shade(label: &str) -> usize {
    let found = PHASES.iter().position(|phase| *phase == label);
    found.unwrap_or(PHASES.len())
}

/// The spans of time in which a leg is in one phase.
fn phases(samples: impl Iterator<Item = (f64, Option<&'static str>)>) -> Vec<Span> {
    let mut spans: Vec<Span> = Vec::new();
    for (time_s, phase) in samples {
        let Some(label) = phase else { continue };
        if let Some(last) = spans.last_mut() {
            last.x.end = time_s;
        }
        if spans.last().is_none_or(|last| last.label != label) {
            spans.push(Span {
                label: label.into(),
                shade: shade(label),
                x: time_s..time_s,
            });
        }
    }
    spans
}
