//! `leg sensors`.

use super::leg_args::LegArgs;
use super::line::Fresh;
use super::print;
use leg_base::failure::Failure;
use leg_base::json_line::to_line;
use leg_host::sensor_report::SensorReport;

/// Shows what the sensors read, raw and by the calibration of the leg's settings. It looks only.
///
/// Encoders by counts; load cells, motor currents, supply and temperature by code, too. The tensions are those of the
/// settings' calibration, without the tare that homing takes.
#[derive(Debug, clap::Args)]
pub struct Args {
    #[command(flatten)]
    leg: LegArgs,
}

/// Runs the command.
///
/// # Errors
/// A [`Failure`]: no line to the leg.
pub(super) fn run(args: &Args, verbose: bool) -> Result<(), Failure> {
    let operator = &mut args.leg.open(Fresh::Homed, verbose)?.operator;
    let report = SensorReport::of(&operator.sensors()?, &operator.settings()?);
    print(&if args.leg.json {
        to_line(&report)?
    } else {
        report.rows()
    })
}
