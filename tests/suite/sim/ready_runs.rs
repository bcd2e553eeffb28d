//! Every ready scenario in this process: each is run once for all tests that look at it.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use leg_rig::rig_file::RigFile;
use leg_sim::link::{InProcess, Link};
use leg_sim::ready_scenarios::{self, READY_SCENARIOS};
use leg_sim::scenario::Scenario;
use leg_sim::simulation::{Simulation, Summary, Tick};
use std::path::Path;
use std::sync::OnceLock;

/// Everything of a tick that the firmware decides, as bits.
pub type Bits = Vec<[u32; 3]>;

/// What a scenario gave.
pub struct Run {
    pub summary: Summary,
    pub bits: Bits,
    /// FNV-1a over what a tick asks of the motors, and where it takes the leg to be and to be led.
    pub hash: u64,
}

struct Hash(u64);

impl Hash {
    fn add(&mut self, bits: u32) {
        for byte in bits.to_le_bytes() {
            self.0 = (self.0 ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
        }
    }

    fn tick(&mut self, tick: &Tick<'_>) {
        self.add(u32::from(tick.drive.enabled));
        let told = tick.telemetry;
        let numbers = tick.drive.duty.iter().chain(&told.reference_m);
        for number in numbers.chain(&told.pose).chain(&told.unstretched_at_zero_m) {
            self.add(number.to_bits());
        }
    }
}

/// The ready scenario of a name.
pub fn scenario(name: &str) -> Scenario {
    Scenario::parse(name, ready_scenarios::named(name).unwrap().text).unwrap()
}

/// Runs a scenario with the firmware behind a link.
pub fn run(scenario: &Scenario, link: &mut dyn Link) -> Run {
    let rig = RigFile::load(Some(Path::new(&scenario.rig))).unwrap();
    let (mut bits, mut hash) = (Bits::new(), Hash(0xcbf2_9ce4_8422_2325));
    let summary = Simulation::new(scenario, &rig)
        .unwrap()
        .run(link, &mut |tick| {
            let enabled = u32::from(tick.drive.enabled) << 31;
            bits.push(tick.drive.duty.map(|duty| duty.to_bits() ^ enabled));
            hash.tick(tick);
        })
        .unwrap();
    let hash = hash.0;
    Run {
        summary,
        bits,
        hash,
    }
}

/// The run of a ready scenario in this process.
pub fn ready(name: &str) -> &'static Run {
    static RUNS: [OnceLock<Run>; READY_SCENARIOS.len()] =
        [const { OnceLock::new() }; READY_SCENARIOS.len()];
    let place = READY_SCENARIOS.iter().position(|ready| ready.name == name);
    RUNS[place.unwrap()].get_or_init(|| run(&scenario(name), &mut InProcess::new()))
}
