//! `leg run`.

mod errors;
mod report;
mod resources;

use crate::board::Emulation;
use crate::numbers::unix_s;
use crate::options::Options;
use crate::output::{about_now, load_rig, not_saved, note, note_unfinished};
use crate::progress;
use leg_base::failure::Failure;
use leg_bench::run_charts;
use leg_boards::image;
use leg_host::recording::{self, About};
use leg_rig::rig_file::RigFile;
use leg_sim::link::Link;
use leg_sim::scenario::Scenario;
use leg_sim::shadow::OTHER_TICKS_MAX;
use leg_sim::simulation::{Simulation, Summary, Tick};
use report::RunReport;
use std::path::PathBuf;
use std::time::Instant;

/// Runs the firmware on a simulated leg through a scenario, and checks the results against the scenario's bounds.
///
/// As on the board, the firmware gets nothing but encoder counts, codes and flags. The same control law runs beside it in
/// f64.
#[derive(Debug, clap::Args)]
pub(crate) struct Args {
    /// Where the firmware runs.
    #[arg(long, value_enum, default_value_t = Emulation::Qemu)]
    on: Emulation,
    /// The scenario file or the name of a ready scenario; the paper's Fig. 9 if left out.
    #[arg(long, value_name = "FILE", default_value = "fig9")]
    scenario: PathBuf,
    /// The rig file or the name of a ready rig; that of the scenario if left out.
    #[arg(long, value_name = "FILE")]
    rig: Option<PathBuf>,
    /// Records every tick: FILE.mcap for Foxglove, PlotJuggler and `leg replay`, or FILE.csv.
    #[arg(long, value_name = "FILE")]
    record: Option<PathBuf>,
    /// The time of the day at which the recording begins, s since 1970; now if left out. With the same one the same run gives the
    /// same messages.
    #[arg(long, value_name = "S", requires = "record", value_parser = unix_s)]
    begin_wall_time_s: Option<f64>,
    /// The directory for the charts; target/leg-run in the workspace if left out.
    #[arg(long, value_name = "DIR")]
    plots: Option<PathBuf>,
    /// Repeats the scenario in this process with errors of load cells and tendon curves, and draws the largest error of the
    /// tip.
    #[arg(long, conflicts_with_all = ["on", "record"])]
    errors: bool,
}

pub(crate) fn run(args: &Args, options: Options) -> Result<(), Failure> {
    let scenario = scenario(args)?;
    for renamed in &scenario.notes {
        note(&format!("leg: {}: {renamed}", args.scenario.display()));
    }
    let default_rig = || scenario.rig.clone().into();
    let rig = load_rig(Some(&args.rig.clone().unwrap_or_else(default_rig)))?;
    let default = || image::workspace_root().join("target/leg-run");
    let directory = args.plots.clone().unwrap_or_else(default);
    if args.errors {
        return errors::run(&scenario, &rig, &directory, options);
    }
    let started = Instant::now();
    let mut link = args.on.link(options)?;
    let processor_s = resources::processor_s();
    let summary = simulate(args, &scenario, &rig, link.as_mut())?;
    // A child's time counts once it has ended.
    drop(link);
    let taken_s = resources::processor_s().zip(processor_s);
    let seconds = started.elapsed().as_secs_f64();
    // What was found is told, whether it can be drawn or not.
    let saved = run_charts::save(&scenario.title, &summary.samples, &directory);
    let report = RunReport {
        title: &scenario.title,
        firmware: args.on.text(),
        summary: &summary,
        ticks_per_s: summary.ticks as f64 / seconds,
        ticks_per_processor_s: taken_s
            .filter(|(end, start)| end > start)
            .map(|(end, start)| summary.ticks as f64 / (end - start)),
        memory_mib: resources::memory_mib(),
        shows_resources: args.on == Emulation::Chip,
        plots: saved.as_deref().unwrap_or_default(),
    };
    options.report(&report.json(), || report.table())?;
    saved.map_err(|error| not_saved("charts", &directory, "--plots", &error))?;
    require_passed(&summary)
}

/// The scenario as it can run there.
fn scenario(args: &Args) -> Result<Scenario, Failure> {
    let scenario = Scenario::load(&args.scenario)?;
    if args.on != Emulation::Chip {
        return Ok(scenario);
    }
    scenario.board_variant().map_err(|why| {
        let name = args.scenario.display();
        Failure::refused(
            format!("a board cannot run {name}: {why}"),
            "run it with --on sim or --on qemu",
        )
    })
}

fn simulate(
    args: &Args,
    scenario: &Scenario,
    rig: &RigFile,
    link: &mut dyn Link,
) -> Result<Summary, Failure> {
    let simulation = Simulation::new(scenario, rig).map_err(Failure::from_error)?;
    let settings = simulation.settings().clone();
    let bar = progress::counter("ticks");
    let mut watched = |watch: &mut dyn FnMut(&Tick<'_>)| {
        let result = simulation.clone().run(link, watch);
        bar.finish_and_clear();
        result.map_err(Failure::from_error)
    };
    if let Some(file) = &args.record {
        note_unfinished(file);
    }
    match &args.record {
        None => watched(&mut |_| bar.inc(1)),
        Some(file) => {
            recording::record(file, &description(args, scenario), &settings, |recording| {
                let mut written = Ok(());
                let summary = watched(&mut |tick| {
                    bar.inc(1);
                    if written.is_ok() {
                        written = recording.take_tick(tick);
                    }
                })?;
                written?;
                Ok(summary)
            })
        }
    }
}

fn description(args: &Args, scenario: &Scenario) -> About {
    let rig = args.rig.as_ref().map(|rig| rig.display().to_string());
    let now = about_now(&scenario.title);
    About {
        begin_wall_time_s: args.begin_wall_time_s.or(now.begin_wall_time_s),
        scenario: Some(args.scenario.display().to_string()),
        rig: Some(rig.unwrap_or_else(|| scenario.rig.clone())),
        seed: Some(scenario.seed),
        ..now
    }
}

fn require_passed(summary: &Summary) -> Result<(), Failure> {
    if summary.passes() {
        return Ok(());
    }
    if let Some(reason) = &summary.stopped {
        let help = "see in the charts what the leg was doing";
        return Err(Failure::failed(reason.clone(), help));
    }
    let failed = summary.measurements.iter().filter(|found| !found.passes());
    let mut names: Vec<_> = failed.map(|found| found.name.as_str()).collect();
    names.extend(summary.unexpected.iter().map(|fault| fault.entry().name));
    let answers_alone = summary.divergence.states_stay_within(OTHER_TICKS_MAX);
    if names.is_empty() && answers_alone {
        return Err(Failure::failed(
            "the control law in f64 answered a command otherwise than the firmware",
            "rounding decides there: find the command that is at a limit, or an error in the law; keep a recording with --record",
        ));
    }
    if names.is_empty() {
        let first = summary.divergence.first_other_tick.unwrap_or_default();
        return Err(Failure::failed(
            format!("the control law in f64 left the firmware's state, first in tick {first}"),
            "rounding decides there: find the limit that is met in that tick, or an error in the law; keep a recording with --record",
        ));
    }
    Err(Failure::failed(
        format!("failed: {}", names.join("; ")),
        "look at the charts, then at the scenario's bounds",
    ))
}
