//! `leg export`.

use super::not_printed;
use leg_base::atomic_file;
use leg_base::failure::Failure;
use leg_model::{Quantity, Query};
use leg_model_tools::mjcf::{HeldLeg, Mjcf, MjcfError};
use leg_rig::line_error::LineError;
use leg_rig::rig_file::RigFile;
use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

const AZIMUTH: &str = "--azimuth-deg";
const TILT: &str = "--tilt-deg";
const PAYLOAD: &str = "--payload-kg";
const PRETENSION: &str = "--pretension-n";

/// Writes the rig for another program.
#[derive(Debug, clap::Args)]
pub struct Args {
    #[command(subcommand)]
    format: Format,
}

#[derive(Debug, clap::Subcommand)]
enum Format {
    Mjcf(MjcfArgs),
}

/// Writes the rig as a MuJoCo model, its tendons made to hold the loaded leg at a pose.
///
/// MuJoCo's springs are straight: the stiffness of each tendon is the tangent of its curve where the rig file's
/// `stiffness_at` reads it. The keyframe `held` is the pose. Joint and shaft do not stretch.
#[derive(Debug, clap::Args)]
struct MjcfArgs {
    /// The rig file or a ready rig's name; the paper's rig if left out.
    #[arg(long, value_name = "FILE")]
    rig: Option<PathBuf>,
    /// Direction towards which the leg leans.
    #[arg(
        long,
        value_name = "DEG",
        default_value_t = 0.0,
        allow_negative_numbers = true
    )]
    azimuth_deg: f64,
    /// How far, -60 to 60.
    #[arg(
        long,
        value_name = "DEG",
        default_value_t = 0.0,
        allow_negative_numbers = true
    )]
    tilt_deg: f64,
    /// Mass at the tip.
    #[arg(
        long,
        value_name = "KG",
        default_value_t = 0.0,
        allow_negative_numbers = true
    )]
    payload_kg: f64,
    /// Pretension; the rig file's if left out.
    #[arg(
        long,
        alias = "level-n",
        value_name = "N",
        allow_negative_numbers = true
    )]
    pretension_n: Option<f64>,
    /// The file to write; standard output if left out.
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
}

/// Runs the command.
///
/// # Errors
/// A [`Failure`]: a rig file that is refused, a pose that the tendons cannot hold, or a file that cannot be written.
pub(super) fn run(args: &Args) -> Result<(), Failure> {
    let Format::Mjcf(args) = &args.format;
    args.check()?;
    let rig = RigFile::load(args.rig.as_deref())?;
    let query = rig.query(args.azimuth_deg, args.tilt_deg, args.payload_kg);
    let query = Query {
        pretension_n: args.pretension_n.unwrap_or(rig.pretension_n),
        ..query
    };
    let model = HeldLeg::new(&rig.parameters, &query)
        .and_then(|leg| Mjcf::new(&leg))
        .map_err(|error| refused(&error))?;
    match &args.out {
        None => model.write(io::stdout().lock()).map_err(not_printed),
        Some(path) => save(&model, path),
    }
}

impl MjcfArgs {
    fn check(&self) -> Result<(), Failure> {
        let numbers = [
            (AZIMUTH, Some(self.azimuth_deg)),
            (TILT, Some(self.tilt_deg)),
            (PAYLOAD, Some(self.payload_kg)),
            (PRETENSION, self.pretension_n),
        ];
        for (flag, number) in numbers {
            if number.is_some_and(|number| !number.is_finite()) {
                let sentence = format!("{flag} must be a finite number");
                return Err(Failure::refused(sentence, "give a number such as 1.5"));
            }
        }
        Ok(())
    }
}

/// The model's words at the flag that gives the value.
fn refused(error: &MjcfError) -> Failure {
    let &MjcfError::Model(LineError::Refused { quantity, reason }) = error else {
        return Failure::from_error(error);
    };
    let (what, help) = match quantity {
        Quantity::Azimuth => (AZIMUTH, "give -3600 to 3600"),
        Quantity::Tilt => (TILT, "give -60 to 60"),
        Quantity::Payload => (PAYLOAD, "give 0 to 1e6"),
        Quantity::Pretension => (
            PRETENSION,
            "give a pretension inside the bounds of the rig file",
        ),
        Quantity::Tension => (
            "the tension of a tendon at this pretension",
            "give a lower --pretension-n or --payload-kg, or a rig file with a constant `stiffness_n_per_m`",
        ),
        _ => return Failure::from_error(error),
    };
    Failure::refused(format!("{what} {reason}"), help)
}

/// Writes the file whole or not at all.
fn save(model: &Mjcf, path: &Path) -> Result<(), Failure> {
    let written = atomic_file::replace(path, |new| {
        let mut file = BufWriter::new(File::create(new)?);
        model.write(&mut file)?;
        file.flush()
    });
    written.map_err(|error| {
        let sentence = format!("cannot write {}: {error}", path.display());
        Failure::refused(
            sentence,
            "name another file with --out, in a directory that may be written to",
        )
    })
}
