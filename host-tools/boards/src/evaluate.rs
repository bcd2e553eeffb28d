//! The model at one pose, as a firmware computes it in f32.

use leg_firmware_bench::protocol::{EvaluateRequest, Refusal, Reply, Request};
use leg_model::{Evaluation, Query, RigParameters};
use leg_rig::rounding::{round_query, round_rig};
use leg_sim::link::{Link, LinkError};

/// Why a firmware gave no evaluation.
#[derive(Debug, thiserror::Error)]
pub enum EvaluateError {
    /// The model has no result for the arguments.
    #[error("the model has no result: {0}")]
    Model(leg_model::Error),
    /// The firmware refused the request itself.
    #[error(
        "the firmware refused to evaluate ({0:?}): build host and firmware from the same sources"
    )]
    Refused(Refusal),
    /// The firmware answered something else.
    #[error("the firmware's reply is no evaluation: build host and firmware from the same sources")]
    WrongReply,
    /// The link failed.
    #[error(transparent)]
    Link(#[from] LinkError),
}

/// Rounds the arguments to f32 and asks a firmware.
///
/// # Errors
/// An [`EvaluateError`]: the model's refusal, or a link that failed.
pub fn on_link(
    link: &mut dyn Link,
    rig: &RigParameters<f64, 3>,
    query: &Query<f64>,
) -> Result<Evaluation<f32>, EvaluateError> {
    let request = EvaluateRequest {
        rig: round_rig(rig).into(),
        query: round_query(query),
    };
    match link.ask(&Request::Evaluate(request))? {
        Reply::Evaluation(evaluation) => Ok(evaluation),
        Reply::Refused(Refusal::Model(error)) => Err(EvaluateError::Model(error)),
        Reply::Refused(refusal) => Err(EvaluateError::Refused(refusal)),
        _ => Err(EvaluateError::WrongReply),
    }
}
