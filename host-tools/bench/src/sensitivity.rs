//! How far the tip is from its target when load cells and tendon curves are off.

use crate::plot::{Chart, ChartLine};
use leg_firmware::supervisor::{Fault, Reaction};
use leg_rig::rig_file::RigFile;
use leg_sim::link::InProcess;
use leg_sim::scenario::{Measurand, Scenario};
use leg_sim::simulation::{Simulation, SimulationError, Summary};
use serde::Serialize;

/// Errors of the load cells, percent; their signs alternate from tendon to tendon.
pub const CELLS_PERCENT: [f64; 5] = [0.0, 0.1, 0.2, 0.5, 1.0];

/// Errors of the tendons' elongation, percent.
pub const CURVES_PERCENT: [f64; 4] = [0.0, 1.0, 2.0, 5.0];

/// The largest error of the tip in a scenario.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Sensitivity {
    /// Error of the load cells, percent.
    pub cell_percent: f64,
    /// Error of the tendons' elongation, percent.
    pub curve_percent: f64,
    /// Largest error of the tip that the scenario measures while the load is compensated, mm; none where the run did not get
    /// so far.
    pub tip_mm: Option<f64>,
    /// What stopped the run, if anything did.
    pub stopped: Option<String>,
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
            let ended = simulation.run(&mut InProcess::new(), &mut |_| ());
            let (tip_mm, stopped) = match ended {
                Ok(summary) => match (stopping(&summary), &summary.stopped) {
                    (None, None) => (largest_mm(&summary), None),
                    (Some(fault), _) => (None, Some(fault.entry().name.into())),
                    (None, Some(reason)) => (None, Some(reason.clone())),
                },
                Err(error) => (None, Some(error.to_string())),
            };
            all.push(Sensitivity {
                cell_percent,
                curve_percent,
                tip_mm,
                stopped,
            });
            done();
        }
    }
    Ok(all)
}

/// The first fault that stopped the leg on its way.
fn stopping(summary: &Summary) -> Option<Fault> {
    let stops = |(fault, _): &&(Fault, f64)| fault.reaction() > Reaction::Limit;
    summary.faults.iter().find(stops).map(|(fault, _)| *fault)
}

/// The largest error of the tip that was measured while the load was compensated; none if there was no such measure.
#[must_use]
pub fn largest_mm(summary: &Summary) -> Option<f64> {
    summary
        .measurements
        .iter()
        .filter(|found| found.compensated && found.quantity == Some(Measurand::TipErrorMm))
        .map(|found| found.value)
        .reduce(f64::max)
}

/// One line for each error of the tendons.
#[must_use]
pub fn chart(title: &str, all: &[Sensitivity]) -> Chart {
    let line = |curve_percent: f64| {
        let of_line = all.iter().filter(|one| one.curve_percent == curve_percent);
        let points: Vec<_> = of_line
            .filter_map(|one| Some((one.cell_percent, one.tip_mm?)))
            .collect();
        ChartLine {
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
        ..Chart::default()
    }
}
