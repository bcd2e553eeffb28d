//! `leg sensors`.

use crate::connection::{LegArgs, Purpose};
use crate::options::Options;
use leg_base::failure::Failure;
use leg_host::sensor_report::{json, text};

/// Shows what the sensors read, raw and in SI units. Read-only.
///
/// Encoders give counts; load cells, motor currents, supply and temperature give codes. The tensions are those of the
/// calibration in the leg's settings, without the tare of homing. The zero of each current is what its output read while the drivers
/// were off after the start.
#[derive(Debug, clap::Args)]
pub(crate) struct Args {
    #[command(flatten)]
    leg: LegArgs,
}

pub(crate) fn run(args: &Args, options: Options) -> Result<(), Failure> {
    let mut operator = args.leg.open(Purpose::Use, options)?.operator;
    let (reading, settings) = (operator.sensors()?, operator.settings()?);
    options.report(&json(&reading, &settings), || text(&reading, &settings))
}
