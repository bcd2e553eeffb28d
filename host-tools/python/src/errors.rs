//! What Python raises for what goes wrong here. The classes are in `python/tendon_leg/errors.py`.

use crate::session::SessionError;
use leg_base::description;
use leg_base::failure::Failure;
use leg_firmware::host_link::HostRefusal;
use leg_firmware::supervisor::{FaultSet, State};
use leg_model::Error;
use leg_sim::simulation::SimulationError;
use pyo3::PyErr;
use pyo3::exceptions::PyValueError;

mod python {
    use pyo3::import_exception;

    import_exception!(tendon_leg.errors, LegError);
    import_exception!(tendon_leg.errors, LegFault);
    import_exception!(tendon_leg.errors, LegTimeout);
    import_exception!(tendon_leg.errors, NoResult);
    import_exception!(tendon_leg.errors, Refused);
    import_exception!(tendon_leg.errors, RigError);
    import_exception!(tendon_leg.errors, ScenarioError);
}

use python::{LegError, LegFault, LegTimeout, NoResult, Refused, RigError, ScenarioError};

/// A leg that cannot be used.
pub fn leg_error(sentence: &'static str) -> PyErr {
    LegError::new_err(sentence)
}

/// A pose that the model refuses, or for which it has no result.
pub fn model_error(error: Error, words: String) -> PyErr {
    match error {
        Error::Refused { .. } => PyValueError::new_err(words),
        _ => NoResult::new_err(words),
    }
}

/// A rig file that is refused.
pub fn rig_error(failure: &Failure) -> PyErr {
    RigError::new_err(words_and_place(failure))
}

/// A scenario file that is refused.
pub fn scenario_error(failure: &Failure) -> PyErr {
    ScenarioError::new_err(words_and_place(failure))
}

/// Sentence, remedy, file, line, column.
type WordsAndPlace = (String, String, Option<String>, Option<usize>, Option<usize>);

fn words_and_place(failure: &Failure) -> WordsAndPlace {
    let (Failure::Failed(message) | Failure::Refused(message)) = failure;
    let position = message.position();
    (
        message.sentence.clone(),
        message.help.clone().unwrap_or_default(),
        message.place.as_ref().map(|place| place.file.clone()),
        position.map(|[line, _]| line),
        position.map(|[_, column]| column),
    )
}

/// A simulation that cannot start, or not go on.
impl From<SimulationFailed> for PyErr {
    fn from(SimulationFailed(error): SimulationFailed) -> Self {
        LegError::new_err(error.to_string())
    }
}

/// A [`SimulationError`], for Python.
pub struct SimulationFailed(pub SimulationError);

impl From<SessionError> for PyErr {
    fn from(error: SessionError) -> Self {
        match error {
            SessionError::Emulation(error) => LegError::new_err(error.to_string()),
            SessionError::Frame(error) => LegError::new_err(error.to_string()),
            SessionError::Refused(refusal) => refused(refusal),
            SessionError::NoAnswer => LegError::new_err("the leg did not answer a command"),
            SessionError::Point(time_s, refusal) => {
                let [wrong, remedy] = refusal.description();
                let place = format!("the path {time_s:.3} s after its start: {wrong}");
                Refused::new_err((place, remedy))
            }
            SessionError::Faulted(faults, state) => faulted(faults, state),
            SessionError::NotFollowing(state) => {
                let state = description::state(state);
                LegError::new_err(format!("the leg follows no commands now: it is {state}"))
            }
            SessionError::TimedOut(what, time_s) => {
                LegTimeout::new_err(format!("the leg did not {what} within {time_s} s"))
            }
            SessionError::RecordingFull => LegError::new_err(
                "the recording has no room for more and was given up; record fewer signals, or more seldom",
            ),
        }
    }
}

fn refused(refusal: HostRefusal) -> PyErr {
    match refusal {
        HostRefusal::Command(refusal) => {
            let [wrong, remedy] = refusal.description();
            Refused::new_err((wrong, remedy))
        }
        HostRefusal::Busy => Refused::new_err((
            "the leg is busy with what it was asked before",
            "step it, then command again",
        )),
        other => LegError::new_err(format!("the leg did not take the command: {other:?}")),
    }
}

/// The first of some faults.
fn faulted(faults: FaultSet, state: State) -> PyErr {
    let Some(fault) = faults.faults().next() else {
        return LegError::new_err("a fault is latched");
    };
    let entry = fault.entry();
    LegFault::new_err((
        fault.code(),
        entry.name,
        entry.cause,
        entry.remedy,
        description::state(state),
    ))
}
