//! Charts of what a board's recorder kept.

use crate::plot::PlotError;
use crate::time_charts::{self, TimeChart};
use leg_base::description;
use leg_base::recorder_rows::RecorderRow;
use leg_base::tick_time::tick_s;
use leg_firmware::settings::RecordedSignal;
use std::path::{Path, PathBuf};

/// One curve for each tendon or motor, in so many units of the signal.
macro_rules! curves {
    ($word:literal, $signal:ident, $units:expr) => {
        &[
            (concat!($word, " 1"), |row| {
                value(row, RecordedSignal::$signal, 0, $units)
            }),
            (concat!($word, " 2"), |row| {
                value(row, RecordedSignal::$signal, 1, $units)
            }),
            (concat!($word, " 3"), |row| {
                value(row, RecordedSignal::$signal, 2, $units)
            }),
        ]
    };
}

const CHARTS: [TimeChart<RecorderRow>; 10] = [
    TimeChart {
        name: "recorded_tensions",
        title: "Measured tensions",
        y_title: "tension (N)",
        curves: curves!("tendon", Tensions, 1.0),
    },
    TimeChart {
        name: "recorded_target_tensions",
        title: "Tensions of the target",
        y_title: "tension (N)",
        curves: curves!("tendon", TargetTensions, 1.0),
    },
    TimeChart {
        name: "recorded_travel",
        title: "Travel of the tendons",
        y_title: "pulled in (mm)",
        curves: curves!("tendon", Pulled, 1000.0),
    },
    TimeChart {
        name: "recorded_references",
        title: "References of the tendons' travel",
        y_title: "pulled in (mm)",
        curves: curves!("tendon", References, 1000.0),
    },
    TimeChart {
        name: "recorded_currents",
        title: "Currents of the motors",
        y_title: "current (A)",
        curves: curves!("motor", Currents, 1.0),
    },
    TimeChart {
        name: "recorded_duties",
        title: "Duties of the motors",
        y_title: "part of the supply",
        curves: curves!("motor", Duties, 1.0),
    },
    TimeChart {
        name: "recorded_direction",
        title: "Estimated direction",
        y_title: "horizontal component",
        curves: &[
            ("x", |row| value(row, RecordedSignal::Pose, 0, 1.0)),
            ("y", |row| value(row, RecordedSignal::Pose, 1, 1.0)),
        ],
    },
    TimeChart {
        name: "recorded_residual",
        title: "Residual of forward kinematics",
        y_title: "residual (µm)",
        curves: &[("residual", |row| value(row, RecordedSignal::Pose, 2, 1e6))],
    },
    TimeChart {
        name: "recorded_supply",
        title: "Voltage at the drivers",
        y_title: "voltage (V)",
        curves: &[("supply", |row| value(row, RecordedSignal::Board, 0, 1.0))],
    },
    TimeChart {
        name: "recorded_temperature",
        title: "Temperature of the drivers",
        y_title: "temperature (°C)",
        curves: &[("drivers", |row| value(row, RecordedSignal::Board, 1, 1.0))],
    },
];

fn value(row: &RecorderRow, signal: RecordedSignal, index: usize, units: f64) -> Option<f64> {
    row.get(signal)?.get(index).map(|value| units * value)
}

/// Draws them, each as SVG, PNG and PDF, and names the SVG files: over the time since the fault, or since the board's start where a
/// host has ended the recording. Of what was not recorded there is none.
///
/// # Errors
/// A chart that cannot be drawn or written.
pub fn save(
    title: &str,
    rows: &[RecorderRow],
    directory: &Path,
) -> Result<Vec<PathBuf>, PlotError> {
    let at = |row: &RecorderRow| {
        let ticks = row.ticks_since_fault().map_or(row.tick.into(), f64::from);
        (ticks * tick_s(), row.state().map(description::state))
    };
    // A change of one tick is what a recorder is for: none is left out.
    time_charts::save(&CHARTS, title, rows, rows.len(), at, directory)
}
