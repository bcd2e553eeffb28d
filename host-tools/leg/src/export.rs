//! `leg export`.

use crate::numbers::{azimuth_deg, finite, payload_kg, tilt_deg};
use crate::output::{load_rig, write};
use leg_base::failure::Failure;
use leg_model::{Quantity, Query};
use leg_model_tools::line_error::LineError;
use leg_model_tools::mjcf::{HeldLeg, Mjcf, MjcfError};
use std::path::PathBuf;

/// Writes the rig for another program.
#[derive(Debug, clap::Args)]
pub(crate) struct Args {
    #[command(subcommand)]
    format: Format,
}

#[derive(Debug, clap::Subcommand)]
enum Format {
    Mjcf(MjcfArgs),
}

/// Writes the rig as a MuJoCo model whose tendons hold the loaded leg at a pose.
///
/// MuJoCo's springs are straight: the stiffness of each tendon is the tangent of its curve where the rig file's
/// `stiffness_at` reads it. The keyframe `held` is the pose. Joint and shaft do not stretch.
#[derive(Debug, clap::Args)]
struct MjcfArgs {
    /// The rig file or the name of a ready rig; the paper's rig if left out.
    #[arg(long, value_name = "FILE")]
    rig: Option<PathBuf>,
    /// The azimuth towards which the leg leans, degrees, -3600 to 3600.
    #[arg(long, value_name = "DEG", default_value = "0", value_parser = azimuth_deg, allow_negative_numbers = true)]
    azimuth_deg: f64,
    /// The tilt from the vertical, degrees, -60 to 60.
    #[arg(long, value_name = "DEG", default_value = "0", value_parser = tilt_deg, allow_negative_numbers = true)]
    tilt_deg: f64,
    /// Mass at the tip, kg.
    #[arg(long, value_name = "KG", default_value = "0", value_parser = payload_kg, allow_negative_numbers = true)]
    payload_kg: f64,
    /// Pretension, N; that of the rig if left out.
    #[arg(long, alias = "level-n", value_name = "N", value_parser = finite, allow_negative_numbers = true)]
    pretension_n: Option<f64>,
    /// The file to write; standard output if left out.
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
}

pub(crate) fn run(args: &Args) -> Result<(), Failure> {
    let Format::Mjcf(args) = &args.format;
    let rig = load_rig(args.rig.as_deref())?;
    let query = rig.query(args.azimuth_deg, args.tilt_deg, args.payload_kg);
    let query = Query {
        pretension_n: args.pretension_n.unwrap_or(rig.pretension_n),
        ..query
    };
    let model = HeldLeg::new(&rig.parameters, &query)
        .and_then(|leg| Mjcf::new(&leg))
        .map_err(|error| refused(&error))?;
    let mut text = Vec::new();
    let written = model.write(&mut text);
    written.map_err(Failure::from_error)?;
    write(args.out.as_deref(), &String::from_utf8_lossy(&text))
}

/// The model's refusal, named by the option that gives the value.
fn refused(error: &MjcfError) -> Failure {
    let &MjcfError::Model(LineError::Refused(quantity, reason)) = error else {
        return Failure::from_error(error);
    };
    let (what, help) = match quantity {
        Quantity::Pretension => (
            "--pretension-n",
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
