//! The watchdog as the board starts and refreshes it, and mistakes.

use super::*;
use crate::bench::{BOARD_CLOCKS, DeviceBench};
use crate::clocks::LSI_HZ;

const MS: u64 = 170_000;

fn bench() -> DeviceBench<Iwdg> {
    let mut bench = DeviceBench::new("IWDG", |_| Iwdg::new(LSI_HZ));
    bench.cycle = 0;
    bench
}

fn write(bench: &mut DeviceBench<Iwdg>, writes: &[(&str, u32)]) {
    for (register, value) in writes {
        bench.write(register, *value);
    }
}

/// As the driver of the board starts it for 100 ms.
const OPENING: [(&str, u32); 5] = [
    ("KR", UNLOCK),
    ("PR", 0),
    ("RLR", 799),
    ("KR", START),
    ("KR", REFRESH),
];

#[test]
fn it_counts_from_its_highest_value_until_it_is_refreshed_again() {
    let mut bench = bench();
    write(&mut bench, &OPENING[..4]);
    assert!(!bench.device.take_refreshed(), "a start is no refresh");
    write(&mut bench, &OPENING[4..]);
    assert!(bench.device.take_refreshed() && !bench.device.take_refreshed());
    assert_eq!(bench.device.expires_at(), Some(512 * MS));
    bench.cycle = 20 * MS;
    bench.write("KR", REFRESH);
    assert_eq!(bench.device.expires_at(), Some(120 * MS));
    assert_eq!(bench.device.timeout_cycles(LSI_HZ, &BOARD_CLOCKS), 100 * MS);
    let slowest = bench.device.timeout_cycles(LSI_RANGE_HZ[0], &BOARD_CLOCKS);
    assert_eq!(slowest / MS, 108);
    bench.device.rate_changes(70 * MS, 170_000_000, 17_000_000);
    assert_eq!(bench.device.expires_at(), Some(75 * MS));
    bench.device.reset();
    assert_eq!(bench.device.expires_at(), None);
    assert_eq!(bench.findings(), [""; 0]);
}

#[test]
fn a_write_of_the_window_refreshes() {
    let mut bench = bench();
    write(&mut bench, &OPENING);
    bench.cycle = 20 * MS;
    write(&mut bench, &[("KR", UNLOCK), ("WINR", 700)]);
    assert_eq!(bench.device.expires_at(), Some(120 * MS));
    assert_eq!(bench.findings(), [""; 0]);
}

#[test]
fn refreshing_a_watchdog_that_was_not_started_does_nothing() {
    let mut bench = bench();
    bench.write("KR", REFRESH);
    assert_eq!(bench.device.next_event(), None);
    assert_eq!(bench.findings(), [""; 0]);
}

#[test]
fn mistakes_are_found() {
    for (writes, part) in [
        (
            &[("PR", 1)][..],
            "IWDG_PR is written without its key in IWDG_KR",
        ),
        (
            &[("KR", UNLOCK), ("KR", REFRESH), ("RLR", 1)],
            "IWDG_RLR is written without its key in IWDG_KR",
        ),
        (
            &[("KR", UNLOCK), ("RLR", 1), ("RLR", 2)],
            "IWDG_RLR is written before the last write has arrived",
        ),
        (
            &[("KR", 0x1234)],
            "IWDG_KR: 0x1234 is no key, and locks the registers",
        ),
    ] {
        let mut bench = bench();
        write(&mut bench, writes);
        assert_eq!(bench.findings(), [part]);
    }
    let mut bench = bench();
    write(&mut bench, &[("KR", UNLOCK), ("WINR", 400)]);
    write(&mut bench, &OPENING);
    bench.cycle = 20 * MS;
    bench.write("KR", REFRESH);
    bench.cycle = 40 * MS;
    bench.write("KR", REFRESH);
    assert_eq!(bench.device.expires_at(), Some(bench.cycle));
    assert_eq!(
        bench.findings(),
        ["IWDG_KR: the watchdog is fed before its window opens"]
    );
}
