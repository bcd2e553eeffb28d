//! Scenarios, run as `leg run --on sim` runs them.

use crate::arguments;
use crate::errors::{SimulationFailed, scenario_error};
use crate::rig::Rig;
use leg_firmware::supervisor::Fault;
use leg_rig::rig_file::RigFile;
use leg_sim::link::InProcess;
use leg_sim::scenario::Scenario;
use leg_sim::simulation::{Simulation, Summary, TickHash};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};
use std::path::Path;

/// A scenario that has been run.
struct Run {
    title: String,
    summary: Summary,
    hash: TickHash,
}

fn run(mut scenario: Scenario, rig: Option<RigFile>, seed: Option<u64>) -> PyResult<Run> {
    scenario.seed = seed.unwrap_or(scenario.seed);
    let rig = match rig {
        Some(rig) => rig,
        None => Rig::load(Some(Path::new(&scenario.rig)))?.file,
    };
    let simulation = Simulation::new(&scenario, &rig).map_err(SimulationFailed)?;
    let mut hash = TickHash::default();
    let summary = simulation.run(&mut InProcess::new(), &mut |tick| hash.take(tick));
    Ok(Run {
        title: scenario.title,
        summary: summary.map_err(SimulationFailed)?,
        hash,
    })
}

/// A scenario by its text, which has more than one line, its file or its name.
fn scenario_of(argument: &Bound<'_, PyAny>) -> PyResult<Scenario> {
    let text = argument.extract::<&str>().ok();
    let loaded = match text.filter(|text| text.contains('\n')) {
        Some(text) => Scenario::parse("scenario", text),
        None => Scenario::load(&arguments::path_of("scenario", argument)?),
    };
    loaded.map_err(|failure| scenario_error(&failure))
}

/// See `_native.pyi`.
#[pyfunction]
#[pyo3(signature = (scenario, *, rig = None, seed = None))]
pub fn run_scenario<'py>(
    py: Python<'py>,
    scenario: &Bound<'py, PyAny>,
    rig: Option<&Bound<'py, PyAny>>,
    seed: Option<u64>,
) -> PyResult<Bound<'py, PyDict>> {
    let scenario = scenario_of(scenario)?;
    let rig = arguments::rig(rig)?;
    let Run {
        title,
        summary,
        hash,
    } = py.detach(|| run(scenario, rig, seed))?;
    let result = PyDict::new(py);
    result.set_item("title", title)?;
    result.set_item("passed", summary.passes())?;
    result.set_item("stopped", &summary.stopped)?;
    result.set_item("ticks", summary.ticks)?;
    result.set_item("bits", format!("{:016x}", hash.value()))?;
    result.set_item("tension_range_n", summary.tension_range_n)?;
    let measurements = PyList::empty(py);
    for measured in &summary.measurements {
        let row = PyDict::new(py);
        row.set_item("name", &measured.name)?;
        row.set_item("value", measured.value)?;
        row.set_item("unit", measured.unit)?;
        row.set_item("between", measured.between)?;
        row.set_item("time_s", measured.at_s)?;
        row.set_item("passed", measured.passes())?;
        measurements.append(row)?;
    }
    result.set_item("measurements", measurements)?;
    let seen = summary.faults.iter();
    let names = |faults: Vec<Fault>| faults.into_iter().map(|fault| fault.entry().name);
    let faults: Vec<_> = names(seen.map(|(fault, _)| *fault).collect()).collect();
    result.set_item("faults", faults)?;
    let unexpected: Vec<_> = names(summary.unexpected).collect();
    result.set_item("unexpected_faults", unexpected)?;
    Ok(result)
}
