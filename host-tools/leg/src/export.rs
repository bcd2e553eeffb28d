//! `leg export`.

use crate::numbers::{azimuth_deg, body_kg, finite, payload_kg, radius_m, tilt_deg};
use crate::output::{load_rig, write};
use clap::value_parser;
use leg_base::failure::Failure;
use leg_model::{Quantity, Query};
use leg_model_tools::leg_shape::{Body, ShapeError};
use leg_model_tools::line_error::LineError;
use leg_model_tools::mjcf::{HeldLeg, Mjcf, MjcfError};
use leg_model_tools::urdf::Urdf;
use leg_rig::rig_file::RigFile;
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
    Urdf(UrdfArgs),
}

/// Writes the rig as a URDF robot: two revolute joints a leg, bodies of primitives, inertias and limits.
///
/// URDF has no tendons: the joints are those of a universal joint, at zero where the leg has the pose that is given; a comment
/// says which angles are which pose. With --legs the legs are spread around a body, which a simulator may let float.
#[derive(Debug, clap::Args)]
struct UrdfArgs {
    /// The rig file or the name of a ready rig; the paper's rig if left out.
    #[arg(long, value_name = "FILE")]
    rig: Option<PathBuf>,
    /// The azimuth towards which each leg leans where its joints are at zero, degrees, -3600 to 3600.
    #[arg(long, value_name = "DEG", default_value = "0", value_parser = azimuth_deg)]
    azimuth_deg: f64,
    /// Its tilt from the vertical, degrees, within that of the rig file.
    #[arg(long, value_name = "DEG", default_value = "0", value_parser = tilt_deg)]
    tilt_deg: f64,
    /// Mass at the tip, kg.
    #[arg(long, value_name = "KG", default_value = "0", value_parser = payload_kg)]
    payload_kg: f64,
    #[command(flatten)]
    several: Several,
    /// The file to write; standard output if left out.
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
}

/// Writes the rig as a MuJoCo model whose tendons hold the loaded leg at a pose.
///
/// MuJoCo's springs are straight: the stiffness of each tendon is the tangent of its curve at its tension. The keyframe `held`
/// is the pose; the controls are what each motor reels in from there. Inertia and damping are those of the simulated leg. Joint
/// and shaft do not stretch. With --legs the legs stand around a body that floats.
#[derive(Debug, clap::Args)]
struct MjcfArgs {
    /// The rig file or the name of a ready rig; the paper's rig if left out.
    #[arg(long, value_name = "FILE")]
    rig: Option<PathBuf>,
    /// The azimuth towards which the leg leans, degrees, -3600 to 3600.
    #[arg(long, value_name = "DEG", default_value = "0", value_parser = azimuth_deg)]
    azimuth_deg: f64,
    /// The tilt from the vertical, degrees, -60 to 60.
    #[arg(long, value_name = "DEG", default_value = "0", value_parser = tilt_deg)]
    tilt_deg: f64,
    /// Mass at the tip, kg.
    #[arg(long, value_name = "KG", default_value = "0", value_parser = payload_kg)]
    payload_kg: f64,
    /// Pretension, N; that of the rig if left out.
    #[arg(long, alias = "level-n", value_name = "N", value_parser = finite)]
    pretension_n: Option<f64>,
    #[command(flatten)]
    several: Several,
    /// The file to write; standard output if left out.
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
}

/// Several legs on a body that may float.
#[derive(Debug, clap::Args)]
struct Several {
    /// Legs around a body, 2 to 12; one leg without a body if left out.
    #[arg(long, value_name = "N", requires = "radius_m", value_parser = value_parser!(u32).range(2..=12))]
    legs: Option<u32>,
    /// From the body's centre to the legs' joint centres, m, 0.01 to 10.
    #[arg(long, alias = "radius", value_name = "M", requires = "legs", value_parser = radius_m)]
    radius_m: Option<f64>,
    /// Mass of the body without its legs, kg, 0.001 to 1000; that of its legs together, without payloads, if left out.
    #[arg(long, value_name = "KG", requires = "legs", value_parser = body_kg)]
    body_kg: Option<f64>,
}

impl Several {
    fn body(&self, rig: &RigFile) -> Result<Option<Body>, ShapeError> {
        let around = self.legs.zip(self.radius_m);
        around
            .map(|(legs, radius_m)| Body::new(rig, legs, radius_m, self.body_kg))
            .transpose()
    }
}

pub(crate) fn run(args: &Args) -> Result<(), Failure> {
    match &args.format {
        Format::Mjcf(args) => write_mjcf(args),
        Format::Urdf(args) => write_urdf(args),
    }
}

fn write_urdf(args: &UrdfArgs) -> Result<(), Failure> {
    let rig = load_rig(args.rig.as_deref())?;
    let pose = [args.azimuth_deg, args.tilt_deg];
    let several = args.several.body(&rig).map_err(Failure::from_error)?;
    let robot = Urdf::new(&rig, args.payload_kg, pose, several).map_err(Failure::from_error)?;
    let mut text = Vec::new();
    let written = robot.write(&mut text);
    written.map_err(Failure::from_error)?;
    write(args.out.as_deref(), &String::from_utf8_lossy(&text))
}

fn write_mjcf(args: &MjcfArgs) -> Result<(), Failure> {
    let rig = load_rig(args.rig.as_deref())?;
    let query = rig.query(args.azimuth_deg, args.tilt_deg, args.payload_kg);
    let query = Query {
        pretension_n: args.pretension_n.unwrap_or(rig.pretension_n),
        ..query
    };
    let several = args.several.body(&rig).map_err(Failure::from_error)?;
    let model = HeldLeg::new(&rig, &query)
        .and_then(|leg| Mjcf::new(&leg, several))
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
