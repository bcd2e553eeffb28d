//! `leg moves`.

use crate::numbers::payload_kg;
use crate::options::Options;
use crate::output::{chart_line, load_rigs, not_saved};
use crate::progress;
use leg_base::failure::Failure;
use leg_base::json_object;
use leg_bench::moves::{self, MoveCampaign, Moved};
use std::path::{Path, PathBuf};

/// Moves a simulated leg between random poses with payloads that it does not know, and measures how its true tip goes.
///
/// Each move is drawn from the seed: two poses of the workspace, a payload up to 2 kg and a feasible pretension. Off is how far
/// the tip is from the trajectory on the way, swing how far from where it comes to rest after the end; it has settled when it
/// stays within 0.02 mm of that. The command fails where a bar is exceeded, which is wider for a move from straight down with a
/// payload that nothing has shown yet, or where the control law in f64 beside the leg comes to another state.
#[derive(Debug, clap::Args)]
pub(crate) struct Args {
    /// Everything random follows from it.
    #[arg(long, default_value = "1")]
    seed: u64,
    /// How many moves.
    #[arg(long, default_value = "60", value_parser = clap::value_parser!(u64).range(1..=1_000_000))]
    count: u64,
    /// Only the move of this number.
    #[arg(long, value_name = "N", conflicts_with = "count", value_parser = clap::value_parser!(u64).range(..1_000_000))]
    only: Option<u64>,
    /// A rig file, the name of a ready rig, or `all` ready rigs.
    #[arg(long, value_name = "FILE", default_value = "table1")]
    rig: PathBuf,
    /// The payload of every move, kg, in the place of a drawn one.
    #[arg(long, value_name = "KG", value_parser = payload_kg)]
    payload: Option<f64>,
    /// Draws the move that swung the most into this directory, beside the same move with the damping of the swing off.
    #[arg(long, value_name = "DIR")]
    plots: Option<PathBuf>,
}

pub(crate) fn run(args: &Args, options: Options) -> Result<(), Failure> {
    let campaign = MoveCampaign {
        seed: args.seed,
        rigs: load_rigs(&args.rig)?,
        payload_kg: args.payload,
    };
    let numbers = args.only.map_or(0..args.count, |only| only..only + 1);
    let bar = progress::bar(numbers.end - numbers.start, "moves");
    let moved = campaign.run(numbers, || bar.inc(1));
    bar.finish_and_clear();
    let swings = |a: &&Moved, b: &&Moved| a.swing_mm.total_cmp(&b.swing_mm);
    let Some(worst) = moved.iter().max_by(swings) else {
        return Err(Failure::refused(
            "the rig holds no two poses that are 3° apart with the payload, at any pretension",
            "give a smaller --payload; look at the range of pretensions with leg map, and at tilt_deg, f_min_n and f_max_n",
        ));
    };
    let failed = moved.iter().filter(|moved| !moved.passes()).count();
    // What was found is told, whether it can be drawn or not.
    let drawn = args
        .plots
        .as_deref()
        .map(|directory| draw(worst, directory));
    let saved = drawn.transpose();
    let plot = saved.as_ref().ok().and_then(Option::as_deref);
    let json = json_object! {
        seed: args.seed,
        failed: failed,
        passed: failed == 0,
        moves: &moved,
        plot: plot,
    };
    options.report(&json, || {
        let chart = plot.map(chart_line);
        table(&moved) + &chart.unwrap_or_default()
    })?;
    saved?;
    if failed == 0 {
        return Ok(());
    }
    Err(Failure::failed(
        format!("{failed} of {} moves failed", moved.len()),
        "the same seed, rig and --payload repeat them, --only N a single one",
    ))
}

fn draw(moved: &Moved, directory: &Path) -> Result<PathBuf, Failure> {
    moves::save_comparison(moved, directory)
        .map_err(|error| not_saved("chart", directory, "--plots", &error))
}

fn table(moved: &[Moved]) -> String {
    let lines: String = moved.iter().map(line).collect();
    format!(
        "  #  from °         to °            kg      N    took s  off mm  swing mm  settled s  rest mm\n{lines}"
    )
}

fn line(moved: &Moved) -> String {
    let drawn = &moved.drawn;
    let pose = |[azimuth, tilt]: [f64; 2]| format!("{azimuth:6.1} {tilt:5.1}");
    let verdict = if moved.passes() {
        "pass".into()
    } else {
        format!("FAIL: {}", moved.failures.join(", "))
    };
    format!(
        "{:3}  {}  {}  {:5.2}  {:5.1}  {:6.2}  {:6.3}  {:8.3}  {:9.2}  {:7.3}  {verdict}\n",
        drawn.number,
        pose(drawn.begin_deg),
        pose(drawn.end_deg),
        drawn.payload_kg,
        drawn.pretension_n,
        moved.took_s,
        moved.off_mm,
        moved.swing_mm,
        moved.settled_s,
        moved.rest_mm,
    )
}
