//! The firmware's f32 against f64, and its bits against those of the same code on the host.

mod accuracy;
mod bits;
mod flatten;
mod sample;
mod state;
#[cfg(test)]
mod tests;

pub use accuracy::{Accuracy, RowReport};
pub use bits::{BitComparison, BitDifference};
pub use sample::{grid, random};
pub use state::{CheckedState, Pose, Stretch};

use self::flatten::flatten;
use crate::precision::{PrecisionRow, evaluation_parts, kernel_parts};
use leg_firmware::frame::FrameError;
use leg_firmware_bench::kernels::{self, Kernel};
use leg_firmware_bench::protocol::{EvaluateRequest, KernelRequest, Refusal, Reply, Request};
use leg_sim::link::{InProcess, Link, LinkError};
use serde::Serialize;

/// Why a check gave no result.
#[derive(Debug, thiserror::Error)]
pub enum CheckError {
    /// The model in f64 has no result where it should have one.
    #[error("the model in f64 has no result at {0}: {1}; this is a fault in the model")]
    Reference(Pose, leg_model::Error),
    /// The firmware answered something else.
    #[error("the firmware's reply is no result; build host and firmware from the same sources")]
    WrongReply,
    /// A reply cannot be encoded to compare its bits.
    #[error("a reply does not fit into a frame ({0:?}); this is a fault in the protocol")]
    NoFrame(FrameError),
    /// The link failed.
    #[error(transparent)]
    Link(#[from] LinkError),
}

/// What a check found.
#[derive(Clone, Debug, Serialize)]
pub struct CheckReport {
    /// How many states were checked.
    pub states: usize,
    /// The rows of the precision table.
    pub rows: Vec<RowReport>,
    /// The comparison with the host's f32.
    pub bits: BitComparison,
}

impl CheckReport {
    /// Names what failed; nothing if all passed.
    #[must_use]
    pub fn failures(&self) -> Vec<String> {
        let rows = self.rows.iter().filter(|row| !row.passed);
        let rows = rows.map(|row| row.row.name.to_owned());
        rows.chain(self.bits.failures()).collect()
    }
}

/// Compares a firmware at every state with f64 by a `table`, and bit by bit with the same code in this process. Calls
/// `done` after each state.
///
/// # Errors
/// A [`CheckError`] if there is no result. A firmware that refuses a state fails the check.
pub fn run(
    link: &mut dyn Link,
    table: &[PrecisionRow],
    states: &[CheckedState],
    mut done: impl FnMut(),
) -> Result<CheckReport, CheckError> {
    let mut host = InProcess::new();
    let mut accuracy = Accuracy::new(table);
    let mut bits = BitComparison::default();
    for state in states {
        let mut ask = |request: &Request, what: &'static str| {
            let reply = link.ask(request)?;
            bits.compare(&reply, &host.ask(request)?, what, state)?;
            numbers(&reply)
        };
        let found = ask(&evaluate_request(state)?, bits::EVALUATION)?;
        let expected = evaluate_f64(state).map_err(error_at_state(state))?;
        accuracy.add(&evaluation_parts(state.support), &found, &expected, state);
        for kernel in Kernel::ALL {
            let found = ask(&kernel_request(kernel, state), kernel.name())?;
            let expected = run_f64(kernel, state).map_err(error_at_state(state))?;
            accuracy.add(kernel_parts(kernel), &found, &expected, state);
        }
        done();
    }
    Ok(CheckReport {
        states: states.len(),
        rows: accuracy.into_rows(),
        bits,
    })
}

fn evaluate_request(state: &CheckedState) -> Result<Request, CheckError> {
    let query = state.message().map_err(error_at_state(state))?;
    Ok(Request::Evaluate(EvaluateRequest {
        rig: state.input.rig,
        query,
    }))
}

const fn kernel_request(kernel: Kernel, state: &CheckedState) -> Request {
    Request::Run(KernelRequest {
        kernel,
        input: state.input,
    })
}

fn evaluate_f64(state: &CheckedState) -> Result<Vec<f64>, leg_model::Error> {
    leg_model::evaluate(&state.rig(), &state.query()?).map(|evaluation| flatten(&evaluation))
}

fn run_f64(kernel: Kernel, state: &CheckedState) -> Result<Vec<f64>, leg_model::Error> {
    kernels::run::<f64>(kernel, &state.input).map(|numbers| numbers.to_vec())
}

fn error_at_state(state: &CheckedState) -> impl Fn(leg_model::Error) -> CheckError {
    let pose = state.pose();
    move |error| CheckError::Reference(pose, error)
}

/// The numbers of a reply; none if the model refused.
fn numbers(reply: &Reply) -> Result<Vec<f64>, CheckError> {
    match reply {
        Reply::Evaluation(evaluation) => Ok(flatten(evaluation)),
        Reply::Ran(numbers) => Ok(numbers.iter().copied().map(f64::from).collect()),
        Reply::Refused(Refusal::Model(_)) => Ok(Vec::new()),
        _ => Err(CheckError::WrongReply),
    }
}
