//! The charts of a simulation: the tip, the tensions and the stiffness over time; and those of a leg's telemetry.

use crate::time_charts::{self, TimeChart};
use leg_firmware::telemetry::Telemetry;
use leg_model_tools::plot::PlotError;
use leg_sim::simulation::Sample;
use std::path::{Path, PathBuf};

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

const SIMULATION: [TimeChart<Sample>; 5] = [
    TimeChart {
        name: "tip",
        y_title: "distance of the true tip (mm)",
        curves: &[
            ("from the reference", |sample| {
                Some(sample.comparison.reference_error_mm())
            }),
            ("from the path", |sample| sample.comparison.path_error_mm),
        ],
    },
    TimeChart {
        name: "tip_towards_0",
        y_title: "tip towards azimuth 0° (mm)",
        curves: &tip_curves!(0),
    },
    TimeChart {
        name: "tip_towards_90",
        y_title: "tip towards azimuth 90° (mm)",
        curves: &tip_curves!(1),
    },
    TimeChart {
        name: "tensions",
        y_title: "true tension (N)",
        curves: &[
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
    },
    TimeChart {
        name: "stiffness",
        y_title: "bending stiffness (N·m/rad)",
        curves: &[("estimated", |sample| {
            Some(f64::from(sample.telemetry.stiffness_nm_per_rad))
        })],
    },
];

/// What a leg reports at a time, s.
type Report = (f64, Telemetry<f32>);

/// Tilt of a direction by its horizontal components, degrees.
fn tilt_deg([x, y]: [f32; 2]) -> f64 {
    f64::from(x)
        .hypot(f64::from(y))
        .min(1.0)
        .asin()
        .to_degrees()
}

const LOG: [TimeChart<Report>; 4] = [
    TimeChart {
        name: "tilt",
        y_title: "tilt (°)",
        curves: &[
            ("reference", |(_, report)| Some(tilt_deg(report.target))),
            ("estimated", |(_, report)| {
                report.homed.then(|| tilt_deg(report.pose))
            }),
        ],
    },
    TimeChart {
        name: "tensions",
        y_title: "measured tension (N)",
        curves: &[
            ("tendon 1", |(_, report)| Some(report.tensions_n[0].into())),
            ("tendon 2", |(_, report)| Some(report.tensions_n[1].into())),
            ("tendon 3", |(_, report)| Some(report.tensions_n[2].into())),
        ],
    },
    TimeChart {
        name: "stiffness",
        y_title: "bending stiffness (N·m/rad)",
        curves: &[("estimated", |(_, report)| {
            Some(report.stiffness_nm_per_rad.into())
        })],
    },
    TimeChart {
        name: "payload",
        y_title: "payload (kg)",
        curves: &[("estimated", |(_, report)| Some(report.payload_kg.into()))],
    },
];

/// Draws those of a simulation, each as SVG and PNG, and names the SVG files.
///
/// # Errors
/// A chart that cannot be drawn or written.
pub fn save(title: &str, samples: &[Sample], directory: &Path) -> Result<Vec<PathBuf>, PlotError> {
    time_charts::save(
        &SIMULATION,
        title,
        samples,
        |sample| sample.time_s,
        directory,
    )
}

/// Draws those of a leg's telemetry, each with its time, s.
///
/// # Errors
/// As [`save`].
pub fn save_log(
    title: &str,
    reports: &[Report],
    directory: &Path,
) -> Result<Vec<PathBuf>, PlotError> {
    time_charts::save(&LOG, title, reports, |(time_s, _)| *time_s, directory)
}
