//! `leg eval`.

mod evaluator;

use crate::options::Options;
use crate::output::{load_rig, print};
use evaluator::{Evaluator, EvaluatorKind, NoAnswer};
use leg_base::failure::Failure;
use leg_base::text_input::{self, Line};
use leg_model_tools::jsonl;
use leg_model_tools::line_error::LineError;
use std::fs::File;
use std::io::{self, BufRead, BufReader, ErrorKind};
use std::path::{Path, PathBuf};

/// Evaluates the model at poses given as JSON Lines.
#[derive(Debug, clap::Args)]
#[command(after_help = CONTRACT)]
pub(crate) struct Args {
    /// What computes: the host in f64, or the firmware's code in f32 on the host or under QEMU.
    #[arg(long, value_enum, default_value_t = EvaluatorKind::F64)]
    on: EvaluatorKind,
    /// The rig file or the name of a ready rig; the paper's rig if left out.
    #[arg(long, value_name = "FILE")]
    rig: Option<PathBuf>,
    /// The poses, one JSON object a line; `-` is standard input.
    #[arg(default_value = "-")]
    file: PathBuf,
}

const CONTRACT: &str = "\
Keys of a line:
  azimuth_deg         direction towards which the leg leans, -3600 to 3600
  tilt_deg            tilt from the vertical, -60 to 60; a negative tilt is the opposite azimuth
  payload_kg          mass at the tip
and, from the rig file if left out:
  level_n             pretension, N per tendon at the vertical pose
  stiffness_n_per_m   constant stiffness of each tendon, in the place of the rig's curve
  stiffness_at        where the stiffness of a curve is read: \"pretension\" (at the pretension) or
                      \"tension\" (each tendon's own)
  f_min_n, f_max_n    minimum and maximum tension
  leg_mass_kg         mass of the leg
  l_upper_m           upper plate to joint centre
  support             \"torsion_free\", \"universal\", \"spherical\", or that of the rig
and, if a stiffness is demanded:
  demand_nm_per_rad   bending stiffness of the leg's softest tilt
  demand_towards_deg  azimuth of a push at the tip that meets the stiffness instead
The key `commanded` of the answer is the pretension that gives the stiffness or, where no pretension
within the tension bounds does, the nearest one and the tendon and bound that stop it.

Each line is answered by one line, in order, in SI units. A line that has no result is
answered by {\"error\":…,\"line\":n}; the others go on, and the exit code is 1. Empty lines
are skipped, but counted.

deviation_nonlinear_m is computed in f64 only. It is left out at a pretension at which a tendon
would have to push before the weights are applied, where it has no meaning.";

pub(crate) fn run(args: &Args, options: Options) -> Result<(), Failure> {
    let mut input = open(&args.file)?;
    let rig = load_rig(args.rig.as_deref())?;
    let mut evaluator = Evaluator::start(args.on, options)?;
    let (mut answered, mut failed) = (0, 0);
    for number in 1_usize.. {
        let line = text_input::next_line(&mut input);
        let Some(line) = line.map_err(|error| unreadable_line(&args.file, number, &error))? else {
            break;
        };
        let answer = match &line {
            Line::Whole(text) => {
                // Some editors put a mark before the first line.
                let marked = text.strip_prefix(b"\xef\xbb\xbf").filter(|_| number == 1);
                let text = marked.unwrap_or(text);
                if text.trim_ascii().is_empty() {
                    continue;
                }
                evaluator.answer(text, &rig)
            }
            Line::TooLong => Err(LineError::TooLong.into()),
        };
        answered += 1;
        let answer = match answer {
            Ok(answer) => answer,
            Err(NoAnswer::Line(error)) => {
                failed += 1;
                evaluator::refusal(&error, number)?
            }
            Err(NoAnswer::Command(failure)) => return Err(failure),
        };
        print(&answer)?;
    }
    require_answers(&args.file, answered, failed)
}

fn require_answers(file: &Path, answered: usize, failed: usize) -> Result<(), Failure> {
    if answered == 0 {
        let help = format!("write one pose a line, such as {}", jsonl::EXAMPLE);
        return Err(Failure::refused(
            format!("{} holds no pose", name(file)),
            help,
        ));
    }
    if failed > 0 {
        let sentence = format!("{failed} of {answered} lines have no result");
        return Err(Failure::failed(
            sentence,
            "each says why under `error` in its place",
        ));
    }
    Ok(())
}

fn open(file: &Path) -> Result<Box<dyn BufRead>, Failure> {
    if file == Path::new("-") {
        return Ok(Box::new(io::stdin().lock()));
    }
    let opened = File::open(file).map_err(|error| unreadable(file, &error))?;
    Ok(Box::new(BufReader::new(opened)))
}

fn name(file: &Path) -> String {
    if file == Path::new("-") {
        "standard input".into()
    } else {
        file.display().to_string()
    }
}

fn unreadable_line(file: &Path, number: usize, error: &io::Error) -> Failure {
    if error.kind() != ErrorKind::InvalidData {
        return unreadable(file, error);
    }
    Failure::refused(
        format!("cannot read line {number} of {}: {error}", name(file)),
        "give a pose in each line, ended by a newline",
    )
}

fn unreadable(file: &Path, error: &io::Error) -> Failure {
    let help = "give a file that exists and may be read, or `-` for standard input";
    Failure::refused(format!("cannot read {}: {error}", name(file)), help)
}
