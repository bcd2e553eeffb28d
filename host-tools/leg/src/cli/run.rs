//! `leg run`.

use super::run_report::Report;
use super::{board, print, progress, run_errors};
use clap::ValueEnum;
use leg_base::failure::Failure;
use leg_bench::run_charts;
use leg_boards::image;
use leg_boards::qemu::Clock;
use leg_host::recording;
use leg_rig::rig_file::RigFile;
use leg_sim::scenario::Scenario;
use leg_sim::simulation::{Controller, InThisProcess, OnLink, Simulation, Summary, Tick};
use std::path::{Path, PathBuf};
use std::time::Instant;

/// Lets the firmware drive a simulated leg through a scenario, and says whether what must come out came out.
///
/// The firmware sees encoder counts, codes and flags alone, as on the board. Beside it the same control law runs in f64.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// Where the firmware runs.
    #[arg(long, value_enum, default_value_t = On::Qemu)]
    on: On,
    /// A scenario file or the name of a ready one; the paper's Fig. 9 if left out.
    #[arg(long, value_name = "FILE", default_value = "fig9")]
    scenario: PathBuf,
    /// The rig file or the name of a ready rig; the scenario's own if left out.
    #[arg(long, value_name = "FILE")]
    rig: Option<PathBuf>,
    /// Records every tick: FILE.mcap for Foxglove, PlotJuggler and `leg replay`, or FILE.csv.
    #[arg(long, value_name = "FILE")]
    record: Option<PathBuf>,
    /// The directory for the charts; target/leg-run in the workspace if left out.
    #[arg(long, value_name = "DIR")]
    plots: Option<PathBuf>,
    /// Runs the scenario again and again in this process, with load cells and tendon curves that are off, and draws the
    /// largest error of the tip.
    #[arg(long, conflicts_with_all = ["on", "record"])]
    errors: bool,
    /// Prints JSON instead of a table.
    #[arg(long)]
    json: bool,
}

/// Where the firmware runs without a board.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(super) enum On {
    /// On an emulated Cortex-M4F.
    Qemu,
    /// In this process.
    Sim,
}

impl On {
    pub(super) const fn words(self) -> &'static str {
        match self {
            Self::Qemu => "under QEMU",
            Self::Sim => "in this process",
        }
    }
}

/// Runs the command.
///
/// # Errors
/// A [`Failure`]: a scenario, rig or link that is refused, charts that cannot be written, or a value that is not where it
/// must be.
pub(super) fn run(args: &Args, verbose: bool) -> Result<(), Failure> {
    let scenario = Scenario::load(&args.scenario)?;
    let rig_name = args
        .rig
        .clone()
        .unwrap_or_else(|| scenario.rig.clone().into());
    let rig = RigFile::load(Some(&rig_name))?;
    if args.errors {
        return run_errors::run(&scenario, &rig, &directory(args), args.json);
    }
    let started = Instant::now();
    let summary = match args.on {
        On::Sim => simulate(args, &scenario, &rig, &mut InThisProcess::default())?,
        On::Qemu => {
            let mut link = board::qemu_with(Clock::Normal, verbose)?;
            simulate(
                args,
                &scenario,
                &rig,
                &mut OnLink::new(link.as_mut(), false),
            )?
        }
    };
    let seconds = started.elapsed().as_secs_f64();
    let plots = draw(&scenario, &summary, &directory(args))?;
    let report = Report {
        scenario: &scenario,
        place: args.on.words(),
        summary: &summary,
        ticks_per_s: summary.ticks as f64 / seconds,
        plots: &plots,
    };
    print(&if args.json {
        report.json()?
    } else {
        report.table()
    })?;
    judge(&summary)
}

fn simulate(
    args: &Args,
    scenario: &Scenario,
    rig: &RigFile,
    controller: &mut dyn Controller,
) -> Result<Summary, Failure> {
    let simulation = Simulation::new(scenario, rig).map_err(|error| Failure::from_error(&error))?;
    let settings = simulation.settings().clone();
    let bar = progress::spinner("ticks");
    let mut watched = |watch: &mut dyn FnMut(&Tick<'_>)| {
        let result = simulation.clone().run(controller, watch);
        bar.finish_and_clear();
        result.map_err(|error| Failure::from_error(&error))
    };
    match &args.record {
        None => watched(&mut |_| bar.inc(1)),
        Some(file) => recording::around(file, &settings, |recorder| {
            let mut written = Ok(());
            let summary = watched(&mut |tick| {
                bar.inc(1);
                if written.is_ok() {
                    written = recorder.take(tick);
                }
            })?;
            written.map_err(|error| Failure::from_error(&error))?;
            Ok(summary)
        }),
    }
}

fn judge(summary: &Summary) -> Result<(), Failure> {
    if summary.held() {
        return Ok(());
    }
    if let Some(words) = &summary.stopped {
        return Err(Failure::missed(
            words.clone(),
            "see in the charts what the leg was doing",
        ));
    }
    let missed: Vec<_> = summary
        .findings
        .iter()
        .filter(|finding| !finding.held())
        .collect();
    let mut names: Vec<_> = missed.iter().map(|finding| finding.name.as_str()).collect();
    names.extend(summary.unexpected.iter().map(|fault| fault.entry().name));
    Err(Failure::missed(
        format!("not where it must be: {}", names.join("; ")),
        "look at the charts, then at the scenario's bounds",
    ))
}

fn directory(args: &Args) -> PathBuf {
    args.plots
        .clone()
        .unwrap_or_else(|| image::workspace_root().join("target/leg-run"))
}

fn draw(scenario: &Scenario, summary: &Summary, directory: &Path) -> Result<Vec<PathBuf>, Failure> {
    run_charts::save(&scenario.title, &summary.samples, directory).map_err(|error| {
        let sentence = format!("no charts in {}: {error}", directory.display());
        Failure::refused(sentence, "name another directory with --plots")
    })
}
