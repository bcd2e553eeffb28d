//! `leg stop`.

use super::leg_told;
use super::line::{Fresh, LineArgs, RigArgs, shown};
use crate::failure::Failure;

/// Stops the leg, whatever else is going on, and leaves it in hold.
///
/// It is repeated until the leg acknowledges, and works beside another command that drives the leg.
#[derive(Debug, clap::Args)]
pub struct Args {
    #[command(flatten)]
    line: LineArgs,
    #[command(flatten)]
    rig: RigArgs,
    /// Prints JSON instead of a table.
    #[arg(long)]
    json: bool,
}

/// Runs the command.
///
/// # Errors
/// A [`Failure`]: no line to the leg, or no acknowledgement.
pub(super) fn run(args: &Args, verbose: bool) -> Result<(), Failure> {
    let rig = args.rig.load()?;
    let mut line = args.line.open(&rig, Fresh::Homed, verbose)?;
    shown(&mut line.operator, |operator| operator.stop())?;
    leg_told::tell(&mut line.operator, args.json)
}
