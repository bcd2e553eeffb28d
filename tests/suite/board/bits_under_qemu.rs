//! Every ready scenario under QEMU: the same bits as in this process.
//!
//! Among the first tests by name: they take the longest, and would otherwise run alone at the end.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use crate::sim::ready_runs::{ready, run, scenario};
use leg_sim::ready_scenarios::READY_SCENARIOS;

/// Those that take minutes and do what others do, too.
pub const NOT_COMPARED: [&str; 2] = ["workspace", "tour"];

fn is_fault(name: &str) -> bool {
    name.starts_with("fault_")
}

/// The emulated core asks for the same duties to the last bit.
fn every_bit_is_the_same(chosen: fn(&str) -> bool) {
    let mut session = crate::common::qemu().unwrap();
    let names = READY_SCENARIOS.iter().map(|ready| ready.name);
    for name in names.filter(|name| chosen(name) && !NOT_COMPARED.contains(name)) {
        let (here, emulated) = (ready(name), run(&scenario(name), &mut session));
        let mut pairs = here.bits.iter().zip(&emulated.bits);
        let first = pairs.position(|(a, b)| a != b);
        assert_eq!(first, None, "{name}: first tick with other bits");
        let (here, emulated) = (&here.summary, emulated.summary);
        assert_eq!(here.ticks, emulated.ticks, "{name}");
        assert_eq!(here.measurements, emulated.measurements, "{name}");
    }
}

#[test]
fn scenarios_with_a_fault_have_the_same_bits() {
    every_bit_is_the_same(is_fault);
}

#[test]
fn scenarios_without_a_fault_have_the_same_bits() {
    every_bit_is_the_same(|name| !is_fault(name));
}
