//! The model at one pose, as a firmware computes it in f32.

use crate::link::{Link, LinkError};
use leg_firmware::protocol::{EvaluateRequest, Refusal, Reply, Request};
use leg_model::{Evaluation, Query, RigParameters};

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

fn round_rig(rig: &RigParameters<f64, 3>) -> RigParameters<f32, 3> {
    RigParameters {
        base_anchors_m: rig.base_anchors_m.map(|point| point.map(round)),
        leg_anchors_m: rig.leg_anchors_m.map(|point| point.map(round)),
        upper_length_m: round(rig.upper_length_m),
        joint_length_m: round(rig.joint_length_m),
        leg_length_m: round(rig.leg_length_m),
        leg_mass_kg: round(rig.leg_mass_kg),
        leg_centroid_m: round(rig.leg_centroid_m),
        gravity_m_per_s2: round(rig.gravity_m_per_s2),
    }
}

fn round_query(query: &Query<f64>) -> Query<f32> {
    Query {
        azimuth_rad: round(query.azimuth_rad),
        tilt_rad: round(query.tilt_rad),
        payload_kg: round(query.payload_kg),
        level_n: round(query.level_n),
        tension_floor_n: round(query.tension_floor_n),
        tension_ceiling_n: round(query.tension_ceiling_n),
        stiffness_n_per_m: round(query.stiffness_n_per_m),
        support: query.support,
    }
}

/// To the nearest f32; beyond its range that is infinite, and the model refuses it by name.
#[allow(
    clippy::cast_possible_truncation,
    reason = "rounding is what is asked for"
)]
fn round(value: f64) -> f32 {
    value as f32
}
