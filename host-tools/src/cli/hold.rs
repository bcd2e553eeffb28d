//! `leg hold`.

use super::leg_told;
use super::line::{Fresh, LineArgs, RigArgs, shown};
use crate::failure::Failure;
use crate::operator::Goal;

/// Holds the leg where it is, its tendons taut.
///
/// It is armed first if it is homed and disarmed.
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
/// A [`Failure`]: no line to the leg, a leg that refuses, or a fault on the way.
pub(super) fn run(args: &Args, verbose: bool) -> Result<(), Failure> {
    let rig = args.rig.load()?;
    let mut line = args.line.open(&rig, Fresh::Homed, verbose)?;
    shown(&mut line.operator, |operator| {
        operator.reach(&Goal::default())
    })?;
    leg_told::tell(&mut line.operator, args.json)
}
