//! A move with the swing of the leg braked, beside the same move without the brake.

use super::{Moved, make};
use crate::plot::{Chart, ChartLine, PlotError};
use std::path::{Path, PathBuf};

/// More points than this do not show in a chart.
const POINTS_MAX: usize = 1000;

/// Makes the move again without the brake, draws both as SVG, PNG and PDF, and names the SVG file.
///
/// # Errors
/// A chart that cannot be drawn or written.
pub fn save_comparison(moved: &Moved, directory: &Path) -> Result<PathBuf, PlotError> {
    let drawn = &moved.drawn;
    let line = |label: &str, moved: &Moved| ChartLine {
        label: label.into(),
        points: moved.way.iter().copied().step_by(step(moved)).collect(),
        marks: Vec::new(),
    };
    let chart = Chart {
        title: format!(
            "Move from {:.0}° to {:.0}° of tilt with {:.2} kg",
            drawn.begin_deg[1], drawn.end_deg[1], drawn.payload_kg
        ),
        x_title: "time since the command (s)".into(),
        y_title: "distance of the tip from its trajectory (mm)".into(),
        lines: vec![
            line("damping off", &make(&drawn.undamped())),
            line("damping on", moved),
        ],
        ..Chart::default()
    };
    crate::plot::save(&chart, &directory.join("move"))
}

fn step(moved: &Moved) -> usize {
    moved.way.len().div_ceil(POINTS_MAX).max(1)
}
