//! The firmware's f32 against f64, and its bits against those of the same code on the host.

mod accuracy;
mod bits;
mod reference;
mod sample;
mod state;
#[cfg(test)]
mod tests;

pub use accuracy::{Accuracy, RowReport};
pub use bits::{Bits, Difference};
pub use sample::{grid, random};
pub use state::{Pose, State, Stretch};

use crate::precision::{Row, of_evaluation, of_kernel};
use leg_firmware::frame::FrameError;
use leg_firmware_bench::kernels::Kernel;
use leg_firmware_bench::protocol::{EvaluateRequest, KernelRequest, Refusal, Reply, Request};
use leg_sim::link::{InProcess, Link, LinkError};
use serde::Serialize;

/// Why there is nothing to judge.
#[derive(Debug, thiserror::Error)]
pub enum CheckError {
    /// The model in f64 has no result where it should have one.
    #[error("the model in f64 has no result at {pose}: {error}; this is a fault in the model")]
    Reference {
        /// Where.
        pose: Pose,
        /// What it says.
        error: leg_model::Error,
    },
    /// The firmware answered something else.
    #[error("the firmware's reply is no result; build host and firmware from the same sources")]
    WrongReply,
    /// A reply cannot be written down to compare its bits.
    #[error("a reply does not fit into a frame ({0:?}); this is a fault in the protocol")]
    NoFrame(FrameError),
    /// The link failed.
    #[error(transparent)]
    Link(#[from] LinkError),
}

/// What a check found.
#[derive(Clone, Debug, Serialize)]
pub struct Report {
    /// How many states were checked.
    pub states: usize,
    /// The rows of the precision table.
    pub rows: Vec<RowReport>,
    /// The comparison with the host's f32.
    pub bits: Bits,
}

impl Report {
    /// What did not hold, in words; nothing if all did.
    #[must_use]
    pub fn missed(&self) -> Vec<String> {
        let rows = self.rows.iter().filter(|row| !row.held);
        let rows = rows.map(|row| row.row.name.to_owned());
        rows.chain(self.bits.missed()).collect()
    }
}

/// Compares a firmware at every state with f64 by a `table`, and bit by bit with the same code in this process. Calls
/// `done` after each state.
///
/// # Errors
/// A [`CheckError`] if there is nothing to judge. A firmware that refuses a state is judged: it has missed.
pub fn run(
    link: &mut dyn Link,
    table: &[Row],
    states: &[State],
    mut done: impl FnMut(),
) -> Result<Report, CheckError> {
    let mut host = InProcess::open()?;
    let mut accuracy = Accuracy::new(table);
    let mut bits = Bits::default();
    for state in states {
        let mut ask = |request: &Request, what: &'static str| {
            let reply = link.ask(request)?;
            bits.compare(&reply, &host.ask(request)?, what, state)?;
            numbers(&reply)
        };
        let found = ask(&evaluate_request(state)?, bits::EVALUATION)?;
        let expected = reference::evaluation(state)?;
        accuracy.add(&of_evaluation(state.support.kind), &found, &expected, state);
        for kernel in Kernel::ALL {
            let found = ask(&kernel_request(kernel, state), kernel.name())?;
            let expected = reference::kernel(kernel, state)?;
            accuracy.add(of_kernel(kernel), &found, &expected, state);
        }
        done();
    }
    Ok(Report {
        states: states.len(),
        rows: accuracy.into_rows(),
        bits,
    })
}

fn evaluate_request(state: &State) -> Result<Request, CheckError> {
    let query = state.message().map_err(reference::at(state))?;
    Ok(Request::Evaluate(EvaluateRequest {
        rig: state.input.rig,
        query,
    }))
}

const fn kernel_request(kernel: Kernel, state: &State) -> Request {
    Request::Run(KernelRequest {
        kernel,
        input: state.input,
    })
}

/// The numbers of a reply; none if the model refused.
fn numbers(reply: &Reply) -> Result<Vec<f64>, CheckError> {
    match reply {
        Reply::Evaluation(evaluation) => Ok(reference::flatten(evaluation)),
        Reply::Ran(numbers) => Ok(numbers.iter().copied().map(f64::from).collect()),
        Reply::Refused(Refusal::Model(_)) => Ok(Vec::new()),
        _ => Err(CheckError::WrongReply),
    }
}
