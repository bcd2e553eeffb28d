//! What an image does wrong with the node: a mistake, and the sentence that it is reported by.

use super::*;

#[test]
fn mistakes_are_found() {
    type Mistake = fn(&mut DeviceBench<Fdcan>);
    let take: Mistake = |b| {
        b.act(|node, context| node.take_transmission(context));
    };
    let cases: &[(&str, Mistake)] = &[
        ("FDCAN2_NBTP is written without INIT and CCE", |b| {
            b.put("NBTP", &[("NTSEG1", 1)]);
        }),
        ("FDCAN2_CCCR: 0x0100 is changed without INIT and CCE", |b| {
            b.put("CCCR", &[("BRSE", 1)]);
        }),
        ("FDCAN2_CCCR: CCE is set before INIT was", |b| {
            b.put("CCCR", &[("CCE", 1), ("INIT", 1), ("FDOE", 1), ("BRSE", 1)]);
        }),
        (
            "FDCAN2_CCCR: INIT is cleared while the block has no clock",
            |b| {
                b.put("CCCR", &[("INIT", 1), ("FDOE", 1), ("BRSE", 1)]);
                b.clocks.fdcan = 0;
                b.put("CCCR", &[("FDOE", 1), ("BRSE", 1)]);
            },
        ),
        (
            "FDCAN2_TEST is changed while TEST in FDCAN2_CCCR is not set",
            |b| b.set("TEST", &[("LBCK", 1)]),
        ),
        (
            "FDCAN2_NBTP and FDCAN2_DBTP give 500000 and 5000000 bit/s, the bus has 1000000 and 5000000 bit/s",
            |b| {
                slower(b, "NBTP", "NBRP");
                assert_eq!(b.hear(OWN), Reception::Error);
                assert_eq!(b.get("ECR", "REC"), 1);
            },
        ),
        (
            "FDCAN2_NBTP and FDCAN2_DBTP give 1000000 and 2500000 bit/s, the bus has 1000000 and 5000000 bit/s",
            |b| {
                slower(b, "DBTP", "DBRP");
                b.send(OWN, &[0; 12]);
            },
        ),
        (
            "FDCAN2_NBTP: it samples at 800 ns the bit in which others change the rate, and which ends at 800 ns",
            |b| {
                sampling(b, 134, 33);
                b.send(OWN, &[0; 12]);
            },
        ),
        (
            "FDCAN2_NBTP: others sample at 750 ns the bit in which it changes the rate, and which ends at 748 ns",
            |b| {
                sampling(b, 117, 50);
                b.send(OWN, &[0; 12]);
            },
        ),
        (
            "FDCAN2_DBTP: TDC is off, and data are sampled after 152 ns: a transceiver may take 255 ns",
            |b| {
                reopen(b, "DBTP", "TDC", 0);
                b.send(OWN, &[0; 12]);
            },
        ),
        (
            "FDCAN2_TDCR: the second sample point is 34 periods into a bit of 34",
            |b| {
                reopen(b, "TDCR", "TDCO", 34);
                b.send(OWN, &[0; 12]);
            },
        ),
        (
            "FDCAN2_CCCR: FDOE is not set, and a frame of CAN FD arrives",
            |b| {
                reopen(b, "CCCR", "FDOE", 0);
                assert_eq!(b.hear(OWN), Reception::Error);
            },
        ),
        (
            "FDCAN2: a frame 0x123 of 500000 and 5000000 bit/s is on the bus",
            |b| {
                let frame = DataFrame {
                    nominal_hz: 500_000,
                    ..frame(OWN)
                };
                b.act(|node, context| node.bus_receive(&frame, context));
            },
        ),
        (
            "FDCAN2_CCCR: FDOE is not set, and a buffer asks for it",
            |b| {
                reopen(b, "CCCR", "FDOE", 0);
                b.send(OWN, &[0; 12]);
            },
        ),
        (
            "FDCAN2_CCCR: BRSE is not set, and a buffer asks for it",
            |b| {
                reopen(b, "CCCR", "BRSE", 0);
                b.send(OWN, &[0; 12]);
            },
        ),
        (
            "FDCAN2: buffer 0 asks for an extended identifier or a remote frame, which this bus has not",
            |b| {
                b.memory(0x278, 1 << 30);
                b.write("TXBAR", 1);
            },
        ),
        (
            "FDCAN2_RXGFC: LSS is 30, and there are 28 standard filters",
            |b| {
                reopen(b, "RXGFC", "LSS", 30);
                b.hear(OWN);
            },
        ),
        (
            "FDCAN2_RXF0A: element 0 is acknowledged, and does not wait",
            |b| b.put("RXF0A", &[("FAI", 0)]),
        ),
        (
            "FDCAN2_RXF1A: element 2 is acknowledged, and does not wait",
            |b| b.put("RXF1A", &[("FAI", 2)]),
        ),
        (
            "FDCAN2_TXEFA: event 1 is acknowledged, and does not wait",
            |b| b.put("TXEFA", &[("EFAI", 1)]),
        ),
        (
            "FDCAN2_TXBAR: buffer 1 is requested out of the order of the FIFO",
            |b| b.write("TXBAR", 2),
        ),
        (
            "FDCAN2_TXBAR: buffer 0 is requested while it waits already",
            |b| {
                b.send(OWN, &[0; 12]);
                b.write("TXBAR", 1);
            },
        ),
        (
            "FDCAN2_TXBAR: buffer 0 is requested while CCE is set",
            |b| {
                b.put("CCCR", &[("INIT", 1), ("FDOE", 1), ("BRSE", 1)]);
                b.put("CCCR", &[("INIT", 1), ("CCE", 1), ("FDOE", 1), ("BRSE", 1)]);
                b.write("TXBAR", 1);
            },
        ),
        (
            "FDCAN2: transmit buffer 0 is written while it waits to be sent",
            |b| {
                b.send(OWN, &[0; 12]);
                b.memory(0x278, 0);
            },
        ),
    ];
    for (expected, mistake) in cases {
        let mut bench = open();
        mistake(&mut bench);
        take(&mut bench);
        assert_eq!(bench.findings(), [*expected]);
    }
}

fn slower(bench: &mut DeviceBench<Fdcan>, register: &str, field: &str) {
    reopen(bench, register, field, 1);
}

/// Other lengths of a nominal bit before and after its sample point.
fn sampling(bench: &mut DeviceBench<Fdcan>, before: u32, after: u32) {
    reopen(bench, "NBTP", "NTSEG1", before);
    reopen(bench, "NBTP", "NTSEG2", after);
}

/// Changes a setting as it has to be done.
fn reopen(bench: &mut DeviceBench<Fdcan>, register: &str, field: &str, value: u32) {
    let file = &bench.device.registers;
    let settings = file.offset("CCCR");
    let place = file.field(register, field);
    let [init, change] = ["INIT", "CCE"].map(|name| file.field("CCCR", name).mask);
    let before = file.get(settings);
    let mut put = |offset, value| {
        bench.act(|node, context| node.write(offset, value, context));
    };
    put(settings, before | init);
    put(settings, before | init | change);
    let old = bench.act(|node, context| node.read(place.offset, context));
    bench.act(|node, context| {
        node.write(place.offset, place.insert(old, value), context);
    });
    let now = bench.device.registers.get(settings) & !init & !change;
    bench.act(|node, context| node.write(settings, now, context));
    bench.cycle += 2 * 11 * BIT;
    bench.act(Fdcan::advance);
}
