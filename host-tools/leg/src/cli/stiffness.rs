//! `leg stiffness`.

use super::leg_args::LegArgs;
use super::numbers::{azimuth_deg, positive, towards};
use leg_base::failure::Failure;
use leg_host::operator::{Demand, Goal};

/// Makes the leg as stiff as demanded where it is, and leaves it in hold.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// Bending stiffness, N·m/rad: the smallest, unless --towards says otherwise.
    #[arg(value_name = "NM_PER_RAD", value_parser = positive, allow_negative_numbers = true)]
    stiffness: f64,
    /// Azimuth of the push that shall meet it, degrees.
    #[arg(long, value_name = "DEG", value_parser = azimuth_deg, allow_negative_numbers = true)]
    towards: Option<f64>,
    #[command(flatten)]
    leg: LegArgs,
}

/// Runs the command.
///
/// # Errors
/// A [`Failure`]: no line to the leg, a leg that refuses, or bounds that do not allow the stiffness.
pub(super) fn run(args: &Args, verbose: bool) -> Result<(), Failure> {
    let goal = Goal {
        direction: None,
        demand: Some(Demand::Stiffness(
            args.stiffness as f32,
            args.towards.map(towards),
        )),
    };
    args.leg.command(verbose, |operator| operator.reach(&goal))
}
