//! `leg home`.

use super::leg_args::LegArgs;
use super::line::Fresh;
use super::print;
use leg_base::failure::Failure;
use leg_base::json_line::to_line;
use leg_firmware::telemetry::Telemetry;
use leg_host::leg_report::{self, LegReport};
use serde::Serialize;

/// Lets the leg find its zero and leaves it in hold, straight down.
///
/// It has to hang free, without a payload. One that is held is disarmed first.
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
    let homed = args
        .leg
        .drive(Fresh::Slack, verbose, |operator| operator.home())?;
    print(&report(&homed, args.leg.json)?)
}

/// What homing found, for people or machines.
pub(super) fn report(telemetry: &Telemetry<f32>, json: bool) -> Result<String, Failure> {
    if json {
        return to_line(&HomeReport {
            leg: LegReport::of(telemetry),
            unstretched_at_zero_m: telemetry.unstretched_at_zero_m,
        });
    }
    let [a, b, c] = telemetry.unstretched_at_zero_m.map(|m| m * 1000.0);
    Ok(format!(
        "{}zero       {a:.3}  {b:.3}  {c:.3} mm of tendon when the board started\n",
        leg_report::rows(telemetry)
    ))
}

#[derive(Serialize)]
struct HomeReport {
    #[serde(flatten)]
    leg: LegReport,
    unstretched_at_zero_m: [f32; 3],
}
