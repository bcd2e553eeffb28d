//! `leg log`.

mod recorded;

use super::leg_args::LegArgs;
use super::line::Fresh;
use super::numbers::{positive, seconds};
use super::{print, progress};
use leg_base::failure::Failure;
use leg_base::json_line::to_line;
use leg_firmware::sensors::TICK_HZ;
use leg_host::operator::{Operator, OperatorError};
use leg_host::recording::{self, TelemetryFile};
use recorded::{Counter, Foreign};
use std::path::PathBuf;
use std::time::Duration;

/// What the serial line carries, with room for replies, Hz.
const RATE_MAX_HZ: f64 = 500.0;

/// Silence after which telemetry is asked for again: another host may have ended it.
const STALL_TIME: Duration = Duration::from_millis(200);

/// Such silences without anything between them.
const SILENCES_MAX: u32 = 20;

/// Records what the leg tells of itself, beside whatever else goes on; not on CAN.
///
/// Ctrl-C ends it early, and the file is whole.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// The file: FILE.mcap for Foxglove and PlotJuggler, or FILE.csv.
    #[arg(long, value_name = "FILE")]
    out: PathBuf,
    /// How often, Hz: 0.1221 to 500; the nearest whole number of ticks is asked for, and how often the leg told is said in the
    /// end.
    #[arg(long = "rate", value_name = "HZ", value_parser = rate, default_value = "100")]
    every_ticks: u16,
    /// How long, s.
    #[arg(long = "for", value_name = "SECONDS", value_parser = seconds)]
    length: Duration,
    #[command(flatten)]
    leg: LegArgs,
}

/// How many ticks are from one to the next at a rate, Hz.
fn rate(text: &str) -> Result<u16, String> {
    let rate_hz = positive(text)?;
    if rate_hz > RATE_MAX_HZ {
        return Err(format!("the line carries up to {RATE_MAX_HZ} a second"));
    }
    let ticks = (f64::from(TICK_HZ) / rate_hz).round();
    if ticks > f64::from(u16::MAX) {
        return Err("a leg tells of itself at least every 8.19 s, at 0.1221 Hz".into());
    }
    Ok(ticks as u16)
}

/// Runs the command.
///
/// # Errors
/// A [`Failure`]: no line to the leg, one that breaks, or a file that cannot be written.
pub(super) fn run(args: &Args, verbose: bool) -> Result<(), Failure> {
    let mut operator = args.leg.open(Fresh::Homed, verbose)?.operator;
    let (recorded, ended) = recording::around_telemetry(&args.out, |file| {
        let mut counter = Counter::new(args.every_ticks);
        let bar = progress::spinner("times");
        let ended = record(&mut operator, args, file, &mut counter, || bar.inc(1));
        bar.finish_and_clear();
        let ended = let_go(&mut operator, ended);
        let recorded = counter.recorded(operator.damaged());
        match ended {
            Err(Ended::File(failure)) => Err(failure),
            // What there is is kept.
            ended => Ok((recorded, ended)),
        }
    })?;
    print(&if args.leg.json {
        to_line(&recorded)?
    } else {
        recorded.words()
    })?;
    ended.or_else(Ended::told)
}

/// What ends a recording before its time.
enum Ended {
    Line(OperatorError),
    File(Failure),
    Foreign(Foreign),
}

impl From<OperatorError> for Ended {
    fn from(error: OperatorError) -> Self {
        Self::Line(error)
    }
}

impl Ended {
    fn told(self) -> Result<(), Failure> {
        Err(match self {
            // The user wants it so.
            Self::Line(OperatorError::Interrupted) => return Ok(()),
            Self::Line(error) => error.into(),
            Self::File(failure) => failure,
            Self::Foreign(Foreign::Restarted) => Failure::missed(
                "the leg started anew, and its time begins again",
                "the file ends there; log again for what follows",
            ),
            Self::Foreign(Foreign::Every(s)) => Failure::missed(
                format!(
                    "another host has asked the leg to tell of itself every {} ms",
                    s * 1000.0
                ),
                "the file ends there; end the other `leg log`, or give both the same --rate",
            ),
        })
    }
}

/// Lets the telemetry end, unless it is another host's now, or nothing gets through.
fn let_go(operator: &mut Operator, ended: Result<(), Ended>) -> Result<(), Ended> {
    match ended {
        Ok(()) => Ok(operator.end_stream()?),
        Err(Ended::Foreign(Foreign::Every(_))) => ended,
        Err(Ended::Line(ref error)) if !matches!(error, OperatorError::Interrupted) => ended,
        Err(_) => {
            // Worse is told already.
            let _ = operator.end_stream();
            ended
        }
    }
}

fn record(
    operator: &mut Operator,
    args: &Args,
    file: &mut TelemetryFile,
    counter: &mut Counter,
    mut written: impl FnMut(),
) -> Result<(), Ended> {
    operator.stream(args.every_ticks)?;
    let every = Duration::from_secs(1) * u32::from(args.every_ticks) / u32::from(TICK_HZ);
    let stall = STALL_TIME.max(4 * every);
    let length_ticks = args.length.as_secs_f64() * f64::from(TICK_HZ);
    let mut silences = 0;
    while (counter.ticks() as f64) < length_ticks {
        let Some(told) = operator.streamed(stall)? else {
            silences += 1;
            if silences > SILENCES_MAX {
                let name = operator.name();
                return Err(OperatorError::Silent { name }.into());
            }
            operator.stream(args.every_ticks)?;
            continue;
        };
        silences = 0;
        counter.take(&told).map_err(Ended::Foreign)?;
        file.take(&told.telemetry)
            .map_err(|error| Ended::File(Failure::from_error(&error)))?;
        written();
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::rate;

    #[test]
    fn a_rate_that_a_leg_cannot_tell_at_is_refused() {
        assert_eq!(rate("500"), Ok(16));
        assert_eq!(rate("0.1221"), Ok(65_520));
        for wrong in ["0.05", "0.12", "501", "1e-300"] {
            assert!(rate(wrong).is_err(), "{wrong}");
        }
    }
}
