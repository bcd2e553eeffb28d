//! `leg log`.

use super::leg_args::LegArgs;
use super::leg_told::to_line;
use super::line::Fresh;
use super::numbers::positive;
use super::{print, progress};
use crate::failure::Failure;
use crate::operator::{Operator, OperatorError};
use crate::recording::{self, TelemetryFile};
use leg_firmware::sensors::TICK_HZ;
use serde::Serialize;
use std::path::PathBuf;
use std::time::Duration;

/// What the serial line carries, with room for replies, Hz.
const RATE_MAX_HZ: f64 = 500.0;

/// Silence after which telemetry is asked for again: another host's greeting ends it.
const STALL_TIME: Duration = Duration::from_millis(200);

/// Such silences without anything between them.
const SILENCES_MAX: u32 = 20;

/// Records what the leg tells of itself, beside whatever else goes on.
///
/// Ctrl-C ends it early, and the file is whole.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// The file: FILE.mcap for Foxglove and PlotJuggler, or FILE.csv.
    #[arg(long, value_name = "FILE")]
    out: PathBuf,
    /// How often, Hz: up to 500; the nearest whole number of ticks is taken.
    #[arg(long, value_name = "HZ", value_parser = rate, default_value = "100")]
    rate: f64,
    /// How long, s.
    #[arg(long = "for", value_name = "SECONDS", value_parser = positive)]
    length: f64,
    #[command(flatten)]
    leg: LegArgs,
}

fn rate(text: &str) -> Result<f64, String> {
    match positive(text)? {
        rate if rate <= RATE_MAX_HZ => Ok(rate),
        _ => Err(format!("the line carries up to {RATE_MAX_HZ} a second")),
    }
}

/// What was recorded.
#[derive(Clone, Copy, Debug, Default, Serialize)]
struct Recorded {
    /// Telemetry in the file.
    count: u64,
    /// Telemetry that did not come.
    lost: u64,
    /// From the first to the last, s.
    length_s: f64,
    /// Between two, s.
    every_s: f64,
}

/// Runs the command.
///
/// # Errors
/// A [`Failure`]: no line to the leg, one that breaks, or a file that cannot be written.
pub(super) fn run(args: &Args, verbose: bool) -> Result<(), Failure> {
    let every_ticks = (f64::from(TICK_HZ) / args.rate).round().max(1.0) as u16;
    let mut operator = args.leg.open(Fresh::Homed, verbose)?.operator;
    let (recorded, ended) = recording::around_telemetry(&args.out, |file| {
        let mut recorded = Recorded {
            every_s: f64::from(every_ticks) / f64::from(TICK_HZ),
            ..Recorded::default()
        };
        let ended = record(&mut operator, every_ticks, args.length, file, &mut recorded);
        match ended {
            // What there is is kept; the user wants it so, or the line broke.
            Err(Ended::Line(error)) => Ok((recorded, Some(error))),
            Err(Ended::File(failure)) => Err(failure),
            Ok(()) => Ok((recorded, None)),
        }
    })?;
    print(&if args.leg.json {
        to_line(&recorded)?
    } else {
        words(&recorded)
    })?;
    match ended {
        None | Some(OperatorError::Interrupted) => Ok(()),
        Some(error) => Err(error.into()),
    }
}

enum Ended {
    Line(OperatorError),
    File(Failure),
}

impl From<OperatorError> for Ended {
    fn from(error: OperatorError) -> Self {
        Self::Line(error)
    }
}

fn record(
    operator: &mut Operator,
    every_ticks: u16,
    length_s: f64,
    file: &mut TelemetryFile,
    recorded: &mut Recorded,
) -> Result<(), Ended> {
    let bar = progress::spinner("times");
    operator.stream(every_ticks)?;
    let stall = STALL_TIME.max(Duration::from_secs_f64(4.0 * recorded.every_s));
    let mut first_tick = None;
    let mut silences = 0;
    while recorded.length_s < length_s {
        let Some(told) = operator.streamed(stall)? else {
            silences += 1;
            if silences > SILENCES_MAX {
                let name = operator.name();
                return Err(OperatorError::Silent { name }.into());
            }
            operator.stream(every_ticks)?;
            continue;
        };
        silences = 0;
        let tick = told.telemetry.tick;
        let ticks = tick.wrapping_sub(*first_tick.get_or_insert(tick));
        file.take(&told.telemetry)
            .map_err(|error| Ended::File(Failure::from_error(&error)))?;
        recorded.count += 1;
        let due = u64::from(ticks / u32::from(every_ticks)) + 1;
        recorded.lost = due.saturating_sub(recorded.count);
        recorded.length_s = f64::from(ticks) / f64::from(TICK_HZ);
        bar.inc(1);
    }
    bar.finish_and_clear();
    operator.stream(0)?;
    Ok(())
}

fn words(recorded: &Recorded) -> String {
    format!(
        "{} times in {:.3} s, every {:.3} ms; {} lost on the way\n",
        recorded.count,
        recorded.length_s,
        recorded.every_s * 1000.0,
        recorded.lost
    )
}
