//! `leg plot`.

use crate::options::Options;
use crate::output::{chart_line, not_saved, note};
use leg_base::failure::Failure;
use leg_base::json_object;
use leg_bench::{recorder_charts, run_charts};
use leg_boards::image;
use leg_host::recording::{self, Samples};
use std::path::PathBuf;

/// Draws the charts of a recording: those of `leg run` from what it recorded, a leg's telemetry from a log, and what `leg scope` read.
///
/// A recording that did not come to its end is drawn as far as it goes.
#[derive(Debug, clap::Args)]
pub(crate) struct Args {
    /// The recording: FILE.mcap.
    file: PathBuf,
    /// The directory for the charts; target/leg-plot in the workspace if left out.
    #[arg(long, value_name = "DIR")]
    plots: Option<PathBuf>,
}

pub(crate) fn run(args: &Args, options: Options) -> Result<(), Failure> {
    let recorded = recording::read_samples(&args.file)?;
    if !recorded.finished {
        note("leg: the recording did not come to its end: it is drawn as far as it goes");
    }
    let default = || image::workspace_root().join("target/leg-plot");
    let directory = args.plots.clone().unwrap_or_else(default);
    let title = recorded.about.title.as_str();
    let plots = match &recorded.samples {
        Samples::Simulation(samples) => run_charts::save(title, samples, &directory),
        Samples::Log(reports) => run_charts::save_log(title, reports, &directory),
        Samples::Recorder(rows) => recorder_charts::save(title, rows, &directory),
    };
    let plots = plots.map_err(|error| not_saved("charts", &directory, "--plots", &error))?;
    let json = json_object! { about: &recorded.about, finished: recorded.finished, plots: &plots };
    options.report(&json, || {
        let charts: String = plots.iter().map(|svg| chart_line(svg)).collect();
        format!("{title}\n{charts}")
    })
}
