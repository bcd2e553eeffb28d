//! The watchdog as the board starts and feeds it, and mistakes.

use super::*;
use crate::clocks::LSI_HZ;
use crate::findings::Findings;

const CLOCKS: Clocks = Clocks {
    hclk: 170_000_000,
    ..Clocks::RESET
};
const MS: u64 = 170_000;

struct Bench {
    dog: Iwdg,
    findings: Findings,
    cycle: u64,
}

impl Bench {
    fn new() -> Self {
        Self {
            dog: Iwdg::new(LSI_HZ),
            findings: Findings::default(),
            cycle: 0,
        }
    }

    fn put(&mut self, register: &str, value: u32) {
        let offset = self.dog.registers.offset(register);
        let mut context = Context {
            cycle: self.cycle,
            clocks: &CLOCKS,
            findings: &mut self.findings,
        };
        self.dog.write(offset, value, &mut context);
    }

    fn set(&mut self, writes: &[(&str, u32)]) {
        for (register, value) in writes {
            self.put(register, *value);
        }
    }

    fn texts(&self) -> Vec<&str> {
        let list = self.findings.list();
        list.iter().map(|finding| finding.text.as_str()).collect()
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
fn it_counts_from_its_highest_value_until_it_is_fed_again() {
    let mut bench = Bench::new();
    bench.set(&OPENING);
    assert_eq!(bench.dog.expires_at(), Some(512 * MS));
    bench.cycle = 20 * MS;
    bench.put("KR", REFRESH);
    assert_eq!(bench.dog.expires_at(), Some(120 * MS));
    assert_eq!(bench.dog.timeout_cycles(LSI_HZ, &CLOCKS), 100 * MS);
    let slowest = bench.dog.timeout_cycles(LSI_RANGE_HZ[0], &CLOCKS);
    assert_eq!(slowest / MS, 108);
    bench.dog.rate_changes(70 * MS, 170_000_000, 17_000_000);
    assert_eq!(bench.dog.expires_at(), Some(75 * MS));
    bench.dog.reset();
    assert_eq!(bench.dog.expires_at(), None);
    assert!(bench.texts().is_empty(), "{:?}", bench.texts());
}

#[test]
fn a_write_of_the_window_feeds() {
    let mut bench = Bench::new();
    bench.set(&OPENING);
    bench.cycle = 20 * MS;
    bench.set(&[("KR", UNLOCK), ("WINR", 700)]);
    assert_eq!(bench.dog.expires_at(), Some(120 * MS));
    assert!(bench.texts().is_empty(), "{:?}", bench.texts());
}

#[test]
fn feeding_a_watchdog_that_was_not_started_does_nothing() {
    let mut bench = Bench::new();
    bench.put("KR", REFRESH);
    assert_eq!(bench.dog.next_event(), None);
    assert!(bench.texts().is_empty(), "{:?}", bench.texts());
}

#[test]
fn mistakes_are_found() {
    for (writes, part) in [
        (&[("PR", 1)][..], "IWDG_PR is written without its key"),
        (
            &[("KR", UNLOCK), ("KR", REFRESH), ("RLR", 1)],
            "IWDG_RLR is written without its key",
        ),
        (
            &[("KR", UNLOCK), ("RLR", 1), ("RLR", 2)],
            "IWDG_RLR is written before the last write",
        ),
        (&[("KR", 0x1234)], "0x1234 is no key"),
    ] {
        let mut bench = Bench::new();
        bench.set(writes);
        let texts = bench.texts();
        assert!(
            texts.len() == 1 && texts[0].contains(part),
            "{part}: {texts:?}"
        );
    }
    let mut bench = Bench::new();
    bench.set(&[("KR", UNLOCK), ("WINR", 400)]);
    bench.set(&OPENING);
    bench.cycle = 20 * MS;
    bench.put("KR", REFRESH);
    bench.cycle = 40 * MS;
    bench.put("KR", REFRESH);
    assert_eq!(bench.dog.expires_at(), Some(bench.cycle));
    assert_eq!(bench.texts().len(), 1, "{:?}", bench.texts());
}
