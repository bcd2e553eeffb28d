//! The charts of a simulation: the tip, the tensions and the stiffness over time.

use leg_model_tools::plot::{self, Chart, ChartLine, PlotError};
use leg_sim::simulation::Sample;
use std::path::{Path, PathBuf};

/// A quantity of a sample, with its label.
type Curve = (&'static str, fn(&Sample) -> f64);

/// The charts: file, axis title and curves.
const CHARTS: [(&str, &str, &[Curve]); 3] = [
    (
        "tip",
        "distance of the tip from its target (mm)",
        &[("tip", |sample| sample.tip_error_mm)],
    ),
    (
        "tensions",
        "tension (N)",
        &[
            ("tendon 1", |sample| sample.tensions_n[0]),
            ("tendon 2", |sample| sample.tensions_n[1]),
            ("tendon 3", |sample| sample.tensions_n[2]),
        ],
    ),
    (
        "stiffness",
        "bending stiffness (N·m/rad)",
        &[("as the leg reports", |sample| {
            f64::from(sample.telemetry.stiffness_nm_per_rad)
        })],
    ),
];

/// More points than this do not show in a chart.
const POINTS_MAX: usize = 1500;

/// Draws them, each as SVG and PNG, and names the SVG files.
///
/// # Errors
/// A chart that cannot be drawn or written.
pub fn save(title: &str, samples: &[Sample], directory: &Path) -> Result<Vec<PathBuf>, PlotError> {
    let line = |&(label, quantity): &Curve| ChartLine {
        label: label.into(),
        points: samples
            .iter()
            .step_by(samples.len().div_ceil(POINTS_MAX).max(1))
            .map(|sample| (sample.time_s, quantity(sample)))
            .collect(),
        marks: Vec::new(),
    };
    let chart = |&(name, y_title, curves): &(&str, &str, &[Curve])| {
        let chart = Chart {
            title: title.into(),
            x_title: "time (s)".into(),
            y_title: y_title.into(),
            lines: curves.iter().map(line).collect(),
            marks_label: String::new(),
        };
        plot::save_both(&chart, &directory.join(name))
    };
    CHARTS.iter().map(chart).collect()
}
