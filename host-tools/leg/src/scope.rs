//! `leg scope`.

use crate::connection::{LegArgs, Purpose};
use crate::options::Options;
use crate::output::{about_now, chart_line, not_saved, wall_time_s};
use leg_base::description::faults;
use leg_base::failure::Failure;
use leg_base::json_object;
use leg_base::tick_time::seconds;
use leg_bench::recorder_charts;
use leg_host::operator::{Operator, Scope};
use leg_host::recording::{self, About, Recording, RecordingError};
use leg_rig::recorded_signals;
use std::path::{Path, PathBuf};

/// Reads the board's recorder: the last ticks before a fault, all 8000 a second.
///
/// The recorder keeps the signals that the leg's settings choose (`recorded` in `[control]` of the rig file), three of them for
/// 0.2 s, more for a shorter time. A fault that stops the leg ends the recording after a quarter of the rows more; it is kept until
/// the fault is cleared or other settings are set. Without such a fault the last ticks up to now are read, and the recorder goes on.
#[derive(Debug, clap::Args)]
pub(crate) struct Args {
    /// The file: FILE.mcap for Foxglove, PlotJuggler and `leg plot`, or FILE.csv.
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
    /// The directory for charts.
    #[arg(long, value_name = "DIR")]
    plots: Option<PathBuf>,
    #[command(flatten)]
    leg: LegArgs,
}

pub(crate) fn run(args: &Args, options: Options) -> Result<(), Failure> {
    if let Some(file) = &args.out {
        recording::extension(file)?;
    }
    let mut operator = args.leg.open(Purpose::Use, options)?.operator;
    let scope = operator.scope()?;
    let about = about_now(&title(&operator, &scope));
    if let Some(file) = &args.out {
        let tick = operator.telemetry()?.telemetry.tick;
        let now = wall_time_s(&operator).map(|now_s| (tick, now_s));
        save(file, &about, &scope, now)?;
    }
    // What was read is told, whether it can be drawn or not.
    let drawn = match &args.plots {
        Some(directory) => recorder_charts::save(&about.title, &scope.rows, directory)
            .map_err(|error| not_saved("charts", directory, "--plots", &error)),
        None => Ok(Vec::new()),
    };
    let plots = drawn.as_deref().unwrap_or_default();
    let [before_s, after_s] = scope.sides_s();
    let signals: Vec<_> = recorded_signals::words(scope.report.signals).collect();
    let json = json_object! {
        signals: &signals,
        ticks: scope.rows.len(),
        faults: fault_names(&scope),
        before_s: before_s,
        after_s: after_s,
        plots: plots
    };
    options.report(&json, || {
        let [before_ms, after_ms] = [before_s, after_s].map(|time_s| 1000.0 * time_s);
        let span = match scope.report.fault {
            Some(fault) => format!(
                "{before_ms:.1} ms before {} and {after_ms:.1} ms from it on",
                faults(fault.faults)
            ),
            None => format!("the last {before_ms:.1} ms"),
        };
        let charts: String = plots.iter().map(|svg| chart_line(svg)).collect();
        format!(
            "{} ticks of {}: {span}\n{charts}",
            scope.rows.len(),
            signals.join(", ")
        )
    })?;
    drawn.map(|_| ())
}

/// What its charts are called.
fn title(operator: &Operator, scope: &Scope) -> String {
    match scope.report.fault {
        Some(fault) => format!("{}, {} at 0 s", operator.name(), faults(fault.faults)),
        None => operator.name().into(),
    }
}

/// The names of the faults that have ended the recording; none where a host did.
fn fault_names(scope: &Scope) -> Vec<&'static str> {
    let faults = scope.report.fault.map(|fault| fault.faults.faults());
    faults
        .into_iter()
        .flatten()
        .map(|fault| fault.entry().name)
        .collect()
}

/// Writes the rows, each with its time of the day, by a tick and the time of that, s since 1970.
fn save(file: &Path, about: &About, scope: &Scope, now: Option<(u32, f64)>) -> Result<(), Failure> {
    recording::record(file, about, &scope.settings, |recording| {
        write(recording, scope, now)
    })
}

fn write(
    recording: &mut Recording,
    scope: &Scope,
    now: Option<(u32, f64)>,
) -> Result<(), RecordingError> {
    for row in &scope.rows {
        let at_s = now.map(|(tick, now_s)| now_s - seconds(tick.wrapping_sub(row.tick).into()));
        recording.take_recorder_row(row, at_s)?;
    }
    Ok(())
}
