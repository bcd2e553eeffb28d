//! `leg disarm`.

use super::leg_told;
use super::line::{Fresh, LineArgs, RigArgs, shown};
use crate::failure::Failure;

/// Lets the tendons out until they barely pull and switches the drivers off; the screws hold.
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
/// A [`Failure`]: no line to the leg, or a leg that refuses.
pub(super) fn run(args: &Args, verbose: bool) -> Result<(), Failure> {
    let rig = args.rig.load()?;
    let mut line = args.line.open(&rig, Fresh::Homed, verbose)?;
    shown(&mut line.operator, |operator| operator.disarm())?;
    leg_told::tell(&mut line.operator, args.json)
}
