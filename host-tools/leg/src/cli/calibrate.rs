//! `leg calibrate`.

mod cells;
mod hand;
mod motors;

use super::home;
use clap::Subcommand;
use leg_base::failure::Failure;

/// Finds out what the sensors' codes and counts mean, with known weights, by hand, or by homing.
#[derive(Debug, clap::Args)]
pub struct Args {
    #[command(subcommand)]
    what: What,
}

#[derive(Debug, Subcommand)]
enum What {
    Cells(cells::Args),
    Motors(motors::Args),
    /// Finds the zero of the tendons: the same as `leg home`. The leg has to hang free, without a payload.
    Zero(home::Args),
}

/// Runs the command.
///
/// # Errors
/// A [`Failure`]: no line to the leg, drivers that are on, or sensors that do not do as they should.
pub(super) fn run(args: &Args, verbose: bool) -> Result<(), Failure> {
    match &args.what {
        What::Cells(args) => cells::run(args, verbose),
        What::Motors(args) => motors::run(args, verbose),
        What::Zero(args) => home::run(args, verbose),
    }
}
