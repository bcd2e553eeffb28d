//! The watchdog as the board starts and refreshes it, and mistakes.

use super::Wwdg;
use crate::bench::DeviceBench;
use crate::device::Device;

/// Cycles of 170 MHz in a step of the counter, without a prescaler.
const STEP: u64 = 4_096;

/// Active, with the highest count.
const REFRESH: u32 = 0xff;

fn bench() -> DeviceBench<Wwdg> {
    DeviceBench::new("WWDG", Wwdg::new)
}

#[test]
fn it_resets_when_it_was_not_refreshed_for_64_steps() {
    let mut bench = bench();
    assert_eq!(bench.device.next_event(), None);
    bench.write("CR", REFRESH);
    assert!(!bench.device.take_refreshed(), "a start is no refresh");
    // The divider runs on: the first step is the rest of one.
    assert_eq!(bench.device.expires_at(), Some(64 * STEP));
    bench.run_to(20 * STEP + 5);
    assert_eq!(bench.get("CR", "T"), 0x7f - 20);
    bench.write("CR", REFRESH);
    assert!(bench.device.take_refreshed());
    assert_eq!(bench.device.expires_at(), Some(84 * STEP));
    let clocks = bench.clocks;
    assert_eq!(bench.device.timeout_cycles(&clocks), 64 * STEP);
    bench.set("CFR", &[("WDGTB", 1)]);
    assert_eq!(bench.device.timeout_cycles(&clocks), 128 * STEP);
    bench.device.reset();
    assert_eq!(bench.device.expires_at(), None);
    assert_eq!(bench.findings(), [""; 0]);
}

#[test]
fn nothing_but_a_reset_stops_it() {
    let mut bench = bench();
    bench.write("CR", REFRESH);
    bench.write("CR", 0x7f);
    assert_eq!(bench.get("CR", "WDGA"), 1);
    assert_eq!(bench.device.expires_at(), Some(64 * STEP));
}

#[test]
fn it_warns_a_step_before() {
    let mut bench = bench();
    bench.write("SR", 0);
    bench.write("CR", REFRESH);
    bench.set("CFR", &[("EWI", 1)]);
    bench.write("SR", 0);
    bench.run_to(63 * STEP - 1);
    assert!(!bench.device.interrupt());
    bench.run_to(63 * STEP);
    assert!(bench.device.interrupt());
    bench.write("SR", 0);
    assert!(!bench.device.interrupt());
    bench.set("CFR", &[("EWI", 0)]);
    assert_eq!(bench.get("CFR", "EWI"), 1);
}

#[test]
fn a_debugger_halts_it() {
    let mut bench = bench();
    bench.write("CR", REFRESH);
    bench.device.halt(10 * STEP);
    assert_eq!(bench.device.expires_at(), Some(74 * STEP));
}

#[test]
fn a_refresh_before_the_window_or_without_its_bit_resets_at_once() {
    for (after, value, part) in [
        (10 * STEP, REFRESH, "before its window opens"),
        (20 * STEP, 0xbf, "without its bit 6"),
    ] {
        let mut bench = bench();
        bench.set("CFR", &[("W", 0x70)]);
        bench.write("CR", REFRESH);
        bench.run_to(after);
        bench.write("CR", value);
        assert_eq!(bench.device.expires_at(), Some(after));
        let found = bench.findings();
        assert!(found.len() == 1 && found[0].contains(part), "{found:?}");
    }
    let mut bench = bench();
    bench.set("CFR", &[("W", 0x70)]);
    bench.write("CR", REFRESH);
    bench.run_to(16 * STEP);
    bench.write("CR", REFRESH);
    assert_eq!(bench.findings(), [""; 0]);
}
