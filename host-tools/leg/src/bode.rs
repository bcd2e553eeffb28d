//! `leg bode`.

mod files;
mod report;

use crate::options::Options;
use crate::output::load_rigs;
use crate::progress;
use leg_base::failure::Failure;
use leg_base::json_object;
use leg_bench::bode::{BodeCampaign, Feedback, rows};
use std::path::PathBuf;

/// Measures the feedback loops of the firmware around the simulated leg, and draws their Bode plots.
///
/// Each state of the leg is drawn from the seed: a pose of the workspace, a payload up to 2 kg and a feasible pretension. In each, a
/// sine is added at a break point of every loop, and both sides of it are compared: servo (each motor's voltage), damping (the
/// lengths of the tendons along a tilt), tension (the moments of the load cells) and trim (the pretension by them). Where play and
/// friction make the loop depend on the amplitude there are two of them. The table shows the worst margins, and where they are. The
/// command fails where one is below 6 dB or 45°.
#[derive(Debug, clap::Args)]
pub(crate) struct Args {
    /// Everything random follows from it.
    #[arg(long, default_value = "1")]
    seed: u64,
    /// How many states of the leg.
    #[arg(long, default_value = "12", value_parser = clap::value_parser!(u64).range(1..=1_000_000))]
    count: u64,
    /// A rig file, the name of a ready rig, or `all` ready rigs.
    #[arg(long, value_name = "FILE", default_value = "table1")]
    rig: PathBuf,
    /// The directory for plots and the table of points; target/leg-bode in the workspace if left out.
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
}

pub(crate) fn run(args: &Args, options: Options) -> Result<(), Failure> {
    let campaign = BodeCampaign {
        seed: args.seed,
        rigs: load_rigs(&args.rig)?,
        loops: Feedback::ALL.to_vec(),
    };
    let bar = progress::bar(args.count, "states");
    let swept = campaign.run(0..args.count, || bar.inc(1));
    bar.finish_and_clear();
    if swept.is_empty() {
        return Err(Failure::refused(
            "the rig holds no pose at any pretension",
            "look at the range of pretensions with leg map, and at tilt_deg, f_min_n and f_max_n",
        ));
    }
    let rows = rows(&swept);
    // What was found is told, whether it can be saved or not.
    let saved = files::save(args.out.as_deref(), &swept, &rows);
    let files = saved.as_deref().unwrap_or_default();
    let passed = swept.iter().all(|swept| swept.passes());
    let json = json_object! {
        seed: args.seed,
        states: args.count,
        passed: passed,
        rows: &rows,
        files: files,
    };
    options.report(&json, || report::table(&rows, &swept, files))?;
    saved?;
    if passed {
        return Ok(());
    }
    Err(Failure::failed(
        report::failed(&rows),
        "look at gains and damping in the rig; the same seed and rig repeat it",
    ))
}
