//! How far the tip is from its target when load cells and tendon curves are off.

use crate::plot::{Chart, Line};
use crate::rig_file::RigFile;
use crate::scenario::Scenario;
use crate::simulation::{InThisProcess, Simulation, SimulationError, Summary};
use leg_firmware::supervisor::{Fault, Reaction};
use serde::Serialize;

/// Errors of the load cells, percent; their signs alternate from tendon to tendon.
pub const CELLS_PERCENT: [f64; 5] = [0.0, 0.1, 0.2, 0.5, 1.0];

/// Errors of the tendons' elongation, percent.
pub const CURVES_PERCENT: [f64; 4] = [0.0, 1.0, 2.0, 5.0];

/// The largest error of the tip in a scenario.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Sensitivity {
    /// Error of the load cells, percent.
    pub cell_percent: f64,
    /// Error of the tendons' elongation, percent.
    pub curve_percent: f64,
    /// Largest of what the scenario measures in mm; none where a fault stopped the leg.
    pub tip_mm: Option<f64>,
}

/// Runs a scenario with every pair of errors, in this process, and calls `done` after each.
///
/// # Errors
/// A start that the model refuses.
pub fn measure(
    scenario: &Scenario,
    rig: &RigFile,
    mut done: impl FnMut(),
) -> Result<Vec<Sensitivity>, SimulationError> {
    let mut all = Vec::new();
    for curve_percent in CURVES_PERCENT {
        for cell_percent in CELLS_PERCENT {
            let erring = scenario.with_errors(cell_percent, curve_percent);
            let simulation = Simulation::new(&erring, rig)?;
            let ended = simulation.run(&mut InThisProcess::default(), &mut |_| ());
            let tip_mm = ended.ok().and_then(|summary| largest_mm(&summary));
            all.push(Sensitivity {
                cell_percent,
                curve_percent,
                tip_mm,
            });
            done();
        }
    }
    Ok(all)
}

/// The largest of what is measured in mm; none if a fault stopped the leg on its way.
fn largest_mm(summary: &Summary) -> Option<f64> {
    let stopped = |(fault, _): &(Fault, f64)| fault.reaction() > Reaction::Limit;
    if summary.faults.iter().any(stopped) {
        return None;
    }
    let errors = summary
        .findings
        .iter()
        .filter(|finding| finding.unit == "mm");
    Some(errors.map(|finding| finding.value).fold(0.0, f64::max))
}

/// One line for each error of the tendons.
#[must_use]
pub fn chart(title: &str, all: &[Sensitivity]) -> Chart {
    let line = |curve_percent: f64| {
        let of_line = all.iter().filter(|one| one.curve_percent == curve_percent);
        let points: Vec<_> = of_line
            .filter_map(|one| Some((one.cell_percent, one.tip_mm?)))
            .collect();
        Line {
            label: format!("tendons off by {curve_percent} %"),
            marks: points.clone(),
            points,
        }
    };
    Chart {
        title: title.into(),
        x_title: "error of the load cells (%)".into(),
        y_title: "largest distance of the tip from its target (mm)".into(),
        lines: CURVES_PERCENT.map(line).to_vec(),
        marks_label: "simulated".into(),
    }
}
