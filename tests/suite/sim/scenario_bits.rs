//! Every ready scenario gives the same bits as before: a change of the control law shows here.
//!
//! `LEG_OVERWRITE=1 cargo test scenario_bits` writes the table anew.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use super::ready_runs::ready;
use leg_sim::ready_scenarios::READY_SCENARIOS;
use std::fmt::Write;

const TABLE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/golden/scenario_bits.txt");

#[test]
fn every_ready_scenario_gives_the_bits_of_the_table() {
    let mut found = String::new();
    for scenario in READY_SCENARIOS {
        let run = ready(scenario.name);
        let ticks = run.summary.ticks;
        writeln!(found, "{} {ticks} ticks {:016x}", scenario.name, run.hash).unwrap();
    }
    if std::env::var_os("LEG_OVERWRITE").is_some() {
        std::fs::write(TABLE, &found).unwrap();
    }
    assert_eq!(found, std::fs::read_to_string(TABLE).unwrap_or_default());
}
