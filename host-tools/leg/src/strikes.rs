//! `leg strikes`.

mod report;

use crate::numbers::positive;
use crate::options::Options;
use crate::output::load_rigs;
use crate::progress;
use clap::builder::PossibleValuesParser;
use leg_base::failure::Failure;
use leg_base::json_object;
use leg_bench::strikes::{self, Activity, StrikeCampaign, StrikeSummary, UseResult};
use leg_sim::plant::Defect;
use std::path::PathBuf;

/// Strikes a simulated leg by every fault that it can have, wherever it is and whatever it does, and judges what happens.
///
/// Each strike is drawn from the seed: rig, pose, payload up to 2 kg, feasible pretension, moment and tendon. The true
/// tensions, the true tip, the time to the first fault and the motors after the stop are measured. The table shows the
/// worst of each by fault and state, with the number of the strike behind `#`, which `--only` repeats.
#[derive(Debug, clap::Args)]
pub(crate) struct Args {
    /// Everything random follows from it.
    #[arg(long, default_value = "1")]
    seed: u64,
    /// How many strikes.
    #[arg(long, default_value = "20000", value_parser = clap::value_parser!(u64).range(1..=10_000_000))]
    count: u64,
    /// A rig file, the name of a ready rig, or `all` ready rigs.
    #[arg(long, value_name = "FILE", default_value = "all")]
    rig: PathBuf,
    /// What the leg is doing; anything if left out.
    #[arg(long, value_name = "STATE", value_enum)]
    state: Vec<Activity>,
    /// A fault, by its name in the table of scenarios.md, or `none`; every one if left out. It may be repeated.
    #[arg(long, value_name = "FAULT", value_parser = faults(), hide_possible_values = true)]
    fault: Vec<String>,
    /// Prints the worst of each measure beside its bar, in place of the worst and first names; JSON has both.
    #[arg(long)]
    bars: bool,
    /// Repeats the strike of a number, and shows its course. Seed and rigs have to be the same.
    #[arg(long, value_name = "NUMBER", conflicts_with_all = ["count", "state", "fault", "bars"])]
    only: Option<u64>,
    /// Uses each rig for so many hours of the leg's time without a fault instead: random moves, pushes up to 10 N, payloads up
    /// to 1 kg and commands, after which no fault may come.
    #[arg(long, value_name = "HOURS", value_parser = positive, conflicts_with_all = ["count", "state", "fault", "bars", "only"])]
    false_alarms: Option<f64>,
}

/// Time between two moments of a strike's course, s.
const EVERY_S: f64 = 0.001;

pub(crate) fn run(args: &Args, options: Options) -> Result<(), Failure> {
    let campaign = StrikeCampaign {
        seed: args.seed,
        rigs: load_rigs(&args.rig)?,
        activities: args.state.clone(),
        faults: args.fault.clone(),
    };
    if let Some(index) = args.only {
        let (struck, course) = campaign.repeat(index, EVERY_S);
        let json = json_object! { strike: &struck, course: &course };
        options.report(&json, || report::course(&struck, &course))?;
        return require(usize::from(!struck.passes()), 1);
    }
    if let Some(hours) = args.false_alarms {
        return false_alarms(&campaign, hours, options);
    }
    let bar = progress::bar(args.count, "strikes");
    let struck = campaign.run(args.count, || bar.inc(1));
    bar.finish_and_clear();
    let rows = strikes::rows(&struck);
    let summary = StrikeSummary::new(&struck);
    let json = json_object! {
        seed: args.seed,
        strikes: summary.strikes,
        failed: summary.failed,
        left_shadow: &summary.left_shadow,
        left_shadow_at_most: summary.left_shadow_at_most,
        passed: summary.passed,
        rows: &rows,
    };
    let table = if args.bars {
        report::bar_report
    } else {
        report::table
    };
    options.report(&json, || table(&rows, &summary, args.seed))?;
    require(summary.failed, summary.strikes)?;
    if summary.passed {
        return Ok(());
    }
    Err(Failure::failed(
        format!(
            "{} strikes left their shadow in f64, {} at most may",
            summary.left_shadow.len(),
            summary.left_shadow_at_most
        ),
        "--json has their numbers under left_shadow: repeat one with --only",
    ))
}

fn false_alarms(campaign: &StrikeCampaign, hours: f64, options: Options) -> Result<(), Failure> {
    let time_s = 3600.0 * hours;
    let bar = progress::bar(time_s as u64 * campaign.rigs.len() as u64, "s");
    let usages = campaign.use_legs(time_s, |seconds| bar.inc(seconds));
    bar.finish_and_clear();
    let alarms = || usages.iter().flat_map(|usage| &usage.alarms);
    let stopped = usages
        .iter()
        .filter(|usage| usage.stopped.is_some())
        .count();
    let false_ones = alarms().filter(|alarm| !alarm.beyond).count();
    let uses = usages.iter().map(|usage| usage.uses).sum();
    let left_shadow: u64 = usages.iter().map(|usage| usage.left_shadow).sum();
    let left_shadow_at_most = UseResult::left_shadow_at_most(uses);
    let passed = false_ones + stopped == 0 && left_shadow <= left_shadow_at_most;
    let json = json_object! {
        seed: campaign.seed,
        hours: hours,
        alarms: alarms().count(),
        false_alarms: false_ones,
        left_shadow: left_shadow,
        left_shadow_at_most: left_shadow_at_most,
        passed: passed,
        usages: &usages,
    };
    options.report(&json, || report::usages(&usages))?;
    if passed {
        return Ok(());
    }
    Err(Failure::failed(
        format!(
            "{false_ones} false alarms, {stopped} parts that did not go on, {left_shadow} legs that left their shadow in f64 ({left_shadow_at_most} at most may)"
        ),
        "look at what was done before each; the same seed and rigs repeat it",
    ))
}

/// The names that `--fault` knows.
fn faults() -> PossibleValuesParser {
    let faults = Defect::descriptions().map(|(name, _)| name);
    faults.chain(["none"]).into()
}

fn require(failed: usize, strikes: usize) -> Result<(), Failure> {
    if failed == 0 {
        return Ok(());
    }
    Err(Failure::failed(
        format!("{failed} of {strikes} strikes failed"),
        "repeat one with --only and its number, and the same seed and rigs",
    ))
}
