//! `leg disarm`.

use super::leg_args::LegArgs;
use leg_base::failure::Failure;

/// Lets the tendons out until they barely pull and switches the drivers off; the screws hold.
#[derive(Debug, clap::Args)]
pub struct Args {
    #[command(flatten)]
    leg: LegArgs,
}

/// Runs the command.
///
/// # Errors
/// A [`Failure`]: no line to the leg, or a leg that refuses.
pub(super) fn run(args: &Args, verbose: bool) -> Result<(), Failure> {
    args.leg.command(verbose, |operator| operator.disarm())
}
