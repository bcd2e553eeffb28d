//! What Python raises for what goes wrong here. The classes are in `python/tendon_leg/errors.py`.

use crate::operator_thread::LegFailure;
use crate::session::SessionError;
use leg_base::description::{self, remedies_and_clear};
use leg_base::failure::Failure;
use leg_base::refusal;
use leg_firmware::command::CommandRefusal;
use leg_firmware::host_link::HostRefusal;
use leg_firmware::set_point::PointRefusal;
use leg_firmware::supervisor::{Clearing, FaultSet, State};
use leg_host::operator::OperatorError;
use leg_model::Error;
use leg_sim::simulation::SimulationError;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyTuple;

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
        python_words(&message.sentence),
        python_words(message.help.as_deref().unwrap_or_default()),
        message.place.as_ref().map(|place| place.file.clone()),
        position.map(|[line, _]| line),
        position.map(|[_, column]| column),
    )
}

/// Words of the command line, and those of this package in their place.
const CALLS: [(&str, &str); 13] = [
    ("run `leg disarm`", "call disarm()"),
    ("`leg disarm`", "disarm()"),
    ("`leg home`", "home()"),
    ("`leg hold`", "hold()"),
    ("`leg stop`", "stop()"),
    ("`leg clear`", "clear()"),
    ("`leg monitor`", "telemetry()"),
    ("`leg sensors`", "sensors()"),
    ("`leg settings set`", "set_settings()"),
    ("`leg calibrate`", "calibrate_cell()"),
    ("`leg rig list`", "READY_RIGS"),
    (" with --port", ""),
    ("--on sim", "Leg.emulated()"),
];

fn python_words(words: &str) -> String {
    let mut words = words.to_owned();
    for (typed, called) in CALLS {
        words = words.replace(typed, called);
    }
    words
}

/// A simulation that cannot start, or not go on.
impl From<SimulationFailed> for PyErr {
    fn from(SimulationFailed(error): SimulationFailed) -> Self {
        LegError::new_err(error.to_string())
    }
}

/// A [`SimulationError`], for Python.
pub struct SimulationFailed(pub SimulationError);

/// What a leg answers through its operator.
pub fn leg_failure(failure: LegFailure) -> PyErr {
    let (error, state) = match failure {
        LegFailure::Refused(failure) => return LegError::new_err(sentence(&failure)),
        LegFailure::Closed => return leg_error("the leg's own thread has ended; open it again"),
        LegFailure::Operator(error, state) => (error, state),
    };
    let failure = error.failure();
    let (reason, remedy, ..) = words_and_place(&failure);
    match *error {
        OperatorError::Failed(_, telemetry) => {
            faulted(telemetry.faults.stopping(), Some(telemetry.state))
        }
        OperatorError::Limited(_, telemetry) => {
            faulted(telemetry.faults.limits(), Some(telemetry.state))
        }
        OperatorError::Faulted(_, faults) | OperatorError::NotCleared(faults) => {
            faulted(faults, state)
        }
        OperatorError::Refused(_, refusal) => refused(&refusal, [reason, remedy]),
        OperatorError::Point(_, refusal) => refused(&point(refusal), [reason, remedy]),
        OperatorError::TimedOut(..) => LegTimeout::new_err(sentence(&failure)),
        OperatorError::Cancelled => {
            leg_error("another thread stopped the leg; it is in hold if it was driven")
        }
        _ => LegError::new_err(sentence(&failure)),
    }
}

fn sentence(failure: &Failure) -> String {
    let (reason, remedy, ..) = words_and_place(failure);
    if remedy.is_empty() {
        reason
    } else {
        format!("{reason}; {remedy}")
    }
}

impl From<SessionError> for PyErr {
    fn from(error: SessionError) -> Self {
        match error {
            SessionError::Emulation(error) => LegError::new_err(error.to_string()),
            SessionError::Frame(error) => LegError::new_err(error.to_string()),
            SessionError::Refused(refusal) => refused(&refusal, simulated_legs_words(&refusal)),
            SessionError::NoAnswer => LegError::new_err("the leg did not answer a command"),
            SessionError::Point(time_s, refusal) => {
                refused(&point(refusal), refusal::point_description(time_s, refusal))
            }
            SessionError::Faulted(faults, state) => faulted(faults, Some(state)),
            SessionError::NotFollowing(state) => {
                let state = description::state(state);
                LegError::new_err(format!("the leg follows no commands now: it is {state}"))
            }
            SessionError::TimedOut(what, time_s) => {
                LegTimeout::new_err(format!("the leg did not {what} within {time_s} s"))
            }
            SessionError::Interrupted(error) => error,
            SessionError::RecordingFull => LegError::new_err(
                "the recording has no room for more and was given up; record fewer signals, or more seldom",
            ),
        }
    }
}

/// A refusal: its numbers and names in the protocol, what is wrong, and what to do about it.
fn refused(refusal: &HostRefusal, [reason, remedy]: [String; 2]) -> PyErr {
    let (reason, remedy) = (python_words(&reason), python_words(&remedy));
    let (numbers, names): (Vec<_>, Vec<_>) = refusal::variants(refusal).into_iter().unzip();
    Python::attach(|py| match PyTuple::new(py, numbers) {
        Ok(code) => Refused::new_err((code.unbind(), names.join("."), reason, remedy)),
        Err(error) => error,
    })
}

const fn point(refusal: PointRefusal) -> HostRefusal {
    HostRefusal::Command(CommandRefusal::Point(refusal))
}

/// Of a simulated leg: without a line, and with time that passes only in calls.
fn simulated_legs_words(refusal: &HostRefusal) -> [String; 2] {
    let words = match refusal {
        HostRefusal::Command(refusal) => refusal.description(),
        HostRefusal::Busy => [
            "the leg is busy with what it was asked before",
            "step it, then command again",
        ],
        other => return refusal::description(other),
    };
    words.map(String::from)
}

/// The first of some faults, and what the leg does, if that is known.
fn faulted(faults: FaultSet, state: Option<State>) -> PyErr {
    let Some(fault) = faults.faults().next() else {
        return LegError::new_err("a fault is latched");
    };
    let entry = fault.entry();
    let remedy = match entry.clears {
        Clearing::CauseGone => entry.remedy.into(),
        Clearing::Command => remedies_and_clear(FaultSet::single(fault), "clear()"),
    };
    LegFault::new_err((
        fault.code(),
        entry.name,
        entry.cause,
        remedy,
        state.map_or("out of reach", description::state),
    ))
}
