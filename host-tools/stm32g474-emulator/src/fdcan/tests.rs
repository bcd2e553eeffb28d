//! A node on a bus of 1 and 5 Mbit/s, set up as the driver of the board does.

#![allow(clippy::unwrap_used)]

mod mistakes;

use super::{CanBus, DataFrame, Fdcan, Reception, TransmitOutcome};
use crate::bench::DeviceBench;
use crate::device::Device;

const BUS: CanBus = CanBus {
    nominal_hz: 1_000_000,
    data_hz: 5_000_000,
    sample_permille: 750,
};
/// Nanoseconds are not cycles; a bit at 1 Mbit/s is 170 of these.
const BIT: u64 = 170;
const OWN: u16 = 0x123;

/// On the bus, with one filter for [`OWN`] into FIFO 0.
fn open() -> DeviceBench<Fdcan> {
    let mut bench = DeviceBench::new("FDCAN2", |_| Fdcan::new(BUS));
    bench.cycle = 0;
    bench.put("CCCR", &[("INIT", 1)]);
    bench.put("CCCR", &[("INIT", 1), ("CCE", 1)]);
    bench.put("NBTP", &[("NTSEG1", 126), ("NTSEG2", 41), ("NSJW", 41)]);
    bench.put(
        "DBTP",
        &[("DTSEG1", 24), ("DTSEG2", 7), ("DSJW", 7), ("TDC", 1)],
    );
    bench.put("TDCR", &[("TDCO", 26)]);
    bench.put(
        "RXGFC",
        &[("LSS", 28), ("LSE", 8), ("ANFS", 2), ("ANFE", 2)],
    );
    bench.write("TXBTIE", 7);
    bench.put("IE", &[("RFNE0", 1), ("TCE", 1), ("BOE", 1)]);
    bench.put("ILE", &[("EINT0", 1), ("EINT1", 1)]);
    for word in 0..212 {
        bench.memory(word * 4, 0);
    }
    bench.filter(0, 1, 1, OWN, OWN);
    bench.put("CCCR", &[("INIT", 1), ("CCE", 1), ("FDOE", 1), ("BRSE", 1)]);
    bench.put("CCCR", &[("FDOE", 1), ("BRSE", 1)]);
    bench.cycle = 11 * BIT;
    bench.act(Fdcan::advance);
    bench
}

impl DeviceBench<Fdcan> {
    fn memory(&mut self, offset: u32, value: u32) {
        self.act(|node, context| node.write_memory(offset, value, context));
    }

    fn filter(&mut self, number: u32, kind: u32, action: u32, first: u16, second: u16) {
        let word = kind << 30 | action << 27 | u32::from(first) << 16 | u32::from(second);
        self.memory(number * 4, word);
    }

    /// As the driver hands a frame over.
    fn send(&mut self, identifier: u16, payload: &[u8; 12]) {
        let buffer = self.get("TXFQS", "TFQPI");
        let start = 0x278 + buffer * 72;
        self.memory(start, u32::from(identifier) << 18);
        // 12 bytes, switched, CAN FD.
        self.memory(start + 4, 9 << 16 | 1 << 20 | 1 << 21);
        for (index, bytes) in (2..).zip(payload.chunks(4)) {
            self.memory(
                start + index * 4,
                u32::from_le_bytes(bytes.try_into().unwrap()),
            );
        }
        self.write("TXBAR", 1 << buffer);
    }

    fn end(&mut self, outcome: TransmitOutcome) {
        self.act(|node, context| node.take_transmission(context))
            .unwrap();
        self.act(|node, context| node.transmission_ends(outcome, context));
    }

    fn hear(&mut self, identifier: u16) -> Reception {
        let frame = frame(identifier);
        self.act(|node, context| node.bus_receive(&frame, context))
    }

    fn silent(&mut self) {
        assert_eq!(self.findings(), [""; 0]);
    }
}

fn frame(identifier: u16) -> DataFrame {
    DataFrame {
        identifier,
        fd: true,
        bit_rate_switch: true,
        payload: (1..=12).collect(),
        nominal_hz: BUS.nominal_hz,
        data_hz: BUS.data_hz,
    }
}

#[test]
fn a_node_joins_after_eleven_bits() {
    let mut bench = open();
    assert!(bench.device.takes_part());
    assert_eq!(bench.get("PSR", "ACT"), 1);
    bench.device.reset();
    assert!(!bench.device.takes_part());
    assert_eq!(bench.get("CREL", "REL"), 3);
    assert_eq!(bench.get("ENDN", "ETV"), 0x8765_4321);
    bench.silent();
}

#[test]
fn a_frame_leaves_with_its_rates_and_ends_with_an_interrupt() {
    let mut bench = open();
    let payload = core::array::from_fn(|index| index as u8 + 1);
    bench.send(OWN, &payload);
    assert_eq!(bench.device.wants(), Some(OWN));
    let sent = bench.act(|node, context| node.take_transmission(context));
    assert_eq!(sent, Some(frame(OWN)));
    assert_eq!(bench.device.wants(), None);
    assert_eq!(bench.get("PSR", "ACT"), 3);
    bench.act(|node, context| node.transmission_ends(TransmitOutcome::Acknowledged, context));
    assert_eq!(bench.read("TXBTO"), 1);
    assert_eq!(bench.read("TXBRP"), 0);
    assert_eq!(bench.device.interrupt_lines(), [true, false]);
    bench.put("ILS", &[("SMSG", 1)]);
    assert_eq!(bench.device.interrupt_lines(), [false, true]);
    bench.put("IR", &[("TC", 1), ("TFE", 1)]);
    assert_eq!(bench.device.interrupt_lines(), [false, false]);
    bench.silent();
}

#[test]
fn three_frames_wait_in_order_and_are_taken_back() {
    let mut bench = open();
    for identifier in [3, 2, 1] {
        bench.send(identifier, &[0; 12]);
    }
    assert_eq!(bench.get("TXFQS", "TFQF"), 1);
    assert_eq!(bench.device.wants(), Some(3));
    bench.act(|node, context| node.take_transmission(context));
    bench.write("TXBCR", 7);
    assert_eq!(bench.read("TXBRP"), 1);
    bench.act(|node, context| node.transmission_ends(TransmitOutcome::Unacknowledged, context));
    assert_eq!(bench.get("TXFQS", "TFFL"), 3);
    assert_eq!(bench.read("TXBCF"), 7);
    assert_eq!(bench.device.wants(), None);
    bench.send(4, &[0; 12]);
    assert_eq!(bench.device.wants(), Some(4));
    bench.silent();
}

#[test]
fn filters_choose_and_a_full_fifo_loses() {
    let mut bench = open();
    bench.filter(1, 0, 2, 0x200, 0x20f);
    bench.filter(2, 2, 3, 0x300, 0x7f0);
    bench.filter(3, 2, 1, 0x300, 0x700);
    for (identifier, fill) in [
        (OWN, [1, 0]),
        (OWN + 1, [1, 0]),
        (0x20f, [1, 1]),
        (0x210, [1, 1]),
        (0x305, [1, 1]),
        (0x310, [2, 1]),
        (OWN, [3, 1]),
        (OWN, [3, 1]),
    ] {
        assert_eq!(bench.hear(identifier), Reception::Acknowledged);
        let found = ["RXF0S", "RXF1S"].map(|register| bench.get(register, "FFL"));
        assert_eq!(found, fill, "{identifier:#x}");
    }
    assert_eq!(bench.get("RXF0S", "RFL"), 1);
    assert_eq!(bench.device.interrupt_lines(), [true, false]);
    let words = [0, 4, 8, 16].map(|at| bench.device.read_memory(0xb0 + at));
    assert_eq!(
        words,
        [
            u32::from(OWN) << 18,
            9 << 16 | 1 << 20 | 1 << 21,
            0x0403_0201,
            0x0c0b_0a09
        ]
    );
    // The second element is of filter 3.
    assert_eq!(bench.device.read_memory(0xb0 + 72 + 4) >> 24, 3);
    bench.put("RXF0A", &[("FAI", 0)]);
    assert_eq!(bench.get("RXF0S", "FGI"), 1);
    assert_eq!(bench.get("RXF0S", "FFL"), 2);
    bench.silent();
}

#[test]
fn a_node_alone_becomes_passive_and_one_with_bad_wires_goes_off_and_comes_back() {
    let mut bench = open();
    bench.send(OWN, &[0; 12]);
    for _ in 0..40 {
        bench.end(TransmitOutcome::Unacknowledged);
    }
    assert_eq!(bench.get("ECR", "TEC"), 128);
    assert_eq!(bench.get("PSR", "LEC"), 3);
    assert_eq!(bench.get("PSR", "LEC"), 7);
    assert_eq!((bench.get("PSR", "EP"), bench.get("PSR", "BO")), (1, 0));
    for _ in 0..16 {
        bench.end(TransmitOutcome::Disturbed);
    }
    assert_eq!(bench.get("PSR", "BO"), 1);
    assert_eq!(bench.get("CCCR", "INIT"), 1);
    assert_eq!(bench.get("IR", "BO"), 1);
    assert_eq!(bench.device.wants(), None);
    bench.put("CCCR", &[("FDOE", 1), ("BRSE", 1)]);
    let back = bench.cycle + 129 * 11 * BIT;
    assert_eq!(bench.device.next_event(), Some(back));
    bench.cycle = back;
    assert_eq!(bench.get("PSR", "BO"), 0);
    assert_eq!(bench.get("ECR", "TEC"), 0);
    assert_eq!(bench.device.wants(), Some(OWN));
    bench.silent();
}

#[test]
fn a_frame_takes_the_bits_of_the_standard() {
    let alternating = |fd, length| DataFrame {
        identifier: 0x555,
        fd,
        bit_rate_switch: fd,
        payload: vec![0x55; length],
        ..frame(0)
    };
    // Nothing to stuff: 17 bits before the data phase, 12 after it; in it ESI, length, data, count, CRC, fixed bits and
    // delimiter.
    assert_eq!(
        alternating(true, 64).bits(),
        [29, 1 + 4 + 512 + 4 + 21 + 7 + 1]
    );
    assert_eq!(
        alternating(true, 12).bits(),
        [29, 1 + 4 + 96 + 4 + 17 + 6 + 1]
    );
    assert_eq!(alternating(true, 64).duration_ns(), 29_000 + 550 * 200);
    // 111 bits with eight bytes, and one that is stuffed into the CRC, 0x1B04.
    assert_eq!(alternating(false, 8).bits(), [112, 0]);
    let mut zeros = alternating(true, 8);
    zeros.payload = vec![0; 8];
    // 64 zeros after the three of the length code: a bit is stuffed after each five.
    let stuffed = zeros.bits()[1] - alternating(true, 8).bits()[1];
    assert_eq!(stuffed, 13);
}
