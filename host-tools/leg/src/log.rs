//! `leg log`.

mod counter;

use crate::connection::{LegArgs, Purpose};
use crate::numbers::{positive, seconds};
use crate::options::Options;
use crate::output::{about_now, note_unfinished, wall_time_s};
use crate::progress;
use counter::{Restarted, SampleCounter};
use leg_base::failure::Failure;
use leg_firmware::sensors::TICK_HZ;
use leg_host::operator::{Operator, OperatorError};
use leg_host::recording::{self, Recording, RecordingError};
use std::path::PathBuf;
use std::time::Duration;

/// What the serial line carries, with room for replies, Hz.
const RATE_MAX_HZ: f64 = 500.0;

/// Silence after which telemetry is requested again: another host may have ended it.
const STALL_TIME: Duration = Duration::from_millis(200);

/// Such silences in a row, after which the leg counts as silent.
const SILENCES_MAX: u32 = 20;

/// Records the leg's telemetry, beside other commands; not on CAN.
///
/// Another `leg log` may run beside it, at its own rate. Ctrl-C ends the recording early; the file is whole. Until then it is FILE.part.mcap or FILE.part.csv, of which at most the
/// last second is missing when the command is killed.
#[derive(Debug, clap::Args)]
pub(crate) struct Args {
    /// The file: FILE.mcap for Foxglove and PlotJuggler, or FILE.csv.
    #[arg(long, value_name = "FILE")]
    out: PathBuf,
    /// Telemetry per second, Hz, 0.1221 to 500, rounded to a whole number of ticks; the rate that was reached is printed at
    /// the end.
    #[arg(long = "rate", value_name = "HZ", value_parser = rate, default_value = "100")]
    every_ticks: u16,
    /// Length of the recording, s.
    #[arg(long = "for", value_name = "SECONDS", value_parser = seconds)]
    length: Duration,
    #[command(flatten)]
    leg: LegArgs,
}

/// Ticks from one telemetry to the next at a rate, Hz.
fn rate(text: &str) -> Result<u16, String> {
    let rate_hz = positive(text)?;
    if rate_hz > RATE_MAX_HZ {
        return Err(format!("the line carries up to {RATE_MAX_HZ} a second"));
    }
    let ticks = (f64::from(TICK_HZ) / rate_hz).round();
    if ticks > f64::from(u16::MAX) {
        return Err("a leg reports at least every 8.19 s, at 0.1221 Hz".into());
    }
    Ok(ticks as u16)
}

pub(crate) fn run(args: &Args, options: Options) -> Result<(), Failure> {
    let mut operator = args.leg.open(Purpose::Use, options)?.operator;
    note_unfinished(&args.out);
    let about = about_now(operator.name());
    let settings = operator.settings()?;
    let (recorded, ended) = recording::record(&args.out, &about, &settings, |file| {
        let mut counter = SampleCounter::new(args.every_ticks);
        let bar = progress::counter("times");
        let ended = record(&mut operator, args, file, &mut counter, || bar.inc(1));
        bar.finish_and_clear();
        let ended = match end_stream(&mut operator, ended) {
            Err(Ended::File(error)) => return Err(error),
            // Ctrl-C is how the user ends it.
            Ok(()) | Err(Ended::Line(OperatorError::Cancelled)) => Ok(()),
            // What was recorded until then is kept.
            Err(Ended::Line(error)) => Err(error.into()),
            Err(Ended::Restarted(restarted)) => Err(restarted.into()),
        };
        Ok((counter.recorded(operator.damaged_frames()), ended))
    })?;
    options.report(&recorded, || recorded.text())?;
    ended
}

/// What ends a recording before its time.
enum Ended {
    Line(OperatorError),
    File(RecordingError),
    Restarted(Restarted),
}

impl From<OperatorError> for Ended {
    fn from(error: OperatorError) -> Self {
        Self::Line(error)
    }
}

/// Ends the telemetry, unless nothing gets through. Another log asks for its own again.
fn end_stream(operator: &mut Operator, ended: Result<(), Ended>) -> Result<(), Ended> {
    match ended {
        Ok(()) => Ok(operator.end_stream()?),
        Err(Ended::Line(ref error)) if !matches!(error, OperatorError::Cancelled) => ended,
        Err(_) => {
            // The first error is the one to report.
            let _ = operator.end_stream();
            ended
        }
    }
}

fn record(
    operator: &mut Operator,
    args: &Args,
    file: &mut Recording,
    counter: &mut SampleCounter,
    mut written: impl FnMut(),
) -> Result<(), Ended> {
    operator.start_stream(args.every_ticks)?;
    let every = Duration::from_secs(1) * u32::from(args.every_ticks) / u32::from(TICK_HZ);
    let stall = STALL_TIME.max(4 * every);
    let length_ticks = args.length.as_secs_f64() * f64::from(TICK_HZ);
    let mut silences = 0;
    while (counter.ticks() as f64) < length_ticks {
        let Some(reply) = operator.next_streamed(stall)? else {
            silences += 1;
            if silences > SILENCES_MAX {
                return Err(OperatorError::NoAnswer(operator.name().into()).into());
            }
            operator.start_stream(args.every_ticks)?;
            continue;
        };
        silences = 0;
        let taken = counter.take(reply.number, reply.telemetry.tick);
        let taken = taken.map_err(Ended::Restarted)?;
        if taken.ask_again {
            operator.start_stream(args.every_ticks)?;
        }
        if !taken.due {
            continue;
        }
        let damaged = operator.damaged_frames();
        let recorded = file.take_telemetry(&reply.telemetry, wall_time_s(operator), damaged);
        recorded.map_err(Ended::File)?;
        written();
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::rate;

    #[test]
    fn a_rate_that_no_leg_serves_is_refused() {
        assert_eq!(rate("500"), Ok(16));
        assert_eq!(rate("0.1221"), Ok(65_520));
        for wrong in ["0.05", "0.12", "501", "1e-300"] {
            assert!(rate(wrong).is_err(), "{wrong}");
        }
    }
}
