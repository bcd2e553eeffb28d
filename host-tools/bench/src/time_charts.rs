//! Charts of quantities over time, from one list of samples.

use leg_model_tools::plot::{self, Chart, ChartLine, PlotError};
use std::path::{Path, PathBuf};

/// A quantity of a sample, with its label; none where there is nothing to draw.
type Curve<S> = (&'static str, fn(&S) -> Option<f64>);

/// A chart.
pub(crate) struct TimeChart<S: 'static> {
    /// Of its files.
    pub name: &'static str,
    pub y_title: &'static str,
    pub curves: &'static [Curve<S>],
}

/// More points than this do not show in a chart.
const POINTS_MAX: usize = 1500;

/// Draws charts, each as SVG and PNG, and names the SVG files.
pub(crate) fn save<S>(
    charts: &[TimeChart<S>],
    title: &str,
    samples: &[S],
    time_s: fn(&S) -> f64,
    directory: &Path,
) -> Result<Vec<PathBuf>, PlotError> {
    let line = |&(label, quantity): &Curve<S>| ChartLine {
        label: label.into(),
        points: samples
            .iter()
            .step_by(samples.len().div_ceil(POINTS_MAX).max(1))
            .filter_map(|sample| Some((time_s(sample), quantity(sample)?)))
            .collect(),
        marks: Vec::new(),
    };
    let draw = |chart: &TimeChart<S>| {
        let lines = chart.curves.iter().map(line);
        let drawn = Chart {
            title: title.into(),
            x_title: "time (s)".into(),
            y_title: chart.y_title.into(),
            lines: lines.filter(|line| !line.points.is_empty()).collect(),
            marks_label: String::new(),
        };
        plot::save_both(&drawn, &directory.join(chart.name))
    };
    charts.iter().map(draw).collect()
}
