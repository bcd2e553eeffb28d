//! `leg jog`.

use crate::connection::{LegArgs, Purpose};
use crate::numbers::{finite, positive};
use crate::options::Options;
use crate::output::print;
use leg_base::failure::Failure;
use leg_firmware::jog::{JogDemand, JogDrive, JogEnd};
use leg_host::jog_report::{self, Finding};
use leg_host::operator::OperatorError;

/// Turns one motor slowly at a low voltage, to see whether its wires are right: the leg must be disarmed.
///
/// Prints what it will do, then what it saw: the counts of all encoders, the tensions, the current; and what does not fit, as
/// swapped wires. The board keeps the bounds; the motor is off in the end, whatever happens. The leg need not be homed.
#[derive(Debug, clap::Args)]
pub(crate) struct Args {
    /// The motor.
    #[arg(value_name = "MOTOR", value_parser = clap::value_parser!(u8).range(1..=3))]
    motor: u8,
    /// How far the tendon is pulled in, mm of its travel: at most 10; a negative travel pays it out.
    #[arg(long, value_name = "MM", value_parser = finite)]
    travel: f64,
    /// The voltage at the motor, V; one that turns it at 2 mm/s if left out.
    #[arg(long, value_name = "V", value_parser = positive)]
    volts: Option<f64>,
    #[command(flatten)]
    leg: LegArgs,
}

pub(crate) fn run(args: &Args, options: Options) -> Result<(), Failure> {
    let mut operator = args.leg.open(Purpose::Calibrate, options)?.operator;
    let settings = operator.settings()?;
    let given = args.volts.map(|volts| volts as f32);
    let demand = JogDemand {
        motor: args.motor,
        travel_m: (args.travel / 1000.0) as f32,
        drive: JogDrive::Voltage(
            given.unwrap_or_else(|| jog_report::slow_voltage_v(args.motor, &settings)),
        ),
    };
    if !options.json {
        print(&jog_report::plan(&demand, &settings))?;
    }
    let (report, telemetry) = operator.jog(&demand)?;
    let findings = jog_report::findings(&report, &settings);
    options.report(&jog_report::json(&report, &findings), || {
        jog_report::text(&report, &findings)
    })?;
    let asked = "jog a motor";
    if telemetry.faults.stopping().any() {
        return Err(OperatorError::Failed(asked, Box::new(telemetry)).failure());
    }
    if report.end == JogEnd::CutOff {
        return Err(OperatorError::StoppedByOtherHost(asked, telemetry.state).failure());
    }
    findings
        .first()
        .map_or(Ok(()), |finding| Err(failed(finding)))
}

fn failed(finding: &Finding) -> Failure {
    Failure::failed(finding.what.clone(), finding.remedy.clone())
}
