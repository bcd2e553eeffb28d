//! The Python package `tendon_leg`: the model and the simulated leg, numpy in and out.
//!
//! Where to begin: [`simulated_leg`] is the class `SimulatedLeg`; what it does tick by tick is in [`session`], without
//! Python. [`leg`] is the class `Leg` for a leg on a port, [`rig`] is the class `Rig`, [`evaluation`] the model at many poses, [`outputs`] what it gives. [`signals`] declares what can be read and recorded. What Python sees of it is in `python/tendon_leg`: types and
//! docstrings in `_native.pyi`, exceptions in `errors.py`.

mod arguments;
mod cores;
mod errors;
mod evaluation;
mod interpreter;
mod leg;
mod map_quantities;
mod named;
mod operator_thread;
mod outputs;
mod rig;
mod scenarios;
mod scope;
mod session;
mod signal_log;
mod signals;
mod simulated_leg;
mod start;
mod telemetry;

use leg_base::description;
use leg_firmware::sensors::TICK_HZ;
use leg_firmware::supervisor::State;
use leg_rig::ready_rigs::READY_RIGS;
use leg_sim::plant::Defect;
use leg_sim::ready_scenarios::READY_SCENARIOS;
use outputs::OUTPUTS;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};
use signals::NumericSignal;

/// What the package's own files are made of.
#[pymodule]
fn _native(module: &Bound<'_, PyModule>) -> PyResult<()> {
    let py = module.py();
    interpreter::watch(py)?;
    module.add_class::<leg::Leg>()?;
    module.add_class::<rig::Rig>()?;
    module.add_class::<simulated_leg::SimulatedLeg>()?;
    module.add_function(wrap_pyfunction!(scenarios::run_scenario, module)?)?;
    module.add("TICKS_PER_SECOND", TICK_HZ)?;
    let states = State::ALL.map(description::state);
    module.add("STATES", PyTuple::new(py, states)?)?;
    let rigs = PyDict::new(py);
    for rig in READY_RIGS {
        rigs.set_item(rig.name, rig.words)?;
    }
    module.add("READY_RIGS", rigs)?;
    let scenarios = PyDict::new(py);
    for scenario in READY_SCENARIOS {
        scenarios.set_item(scenario.name, scenario.text)?;
    }
    module.add("READY_SCENARIOS", scenarios)?;
    let defects = PyDict::new(py);
    for (name, meaning) in Defect::descriptions() {
        defects.set_item(name, meaning)?;
    }
    module.add("DEFECTS", defects)?;
    let outputs = OUTPUTS.iter().map(|output| output.name);
    module.add("OUTPUTS", PyTuple::new(py, outputs.collect::<Vec<_>>())?)?;
    let signals = PyDict::new(py);
    for signal in NumericSignal::all() {
        signals.set_item(signal.name(), signal.meaning())?;
    }
    module.add("SIGNALS", signals)
}
