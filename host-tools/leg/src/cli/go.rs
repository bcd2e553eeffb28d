//! `leg move`.

use super::leg_args::LegArgs;
use super::numbers::{azimuth_deg, direction, positive, tilt_deg, towards};
use leg_base::failure::Failure;
use leg_host::operator::{Demand, Goal};

/// Moves the leg and leaves it in hold.
///
/// It is armed first if it is homed and disarmed; a hold that no fault began ends.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// Direction towards which the leg shall lean, degrees.
    #[arg(long, value_name = "DEG", value_parser = azimuth_deg, allow_negative_numbers = true)]
    azimuth: f64,
    /// How far, degrees; a negative tilt is the opposite azimuth.
    #[arg(long, value_name = "DEG", value_parser = tilt_deg, allow_negative_numbers = true)]
    tilt: f64,
    /// Pretension, N; as before if left out.
    #[arg(long, alias = "level", value_name = "N", value_parser = positive, allow_negative_numbers = true, conflicts_with = "stiffness")]
    pretension: Option<f64>,
    /// Bending stiffness, N·m/rad, in the place of a pretension: the smallest, unless --towards says otherwise.
    #[arg(long, value_name = "NM_PER_RAD", value_parser = positive, allow_negative_numbers = true)]
    stiffness: Option<f64>,
    /// Azimuth of the push that shall meet the stiffness, degrees.
    #[arg(long, value_name = "DEG", value_parser = azimuth_deg, allow_negative_numbers = true, requires = "stiffness")]
    towards: Option<f64>,
    #[command(flatten)]
    leg: LegArgs,
}

impl Args {
    fn goal(&self) -> Goal {
        let pretension = self
            .pretension
            .map(|pretension_n| Demand::Pretension(pretension_n as f32));
        let stiffness = self
            .stiffness
            .map(|demand| Demand::Stiffness(demand as f32, self.towards.map(towards)));
        Goal {
            direction: Some(direction(self.azimuth, self.tilt)),
            demand: pretension.or(stiffness),
        }
    }
}

/// Runs the command.
///
/// # Errors
/// A [`Failure`]: no line to the leg, a leg that refuses, or what keeps it from the goal.
pub(super) fn run(args: &Args, verbose: bool) -> Result<(), Failure> {
    args.leg
        .command(verbose, |operator| operator.reach(&args.goal()))
}
