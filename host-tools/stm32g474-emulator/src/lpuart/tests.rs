//! The line in both directions.

#![allow(clippy::unwrap_used)]

use super::{Lpuart, Sent};
use crate::bench::DeviceBench;
use crate::device::Device;

const BAUD: u32 = 921_600;
/// 256 × 170 MHz / 921 600 baud, rounded.
const BRR: u32 = 47_222;
/// Ten bits at that rate, in cycles, rounded up.
const CHARACTER: u64 = 1845;
/// As after a reset.
fn closed() -> DeviceBench<Lpuart> {
    DeviceBench::new("LPUART1", |_| Lpuart::new())
}

/// As the driver of the board opens it.
fn open(brr: u32) -> DeviceBench<Lpuart> {
    let mut bench = closed();
    bench.write("BRR", brr);
    bench.write("CR2", 0);
    let switches = ["UE", "TE", "RE", "FIFOEN", "RXNEIE", "IDLEIE"];
    bench.put("CR1", &switches.map(|name| (name, 1)));
    bench.cycle = 10_000;
    bench
}

fn send(bench: &mut DeviceBench<Lpuart>, bytes: &[u8], baud: u32) {
    for byte in bytes {
        bench.act(|line, context| line.host_send(*byte, baud, context));
    }
}

impl DeviceBench<Lpuart> {
    fn flag(&mut self, name: &str) -> bool {
        self.get("ISR", name) != 0
    }
}

#[test]
fn bytes_leave_one_after_the_other_at_the_rate_of_brr() {
    let mut bench = open(BRR);
    bench.device.set_host_baud(BAUD);
    for byte in 1..=9 {
        bench.write("TDR", byte);
    }
    assert!(!bench.flag("TXE") && !bench.flag("TC"));
    let start = bench.cycle;
    bench.cycle = start + CHARACTER;
    assert!(bench.flag("TXE") && !bench.flag("TC"));
    bench.cycle = start + 9 * CHARACTER;
    bench.act(Lpuart::advance);
    assert!(bench.flag("TC") && bench.flag("TXFE"));
    let sent = std::iter::from_fn(|| bench.device.host_receive()).collect::<Vec<_>>();
    let expected = (1..=9u8).map(|byte| Sent {
        byte,
        cycle: start + u64::from(byte) * CHARACTER,
    });
    assert_eq!(sent, expected.collect::<Vec<_>>());
    assert_eq!(bench.findings(), [""; 0]);
}

#[test]
fn bytes_arrive_raise_the_interrupt_and_then_the_line_is_idle() {
    let mut bench = open(BRR);
    send(&mut bench, b"ab", BAUD);
    let start = bench.cycle;
    assert_eq!(bench.device.next_event(), Some(start + CHARACTER));
    bench.cycle = start + 2 * CHARACTER;
    bench.act(Lpuart::advance);
    assert!(bench.device.interrupt());
    assert_eq!(
        (bench.read("RDR"), bench.read("RDR")),
        (b'a'.into(), b'b'.into())
    );
    assert!(!bench.device.interrupt() && !bench.flag("IDLE"));
    bench.cycle = bench.device.next_event().unwrap();
    assert_eq!(bench.cycle, start + 3 * CHARACTER);
    assert!(bench.flag("IDLE") && bench.device.interrupt());
    bench.put("ICR", &[("IDLE", 1)]);
    assert!(!bench.device.interrupt());
    assert_eq!(bench.device.next_event(), None);
    assert_eq!(bench.findings(), [""; 0]);
}

#[test]
fn bytes_before_the_receiver_is_ready_are_lost() {
    let mut bench = open(BRR);
    bench.device.reset();
    send(&mut bench, b"x", BAUD);
    bench.cycle += 100;
    bench.write("BRR", BRR);
    bench.put("CR1", &[("UE", 1), ("RE", 1)]);
    bench.cycle += CHARACTER;
    assert!(!bench.flag("RXNE") && bench.flag("REACK") && !bench.flag("TEACK"));
}

#[test]
fn the_fifo_holds_eight_and_one_more_is_an_overrun() {
    let mut bench = open(BRR);
    send(&mut bench, b"123456789", BAUD);
    bench.cycle += 8 * CHARACTER;
    assert!(bench.flag("RXFF") && !bench.flag("ORE"));
    bench.cycle += CHARACTER;
    assert!(bench.flag("ORE"));
    let received = (0..8).map(|_| bench.read("RDR")).collect::<Vec<_>>();
    assert_eq!(received, b"12345678".map(u32::from));
}

#[test]
fn another_rate_damages_bytes_in_both_directions_and_is_named() {
    // 460 800 and 115 200 baud on the chip, 921 600 on the host.
    for (brr, part) in [(2 * BRR, "46080"), (8 * BRR, "11520")] {
        let mut bench = open(brr);
        bench.cycle = 1_000_000;
        send(&mut bench, &[0x55], BAUD);
        bench.write("TDR", 0x55);
        bench.cycle += 20 * CHARACTER;
        assert!(bench.flag("NE"));
        assert_ne!(bench.read("RDR"), 0x55);
        assert_ne!(bench.device.host_receive().unwrap().byte, 0x55);
        let texts = bench.findings();
        assert!(
            texts.len() == 1 && texts[0].contains(part) && texts[0].contains("921600"),
            "{texts:?}"
        );
    }
    // 1 % apart is nothing.
    let mut bench = open(BRR + BRR / 100);
    send(&mut bench, &[0x55], BAUD);
    bench.cycle += 2 * CHARACTER;
    assert_eq!(bench.read("RDR"), 0x55);
    assert_eq!(bench.findings(), [""; 0]);
}

#[test]
fn mistakes_are_found() {
    type Mistake = fn(&mut DeviceBench<Lpuart>);
    let cases: &[(&str, Mistake)] = &[
        ("LPUART1_BRR: 0x2ff is outside of 0x300 to 0xfffff", |b| {
            *b = closed();
            b.write("BRR", 0x2ff);
        }),
        (
            "LPUART1_BRR is 0x0 where TE or RE is set, outside of 0x300 to 0xfffff",
            |b| {
                *b = closed();
                b.put("CR1", &[("UE", 1), ("TE", 1)]);
            },
        ),
        (
            "LPUART1_CR1: characters are not of 8 bits without parity, as the host's are",
            |b| {
                *b = closed();
                b.put("CR1", &[("PCE", 1)]);
                b.put("CR1", &[("PCE", 1), ("UE", 1)]);
            },
        ),
        ("LPUART1_TDR is written while the transmitter is off", |b| {
            *b = closed();
            b.write("TDR", 1);
        }),
        (
            "LPUART1_TDR is written while there is no space, and a byte is lost",
            |b| (0..10).for_each(|byte| b.write("TDR", byte)),
        ),
        (
            "LPUART1_BRR or LPUART1_PRESC is written while UE is set, and has no effect",
            |b| b.write("BRR", 0x400),
        ),
        (
            "LPUART1_CR1: 0x20000000 is changed while UE is set, and has no effect",
            |b| b.put("CR1", &[("UE", 1), ("TE", 1), ("RE", 1)]),
        ),
        ("LPUART1_RDR is read while nothing has been received", |b| {
            b.read("RDR");
        }),
        ("LPUART1_RQR: 0x2 asks for what the emulator has not", |b| {
            b.put("RQR", &[("SBKRQ", 1)]);
        }),
    ];
    for (expected, mistake) in cases {
        let mut bench = open(BRR);
        mistake(&mut bench);
        assert_eq!(bench.findings(), [*expected]);
    }
}
