//! What computes the answers of `leg eval`.

use crate::board;
use crate::options::Options;
use clap::ValueEnum;
use leg_base::failure::Failure;
use leg_base::json_line::to_line;
use leg_base::json_object;
use leg_boards::qemu::QemuClock;
use leg_firmware_bench::protocol::{EvaluateRequest, Refusal, Reply, Request};
use leg_firmware_bench::query::QueryMessage;
use leg_model::{Evaluation, Query, RigParameters};
use leg_model_tools::jsonl::PoseLine;
use leg_model_tools::line_error::LineError;
use leg_model_tools::nonlinear;
use leg_rig::rig_file::RigFile;
use leg_sim::link::{InProcess, Link};

/// The choices of `--on`.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub(super) enum EvaluatorKind {
    /// The host, in f64.
    F64,
    /// The firmware's code in this process, in f32.
    F32,
    /// The firmware on an emulated Cortex-M4F, in f32.
    Qemu,
}

/// Why there is no answer.
pub(super) enum NoAnswer {
    /// The line has no result; the next may have one.
    Line(LineError),
    /// The command cannot go on.
    Command(Failure),
}

impl From<LineError> for NoAnswer {
    fn from(error: LineError) -> Self {
        Self::Line(error)
    }
}

impl From<leg_model::Error> for NoAnswer {
    fn from(error: leg_model::Error) -> Self {
        Self::Line(error.into())
    }
}

/// The model in f64 on the host, or in f32 behind a link.
pub(super) enum Evaluator {
    Host,
    Firmware(Box<dyn Link>),
}

impl Evaluator {
    pub(super) fn start(on: EvaluatorKind, options: Options) -> Result<Self, Failure> {
        Ok(match on {
            EvaluatorKind::F64 => Self::Host,
            EvaluatorKind::F32 => Self::Firmware(Box::new(InProcess::new())),
            EvaluatorKind::Qemu => Self::Firmware(board::qemu(QemuClock::Normal, options)?),
        })
    }

    /// The answer to a line, as a line.
    pub(super) fn answer(&mut self, text: &[u8], rig: &RigFile) -> Result<String, NoAnswer> {
        let PoseLine { rig, query } = PoseLine::parse(text, rig)?;
        match self {
            Self::Host => to_line(&json_object! {
                #[serde(flatten)]
                evaluation: leg_model::evaluate(&rig, &query)?,
                // Only f64 is precise enough for it.
                #[serde(flatten)]
                nonlinear: nonlinear::deviation_m(&rig, &query)?
                    .map(|m| json_object! { deviation_nonlinear_m: m }),
            }),
            Self::Firmware(link) => to_line(&ask_firmware(link.as_mut(), &rig, &query)?),
        }
        .map_err(NoAnswer::Command)
    }
}

/// Rounds the arguments to f32 and asks a firmware.
fn ask_firmware(
    link: &mut dyn Link,
    rig: &RigParameters<f64, 3>,
    query: &Query<f64>,
) -> Result<Evaluation<f32>, NoAnswer> {
    let request = Request::Evaluate(EvaluateRequest {
        rig: rig.map(|value| value as f32),
        query: QueryMessage::from_query(query, |value| value as f32),
    });
    let reply = link.ask(&request);
    let reply = reply.map_err(|error| NoAnswer::Command(Failure::from_error(error)))?;
    let wrong = match reply {
        Reply::Evaluation(evaluation) => return Ok(evaluation),
        Reply::Refused(Refusal::Model(error)) => return Err(error.into()),
        Reply::Refused(refusal) => format!("the firmware refused to evaluate ({refusal:?})"),
        _ => "the firmware's reply is no evaluation".into(),
    };
    let remedy = "build host and firmware from the same sources";
    Err(NoAnswer::Command(Failure::refused(wrong, remedy)))
}

/// The line in the place of an answer.
pub(super) fn refusal(error: &LineError, line: usize) -> Result<String, Failure> {
    to_line(&json_object! { error: error.to_string(), line: line })
}
