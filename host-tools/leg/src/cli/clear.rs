//! `leg clear`.

use super::leg_args::LegArgs;
use leg_base::failure::Failure;

/// Clears the faults whose cause is gone.
///
/// A leg that was held stays in hold; one that was off is then disarmed.
#[derive(Debug, clap::Args)]
pub struct Args {
    #[command(flatten)]
    leg: LegArgs,
}

/// Runs the command.
///
/// # Errors
/// A [`Failure`]: no line to the leg, or a cause that is still there.
pub(super) fn run(args: &Args, verbose: bool) -> Result<(), Failure> {
    args.leg.command(verbose, |operator| operator.clear())
}
