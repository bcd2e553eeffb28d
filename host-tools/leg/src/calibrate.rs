//! `leg calibrate`.

mod cells;
mod manual_steps;
mod motors;

pub(crate) use manual_steps::confirm;

use crate::connection::LegArgs;
use crate::leg_commands::home;
use crate::options::Options;
use clap::Subcommand;
use leg_base::failure::Failure;

/// Finds the calibration of load cells, encoders and zero: by known weights, by hand, or by homing.
#[derive(Debug, clap::Args)]
pub(crate) struct Args {
    #[command(subcommand)]
    sensors: SensorKind,
}

#[derive(Debug, Subcommand)]
enum SensorKind {
    Cells(cells::Args),
    Motors(motors::Args),
    /// Finds the zero of the tendons; the same as `leg home`. The leg must hang free, without a payload.
    Zero(LegArgs),
}

pub(crate) fn run(args: &Args, options: Options) -> Result<(), Failure> {
    match &args.sensors {
        SensorKind::Cells(args) => cells::run(args, options),
        SensorKind::Motors(args) => motors::run(args, options),
        SensorKind::Zero(leg) => home(leg, options),
    }
}
