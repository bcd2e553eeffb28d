//! Every ready scenario gives the same bits as before: a change of the control law shows here.
//!
//! `LEG_OVERWRITE=1 cargo test scenario_bits` writes the table anew.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use leg_rig::rig_file::RigFile;
use leg_sim::link::InProcess;
use leg_sim::ready_scenarios::READY_SCENARIOS;
use leg_sim::scenario::Scenario;
use leg_sim::simulation::{Simulation, Tick};
use std::fmt::Write;
use std::path::Path;

const TABLE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/golden/scenario_bits.txt");

/// FNV-1a over what a tick asks of the motors, and where it takes the leg to be and to be led.
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

fn line(name: &str, text: &str) -> String {
    let scenario = Scenario::parse(name, text).unwrap();
    let rig = RigFile::load(Some(Path::new(&scenario.rig))).unwrap();
    let mut hash = Hash(0xcbf2_9ce4_8422_2325);
    let summary = Simulation::new(&scenario, &rig)
        .unwrap()
        .run(&mut InProcess::new(), &mut |tick| hash.tick(tick))
        .unwrap();
    format!("{name} {} ticks {:016x}", summary.ticks, hash.0)
}

#[test]
fn every_ready_scenario_gives_the_bits_of_the_table() {
    let mut found = String::new();
    for ready in READY_SCENARIOS {
        writeln!(found, "{}", line(ready.name, ready.text)).unwrap();
    }
    if std::env::var_os("LEG_OVERWRITE").is_some() {
        std::fs::write(TABLE, &found).unwrap();
    }
    assert_eq!(found, std::fs::read_to_string(TABLE).unwrap_or_default());
}
