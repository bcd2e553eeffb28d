//! The line in both directions.

#![allow(clippy::unwrap_used)]

use super::{Lpuart, Sent};
use crate::clocks::Clocks;
use crate::device::{Context, Device};
use crate::findings::Findings;

const BAUD: u32 = 921_600;
/// 256 × 170 MHz / 921 600 baud, rounded.
const BRR: u32 = 47_222;
/// Ten bits at that rate, in cycles, rounded up.
const CHARACTER: u64 = 1845;
const CLOCKS: Clocks = Clocks {
    hclk: 170_000_000,
    lpuart1: 170_000_000,
    ..Clocks::RESET
};

struct Bench {
    line: Lpuart,
    findings: Findings,
    cycle: u64,
}

impl Bench {
    fn new() -> Self {
        Self {
            line: Lpuart::new(),
            findings: Findings::default(),
            cycle: 0,
        }
    }

    /// As the driver of the board opens it.
    fn open(brr: u32) -> Self {
        let mut bench = Self::new();
        bench.put("BRR", brr);
        bench.put("CR2", 0);
        let cr1 = bench.bits("CR1", &["UE", "TE", "RE", "FIFOEN", "RXNEIE", "IDLEIE"]);
        bench.put("CR1", cr1);
        bench.cycle = 10_000;
        bench
    }

    fn context<T>(&mut self, action: impl FnOnce(&mut Lpuart, &mut Context<'_>) -> T) -> T {
        let mut context = Context {
            cycle: self.cycle,
            clocks: &CLOCKS,
            findings: &mut self.findings,
        };
        action(&mut self.line, &mut context)
    }

    fn bits(&self, register: &str, names: &[&str]) -> u32 {
        let file = &self.line.registers;
        names
            .iter()
            .fold(0, |word, name| word | file.field(register, name).mask)
    }

    fn put(&mut self, register: &str, value: u32) {
        let offset = self.line.registers.offset(register);
        self.context(|line, context| line.write(offset, value, context));
    }

    fn get(&mut self, register: &str) -> u32 {
        let offset = self.line.registers.offset(register);
        self.context(|line, context| line.read(offset, context))
    }

    fn flag(&mut self, name: &str) -> bool {
        let mask = self.bits("ISR", &[name]);
        self.get("ISR") & mask != 0
    }

    fn send(&mut self, bytes: &[u8], baud: u32) {
        for byte in bytes {
            self.context(|line, context| line.host_send(*byte, baud, context));
        }
    }

    fn texts(&self) -> Vec<&str> {
        let list = self.findings.list();
        list.iter().map(|finding| finding.text.as_str()).collect()
    }
}

#[test]
fn bytes_leave_one_after_the_other_at_the_rate_of_brr() {
    let mut bench = Bench::open(BRR);
    bench.line.set_host_baud(BAUD);
    for byte in 1..=9 {
        bench.put("TDR", byte);
    }
    assert!(!bench.flag("TXE") && !bench.flag("TC"));
    let start = bench.cycle;
    bench.cycle = start + CHARACTER;
    assert!(bench.flag("TXE") && !bench.flag("TC"));
    bench.cycle = start + 9 * CHARACTER;
    bench.context(Lpuart::advance);
    assert!(bench.flag("TC") && bench.flag("TXFE"));
    let sent = std::iter::from_fn(|| bench.line.host_receive()).collect::<Vec<_>>();
    let expected = (1..=9u8).map(|byte| Sent {
        byte,
        cycle: start + u64::from(byte) * CHARACTER,
    });
    assert_eq!(sent, expected.collect::<Vec<_>>());
    assert!(bench.texts().is_empty(), "{:?}", bench.texts());
}

#[test]
fn bytes_arrive_raise_the_interrupt_and_then_the_line_is_idle() {
    let mut bench = Bench::open(BRR);
    bench.send(b"ab", BAUD);
    let start = bench.cycle;
    assert_eq!(bench.line.next_event(), Some(start + CHARACTER));
    bench.cycle = start + 2 * CHARACTER;
    bench.context(Lpuart::advance);
    assert!(bench.line.interrupt());
    assert_eq!(
        (bench.get("RDR"), bench.get("RDR")),
        (b'a'.into(), b'b'.into())
    );
    assert!(!bench.line.interrupt() && !bench.flag("IDLE"));
    bench.cycle = bench.line.next_event().unwrap();
    assert_eq!(bench.cycle, start + 3 * CHARACTER);
    assert!(bench.flag("IDLE") && bench.line.interrupt());
    let clear = bench.bits("ICR", &["IDLE"]);
    bench.put("ICR", clear);
    assert!(!bench.line.interrupt());
    assert_eq!(bench.line.next_event(), None);
    assert!(bench.texts().is_empty(), "{:?}", bench.texts());
}

#[test]
fn bytes_before_the_receiver_is_ready_are_lost() {
    let mut bench = Bench::open(BRR);
    bench.line.reset();
    bench.send(b"x", BAUD);
    bench.cycle += 100;
    bench.put("BRR", BRR);
    let cr1 = bench.bits("CR1", &["UE", "RE"]);
    bench.put("CR1", cr1);
    bench.cycle += CHARACTER;
    assert!(!bench.flag("RXNE") && bench.flag("REACK") && !bench.flag("TEACK"));
}

#[test]
fn the_fifo_holds_eight_and_one_more_is_an_overrun() {
    let mut bench = Bench::open(BRR);
    bench.send(b"123456789", BAUD);
    bench.cycle += 8 * CHARACTER;
    assert!(bench.flag("RXFF") && !bench.flag("ORE"));
    bench.cycle += CHARACTER;
    assert!(bench.flag("ORE"));
    let received = (0..8).map(|_| bench.get("RDR")).collect::<Vec<_>>();
    assert_eq!(received, b"12345678".map(u32::from));
}

#[test]
fn another_rate_damages_bytes_in_both_directions_and_is_named() {
    // 460 800 and 115 200 baud on the chip, 921 600 on the host.
    for (brr, part) in [(2 * BRR, "46080"), (8 * BRR, "11520")] {
        let mut bench = Bench::open(brr);
        bench.cycle = 1_000_000;
        bench.send(&[0x55], BAUD);
        bench.put("TDR", 0x55);
        bench.cycle += 20 * CHARACTER;
        assert!(bench.flag("NE"));
        assert_ne!(bench.get("RDR"), 0x55);
        assert_ne!(bench.line.host_receive().unwrap().byte, 0x55);
        let texts = bench.texts();
        assert!(
            texts.len() == 1 && texts[0].contains(part) && texts[0].contains("921600"),
            "{texts:?}"
        );
    }
    // 1 % apart is nothing.
    let mut bench = Bench::open(BRR + BRR / 100);
    bench.send(&[0x55], BAUD);
    bench.cycle += 2 * CHARACTER;
    assert_eq!(bench.get("RDR"), 0x55);
    assert!(bench.texts().is_empty(), "{:?}", bench.texts());
}

#[test]
fn mistakes_are_found() {
    type Mistake = fn(&mut Bench);
    let cases: [(&str, Mistake); 6] = [
        ("LPUART1_BRR: 0x2ff is outside", |b| {
            *b = Bench::new();
            b.put("BRR", 0x2ff);
        }),
        ("LPUART1_TDR is written while the transmitter", |b| {
            *b = Bench::new();
            b.put("TDR", 1);
        }),
        ("there is no space", |b| {
            (0..10).for_each(|byte| b.put("TDR", byte));
        }),
        ("LPUART1_BRR or LPUART1_PRESC", |b| b.put("BRR", 0x400)),
        ("LPUART1_CR1: 0x20000000 is changed while UE", |b| {
            let cr1 = b.bits("CR1", &["UE", "TE", "RE"]);
            b.put("CR1", cr1);
        }),
        ("LPUART1_RDR is read while nothing", |b| {
            b.get("RDR");
        }),
    ];
    for (part, mistake) in cases {
        let mut bench = Bench::open(BRR);
        mistake(&mut bench);
        let texts = bench.texts();
        assert!(
            texts.len() == 1 && texts[0].contains(part),
            "{part}: {texts:?}"
        );
    }
}
