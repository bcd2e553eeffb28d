//! `leg clear`.

use super::leg_told;
use super::line::{Fresh, LineArgs, RigArgs, shown};
use crate::failure::Failure;

/// Clears the faults whose cause is gone.
///
/// A leg that was held stays in hold; one that was off is then disarmed.
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
/// A [`Failure`]: no line to the leg, or a cause that is still there.
pub(super) fn run(args: &Args, verbose: bool) -> Result<(), Failure> {
    let rig = args.rig.load()?;
    let mut line = args.line.open(&rig, Fresh::Homed, verbose)?;
    shown(&mut line.operator, |operator| operator.clear())?;
    leg_told::tell(&mut line.operator, args.json)
}
