//! The charts of a simulation: the tip, the tensions and the stiffness over time; and those of a leg's telemetry.

use crate::plot::PlotError;
use crate::time_charts::{self, POINTS_MAX, TimeChart, phase};
use leg_firmware::supervisor::State;
use leg_firmware::telemetry::Telemetry;
use leg_sim::simulation::Sample;
use std::path::{Path, PathBuf};

/// What has a meaning once the leg knows its zero, and has looked where it is.
fn value_if_homed(sample: &Sample, value: f64) -> Option<f64> {
    let known = sample.telemetry.homed && sample.telemetry.state != State::Boot;
    known.then_some(value)
}

/// A stiffness: there is none before the first target.
fn stiffness_above_zero(stiffness: f32) -> Option<f64> {
    (stiffness > 0.0).then(|| stiffness.into())
}

/// One coordinate of the tip: what was commanded, what the trajectory asks for, what the leg estimates, and what is true.
macro_rules! tip_curves {
    ($axis:literal) => {
        [
            ("commanded", |sample| {
                value_if_homed(sample, sample.comparison.tip_commanded_mm[$axis])
            }),
            ("reference", |sample| {
                value_if_homed(sample, sample.comparison.tip_reference_mm[$axis])
            }),
            ("estimated", |sample| {
                value_if_homed(sample, sample.comparison.tip_estimated_mm[$axis])
            }),
            ("true", |sample| Some(sample.comparison.tip_true_mm[$axis])),
        ]
    };
}

const SIMULATION: [TimeChart<Sample>; 5] = [
    TimeChart {
        name: "tip",
        title: "Distance of the true tip",
        y_title: "distance of the true tip (mm)",
        curves: &[
            ("from the reference", |sample| {
                value_if_homed(sample, sample.comparison.reference_error_mm())
            }),
            ("from the path", |sample| sample.comparison.path_error_mm),
        ],
    },
    TimeChart {
        name: "tip_towards_0",
        title: "Tip towards azimuth 0°",
        y_title: "tip towards azimuth 0° (mm)",
        curves: &tip_curves!(0),
    },
    TimeChart {
        name: "tip_towards_90",
        title: "Tip towards azimuth 90°",
        y_title: "tip towards azimuth 90° (mm)",
        curves: &tip_curves!(1),
    },
    TimeChart {
        name: "tensions",
        title: "True tensions",
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
        title: "Bending stiffness",
        y_title: "bending stiffness (N·m/rad)",
        curves: &[("reference", |sample| {
            stiffness_above_zero(sample.telemetry.stiffness_nm_per_rad)
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

/// A motor's current: what a driver reports that is off means nothing.
fn current_a(report: &Telemetry<f32>, motor: usize) -> Option<f64> {
    let driven = report.state.driven();
    driven.then(|| report.motor_currents_a[motor].into())
}

const LOG: [TimeChart<Report>; 6] = [
    TimeChart {
        name: "tilt",
        title: "Tilt",
        y_title: "tilt (°)",
        curves: &[
            ("reference", |(_, report)| {
                report.homed.then(|| tilt_deg(report.target))
            }),
            ("estimated", |(_, report)| {
                report.homed.then(|| tilt_deg(report.pose))
            }),
        ],
    },
    TimeChart {
        name: "tensions",
        title: "Measured tensions",
        y_title: "measured tension (N)",
        curves: &[
            ("tendon 1", |(_, report)| Some(report.tensions_n[0].into())),
            ("tendon 2", |(_, report)| Some(report.tensions_n[1].into())),
            ("tendon 3", |(_, report)| Some(report.tensions_n[2].into())),
        ],
    },
    TimeChart {
        name: "stiffness",
        title: "Bending stiffness",
        y_title: "bending stiffness (N·m/rad)",
        curves: &[("reference", |(_, report)| {
            stiffness_above_zero(report.stiffness_nm_per_rad)
        })],
    },
    TimeChart {
        name: "payload",
        title: "Payload",
        y_title: "payload (kg)",
        curves: &[("estimated", |(_, report)| {
            report.homed.then(|| report.payload_kg.into())
        })],
    },
    TimeChart {
        name: "motor_currents",
        title: "Measured currents of the motors",
        y_title: "current (A)",
        curves: &[
            ("motor 1", |(_, report)| current_a(report, 0)),
            ("motor 2", |(_, report)| current_a(report, 1)),
            ("motor 3", |(_, report)| current_a(report, 2)),
        ],
    },
    TimeChart {
        name: "supply",
        title: "Voltage at the drivers",
        y_title: "voltage (V)",
        curves: &[("supply", |(_, report)| Some(report.supply_v.into()))],
    },
];

/// Draws those of a simulation, each as SVG, PNG and PDF, and names the SVG files.
///
/// # Errors
/// A chart that cannot be drawn or written.
pub fn save(title: &str, samples: &[Sample], directory: &Path) -> Result<Vec<PathBuf>, PlotError> {
    time_charts::save(
        &SIMULATION,
        title,
        samples,
        POINTS_MAX,
        |sample| (sample.time_s, Some(phase(&sample.telemetry))),
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
    let at = |(time_s, report): &Report| (*time_s, Some(phase(report)));
    time_charts::save(&LOG, title, reports, POINTS_MAX, at, directory)
}
