//! Every ready scenario in this process: each is run once for all tests that look at it.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use leg_rig::rig_file::RigFile;
use leg_sim::link::{InProcess, Link};
use leg_sim::ready_scenarios::{self, READY_SCENARIOS};
use leg_sim::scenario::Scenario;
use leg_sim::simulation::{Simulation, Summary, TickHash};
use std::path::Path;
use std::sync::OnceLock;

/// Everything of a tick that the firmware decides, as bits.
pub type Bits = Vec<[u32; 3]>;

/// What a scenario gave.
pub struct Run {
    pub summary: Summary,
    pub bits: Bits,
    pub hash: u64,
}

/// The ready scenario of a name.
pub fn scenario(name: &str) -> Scenario {
    Scenario::parse(name, ready_scenarios::named(name).unwrap().text).unwrap()
}

/// Runs a scenario with the firmware behind a link.
pub fn run(scenario: &Scenario, link: &mut dyn Link) -> Run {
    let rig = RigFile::load(Some(Path::new(&scenario.rig))).unwrap();
    let (mut bits, mut hash) = (Bits::new(), TickHash::default());
    let summary = Simulation::new(scenario, &rig)
        .unwrap()
        .run(link, &mut |tick| {
            let enabled = u32::from(tick.drive.enabled) << 31;
            bits.push(tick.drive.duty.map(|duty| duty.to_bits() ^ enabled));
            hash.take(tick);
        })
        .unwrap();
    let hash = hash.value();
    Run {
        summary,
        bits,
        hash,
    }
}

/// The control law in f64 beside the leg came to the same states and faults.
pub fn require_shadow(summary: &Summary, what: &str) {
    let divergence = &summary.divergence;
    assert!(divergence.stays(), "{what}: {divergence:?}");
}

/// The run of a ready scenario in this process.
pub fn ready(name: &str) -> &'static Run {
    static RUNS: [OnceLock<Run>; READY_SCENARIOS.len()] =
        [const { OnceLock::new() }; READY_SCENARIOS.len()];
    let place = READY_SCENARIOS.iter().position(|ready| ready.name == name);
    RUNS[place.unwrap()].get_or_init(|| run(&scenario(name), &mut InProcess::new()))
}
