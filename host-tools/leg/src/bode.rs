//! `leg bode`.

use crate::options::Options;
use crate::output::load_rigs;
use crate::progress;
use leg_base::failure::Failure;
use leg_base::json_object;
use leg_bench::bode::{Campaign, Feedback, Swept};
use std::path::PathBuf;

/// Sweeps the loops.
#[derive(Debug, clap::Args)]
pub(crate) struct Args {
    /// Everything random follows from it.
    #[arg(long, default_value = "1")]
    seed: u64,
    /// How many states of the leg.
    #[arg(long, default_value = "20", value_parser = clap::value_parser!(u64).range(1..=1_000_000))]
    count: u64,
    /// A rig file, the name of a ready rig, or `all` ready rigs.
    #[arg(long, value_name = "FILE", default_value = "table1")]
    rig: PathBuf,
}

pub(crate) fn run(args: &Args, options: Options) -> Result<(), Failure> {
    let campaign = Campaign {
        seed: args.seed,
        rigs: load_rigs(&args.rig)?,
        loops: Feedback::ALL.to_vec(),
    };
    let bar = progress::bar(args.count, "states");
    let swept = campaign.run(args.count, || bar.inc(1));
    bar.finish_and_clear();
    let json = json_object! { seed: args.seed, swept: &swept };
    options.report(&json, || table(&swept))?;
    Ok(())
}

fn table(swept: &[Swept]) -> String {
    swept.iter().map(|s| format!("{:8} {:10} {:9.2e} {} {:?} {:5.2} {:5.1}  GM {:6.2} at {:7.2}  PM {:6.2} at {:7.2} {} {:?}\n",
        s.feedback.name(), s.place, s.amplitude, s.smaller, s.state.pose_deg.map(|x| x.round()), s.state.payload_kg, s.state.pretension_n,
        s.margins.gain_db.unwrap_or(f64::NAN), s.margins.gain_hz.unwrap_or(f64::NAN),
        s.margins.phase_deg.unwrap_or(f64::NAN), s.margins.phase_hz.unwrap_or(f64::NAN), s.passes(), s.failure)).collect()
}
