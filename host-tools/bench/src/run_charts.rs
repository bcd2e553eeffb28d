//! The charts of a simulation: the tip, the tensions and the stiffness over time.

use leg_model_tools::plot::{self, Chart, ChartLine, PlotError};
use leg_sim::simulation::Sample;
use std::path::{Path, PathBuf};

/// A quantity of a sample, with its label; none where there is nothing to draw.
type Curve = (&'static str, fn(&Sample) -> Option<f64>);

/// One coordinate of the tip: what was commanded, what the trajectory asks for, what the leg estimates, and what is true.
macro_rules! tip_curves {
    ($axis:literal) => {
        [
            ("commanded", |sample| {
                Some(sample.comparison.tip_commanded_mm[$axis])
            }),
            ("reference", |sample| {
                Some(sample.comparison.tip_reference_mm[$axis])
            }),
            ("estimated", |sample| {
                let known = sample.telemetry.homed;
                known.then_some(sample.comparison.tip_estimated_mm[$axis])
            }),
            ("true", |sample| Some(sample.comparison.tip_true_mm[$axis])),
        ]
    };
}

/// The charts: file, axis title and curves.
const CHARTS: [(&str, &str, &[Curve]); 5] = [
    (
        "tip",
        "distance of the true tip (mm)",
        &[
            ("from the reference", |sample| {
                Some(sample.comparison.reference_error_mm())
            }),
            ("from the path", |sample| sample.path_error_mm),
        ],
    ),
    (
        "tip_towards_0",
        "tip towards azimuth 0° (mm)",
        &tip_curves!(0),
    ),
    (
        "tip_towards_90",
        "tip towards azimuth 90° (mm)",
        &tip_curves!(1),
    ),
    (
        "tensions",
        "true tension (N)",
        &[
            ("tendon 1", |sample| {
                Some(sample.comparison.tensions_true_n[0])
            }),
            ("tendon 2", |sample| {
                Some(sample.comparison.tensions_true_n[1])
            }),
            ("tendon 3", |sample| {
                Some(sample.comparison.tensions_true_n[2])
            }),
        ],
    ),
    (
        "stiffness",
        "bending stiffness (N·m/rad)",
        &[("estimated", |sample| {
            Some(f64::from(sample.telemetry.stiffness_nm_per_rad))
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
            .filter_map(|sample| Some((sample.time_s, quantity(sample)?)))
            .collect(),
        marks: Vec::new(),
    };
    let chart = |&(name, y_title, curves): &(&str, &str, &[Curve])| {
        let chart = Chart {
            title: title.into(),
            x_title: "time (s)".into(),
            y_title: y_title.into(),
            lines: curves
                .iter()
                .map(line)
                .filter(|line| !line.points.is_empty())
                .collect(),
            marks_label: String::new(),
        };
        plot::save_both(&chart, &directory.join(name))
    };
    CHARTS.iter().map(chart).collect()
}
