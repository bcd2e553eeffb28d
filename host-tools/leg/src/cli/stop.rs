//! `leg stop`.

use super::leg_args::LegArgs;
use leg_base::failure::Failure;

/// Stops the leg, whatever else is going on, and leaves it in hold.
///
/// It is repeated until the leg acknowledges, and works beside another command that drives the leg, on CAN as well.
#[derive(Debug, clap::Args)]
pub struct Args {
    #[command(flatten)]
    leg: LegArgs,
}

/// Runs the command.
///
/// # Errors
/// A [`Failure`]: no line to the leg, or no acknowledgement.
pub(super) fn run(args: &Args, verbose: bool) -> Result<(), Failure> {
    args.leg.stop(verbose)
}
