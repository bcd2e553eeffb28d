//! Scenarios, run as `leg run --on sim` runs them.

use crate::arguments;
use crate::errors::{SimulationFailed, scenario_error};
use crate::interpreter::{self, Call};
use crate::named;
use crate::rig::Rig;
use leg_firmware::supervisor::Fault;
use leg_firmware_bench::protocol::{Reply, Request};
use leg_rig::rig_file::RigFile;
use leg_sim::link::{InProcess, Link, LinkError};
use leg_sim::scenario::Scenario;
use leg_sim::simulation::{Simulation, Summary, TickHash};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};
use std::io::ErrorKind;
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
    let mut link = Interruptible::default();
    let summary = simulation.run(&mut link, &mut |tick| hash.take(tick));
    if let Some(error) = link.error {
        return Err(error);
    }
    Ok(Run {
        title: scenario.title,
        summary: summary.map_err(SimulationFailed)?,
        hash,
    })
}

/// Requests from one look for Ctrl-C to the next: about a tenth of a second of this machine's time.
const INTERRUPT_REQUESTS: u32 = 40_000;

/// The firmware in this process, until a signal comes or the interpreter ends.
#[derive(Default)]
struct Interruptible {
    link: InProcess,
    requests: u32,
    error: Option<PyErr>,
}

impl Link for Interruptible {
    fn ask(&mut self, request: &Request) -> Result<Reply, LinkError> {
        self.requests = self.requests.wrapping_add(1);
        if self.requests.is_multiple_of(INTERRUPT_REQUESTS) && self.error.is_none() {
            self.error = interpreter::interrupted();
        }
        if self.error.is_some() {
            return Err(LinkError::System {
                action: "go on",
                source: ErrorKind::Interrupted.into(),
            });
        }
        self.link.ask(request)
    }
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

/// Runs a scenario as `leg run --on sim` does, the control law in f64 beside it.
///
/// scenario: a scenario file, the name of a ready one (`READY_SCENARIOS`), or a TOML text.
/// rig: a `Rig`, a rig file or the name of a ready rig; the scenario's if left out.
/// seed: of the sensors' noise; the scenario's if left out.
///
/// Gives `title`, `passed`, `measurements` (`name`, `value`, `unit`, `between`, `time_s`, `passed` of each), `faults` and
/// `unexpected_faults` by name, `refused` (the commands that the leg refused, when and why), `stopped` (why it ended before its last
/// step, or None), `tension_range_n`, `ticks`, and `bits`: a hash of all that the firmware decided, which is equal where every bit of it is.
///
/// Raises ScenarioError and RigError for a file that is refused, at its place.
#[pyfunction]
#[pyo3(signature = (scenario, *, rig = None, seed = None))]
pub fn run_scenario<'py>(
    py: Python<'py>,
    scenario: &Bound<'py, PyAny>,
    rig: Option<&Bound<'py, PyAny>>,
    #[pyo3(from_py_with = named::seed)] seed: Option<i128>,
) -> PyResult<Bound<'py, PyDict>> {
    let call = Call::begin(py)?;
    let scenario = scenario_of(scenario)?;
    let rig = arguments::rig(rig)?;
    let seed = seed.map(|seed| arguments::whole("seed", seed, 0..=u64::MAX));
    let seed = seed.transpose()?;
    let Run {
        title,
        summary,
        hash,
    } = call.detached(|| run(scenario, rig, seed))?;
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
    let refused: Vec<_> = summary.refused.iter().map(ToString::to_string).collect();
    result.set_item("refused", refused)?;
    Ok(result)
}
