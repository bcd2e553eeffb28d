//! A sample of `leg bode`, and that its bars can fail.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use leg_bench::bode::{Campaign, Feedback, Margin, Row, Swept, rows};
use leg_rig::ready_rigs::READY_RIGS;
use leg_rig::rig_file::RigFile;

/// The paper's rig with settings of its own.
fn campaign(settings: &str, seed: u64, loops: &[Feedback]) -> Campaign {
    let text = [READY_RIGS[0].text, settings].concat();
    Campaign {
        seed,
        rigs: vec![("rig".into(), RigFile::parse("rig", &text).unwrap())],
        loops: loops.to_vec(),
    }
}

fn measured(settings: &str, seed: u64, loops: &[Feedback], count: u64) -> Vec<Swept> {
    println!("seed {seed}");
    campaign(settings, seed, loops).run(count, || ())
}

/// The worst margin of a loop at any amplitude; none where it has none.
fn worst(rows: &[Row], feedback: Feedback, margin: Margin) -> Option<f64> {
    let rows = rows.iter().filter(|row| row.feedback == feedback && row.margin == margin);
    rows.filter_map(|row| Some(row.worst.as_ref()?.value)).min_by(f64::total_cmp)
}
