//! What computes the answers of `leg eval`.

use super::board;
use clap::ValueEnum;
use leg_base::failure::Failure;
use leg_base::json_line::to_line;
use leg_boards::evaluate::{self, EvaluateError};
use leg_model::Evaluation;
use leg_model_tools::jsonl::Line;
use leg_model_tools::nonlinear;
use leg_rig::line_error::LineError;
use leg_rig::rig_file::RigFile;
use leg_sim::link::Link;
use serde::Serialize;

/// The choices of `--on`.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub(super) enum On {
    /// The host, in f64.
    F64,
    /// The firmware's code in this process, in f32.
    F32,
    /// The firmware on an emulated Cortex-M4F, in f32.
    Qemu,
}

/// Why there is no answer.
pub(super) enum Stop {
    /// The line has no result; the next may have one.
    Line(LineError),
    /// The command cannot go on.
    Command(Failure),
}

impl From<LineError> for Stop {
    fn from(error: LineError) -> Self {
        Self::Line(error)
    }
}

impl From<leg_model::Error> for Stop {
    fn from(error: leg_model::Error) -> Self {
        Self::Line(error.into())
    }
}

impl From<EvaluateError> for Stop {
    fn from(error: EvaluateError) -> Self {
        match error {
            EvaluateError::Model(error) => Self::Line(error.into()),
            _ => Self::Command(Failure::from_error(&error)),
        }
    }
}

/// The model in f64 on the host, or in f32 behind a link.
pub(super) enum Evaluator {
    Host,
    Firmware(Box<dyn Link>),
}

impl Evaluator {
    pub(super) fn start(on: On, verbose: bool) -> Result<Self, Failure> {
        Ok(match on {
            On::F64 => Self::Host,
            On::F32 => Self::Firmware(board::in_process()?),
            On::Qemu => Self::Firmware(board::qemu(verbose)?),
        })
    }

    /// The answer to a line, as a line.
    pub(super) fn answer(&mut self, text: &[u8], rig: &RigFile) -> Result<String, Stop> {
        let Line { rig, query } = Line::parse(text, rig)?;
        match self {
            Self::Host => to_line(&HostAnswer {
                evaluation: leg_model::evaluate(&rig, &query)?,
                deviation_nonlinear_m: nonlinear::deviation_m(&rig, &query)?,
            }),
            Self::Firmware(link) => to_line(&evaluate::on_link(link.as_mut(), &rig, &query)?),
        }
        .map_err(Stop::Command)
    }
}

/// What the host says of a pose: the model, and what only f64 is fit for.
#[derive(Serialize)]
struct HostAnswer {
    #[serde(flatten)]
    evaluation: Evaluation<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    deviation_nonlinear_m: Option<f64>,
}

/// What stands in the place of an answer.
pub(super) fn refusal(error: &LineError, line: usize) -> Result<String, Failure> {
    #[derive(Serialize)]
    struct Refusal {
        error: String,
        line: usize,
    }
    to_line(&Refusal {
        error: error.to_string(),
        line,
    })
}
