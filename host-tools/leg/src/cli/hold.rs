//! `leg hold`.

use super::leg_args::LegArgs;
use leg_base::failure::Failure;
use leg_host::operator::Goal;

/// Holds the leg where it is, its tendons taut.
///
/// It is armed first if it is homed and disarmed.
#[derive(Debug, clap::Args)]
pub struct Args {
    #[command(flatten)]
    leg: LegArgs,
}

/// Runs the command.
///
/// # Errors
/// A [`Failure`]: no line to the leg, a leg that refuses, or a fault on the way.
pub(super) fn run(args: &Args, verbose: bool) -> Result<(), Failure> {
    args.leg
        .command(verbose, |operator| operator.reach(&Goal::default()))
}
