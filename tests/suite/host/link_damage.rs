//! Every byte of a request's frame cut, flipped, doubled, exchanged and inserted: never another request, and the next good
//! frame is read.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use leg_firmware::command::Command;
use leg_firmware::frame::{Decoder, FrameError, MAX_FRAME, encode};
use leg_firmware::host_link::Hello;
use leg_firmware::host_link::HostRequest;
use leg_firmware::sensors::Sensors;
use leg_firmware::settings::TendonParameters;
use leg_firmware_bench::example;
use leg_firmware_bench::protocol::{BENCH_SCHEMA, EvaluateRequest, Request, TickRequest};
use leg_firmware_bench::query::QueryMessage;
use leg_model::{CURVE_POINTS_MAX, CurvePoint, RigParameters};
use std::fmt;

/// Sequence of the frame that is damaged, and of the one behind it.
const DAMAGED: u16 = 0x0102;
const NEXT: u16 = 0x0103;

type Found = Result<(u16, Option<Request>), FrameError>;

fn framed(sequence: u16, request: &Request) -> Vec<u8> {
    encode(sequence, request, &mut [0; MAX_FRAME])
        .unwrap()
        .to_vec()
}

fn decode(bytes: &[u8]) -> Vec<Found> {
    let mut decoder = Decoder::new();
    let mut found = Vec::new();
    for &byte in bytes {
        let next = decoder.push(byte);
        found.extend(next.map(|frame| frame.map(|frame| (frame.sequence, frame.message()))));
    }
    found
}

/// A short request, one with a frame inside, and one that takes more than one of COBS's blocks.
fn requests() -> [Request; 3] {
    [
        Request::Hello(Hello {
            schema: BENCH_SCHEMA,
        }),
        tick(),
        Request::Evaluate(evaluate()),
    ]
}

/// Tendons with curves whose numbers have no zero byte, so that 254 bytes and more follow each other without one. What the
/// model would say to them does not matter here.
fn evaluate() -> EvaluateRequest {
    let point = |_| CurvePoint {
        tension_n: 0.1,
        elongation_m: 0.1,
        stiffness_n_per_m: 0.1,
    };
    let curve = |points| TendonParameters::Curve((0..points).map(point).collect());
    EvaluateRequest {
        rig: RigParameters::<f32, 3>::TABLE_1,
        query: QueryMessage {
            tendons: [
                curve(CURVE_POINTS_MAX),
                curve(6),
                TendonParameters::Constant(1e5),
            ],
            ..example::query()
        },
    }
}

/// A tick with a command inside: a frame in a frame.
fn tick() -> Request {
    let mut out = [0; MAX_FRAME];
    let command = HostRequest::Command {
        host: 1,
        command: Command::Move { x: 0.1, y: -0.2 },
    };
    let command = encode(9, &command, &mut out).unwrap();
    Request::Tick(TickRequest {
        sensors: Sensors {
            encoder_counts: [0, 1, u16::MAX],
            cell_codes: [23_590; 3],
            cell_fresh: [true; 3],
            ..Sensors::default()
        },
        link: command.iter().copied().collect(),
    })
}

/// Sends a damaged frame and a good one. The first may be read as what it was or not at all; the second is read, unless
/// the zero between them is gone; then the one after it is.
fn check(request: &Request, damaged: &[u8], what: fmt::Arguments<'_>) {
    let next = Request::Hello(Hello { schema: [7; 8] });
    let good = framed(NEXT, &next);
    let read = Ok((NEXT, Some(next)));
    let delimited = damaged.is_empty() || damaged.ends_with(&[0]);
    let sent = [damaged, &good, &good].concat();
    let found = decode(&sent);
    let after = if delimited { 2 } else { 1 };
    let (first, second) = found.split_at(found.len() - after);
    assert!(
        second.iter().all(|found| *found == read),
        "{what}: {found:?}"
    );
    let harmless = |found: &Found| match found {
        Err(_) => true,
        Ok((sequence, message)) => *sequence == DAMAGED && message.as_ref() == Some(request),
    };
    assert!(first.iter().all(harmless), "{what}: {found:?}");

    // A zero in front costs a byte, and then nothing but the damaged frame itself.
    let found = decode(&[damaged, &[0], &good].concat());
    assert_eq!(found.last(), Some(&read), "{what}");
}

/// Every request with its frame and each place in it.
fn visit_places(of: impl Fn(&Request, &[u8], usize)) {
    for request in requests() {
        let frame = framed(DAMAGED, &request);
        (0..frame.len()).for_each(|place| of(&request, &frame, place));
    }
}

#[test]
fn the_longest_request_takes_a_full_block() {
    let frame = framed(DAMAGED, &Request::Evaluate(evaluate()));
    let mut place = 0;
    let mut codes = Vec::new();
    // Each block begins with how far it is to the next one.
    while frame[place] != 0 {
        codes.push(frame[place]);
        place += usize::from(frame[place]);
    }
    assert!(codes.contains(&u8::MAX), "{codes:?}");
}

#[test]
fn a_byte_that_is_cut_makes_no_other_request() {
    visit_places(|request, frame, place| {
        let mut damaged = frame.to_vec();
        damaged.remove(place);
        check(request, &damaged, format_args!("without byte {place}"));
        check(request, &frame[..place], format_args!("{place} bytes"));
        check(
            request,
            &frame[place..],
            format_args!("from byte {place} on"),
        );
    });
}

#[test]
fn a_bit_that_is_flipped_makes_no_other_request() {
    visit_places(|request, frame, place| {
        for bit in 0..8 {
            let mut damaged = frame.to_vec();
            damaged[place] ^= 1 << bit;
            check(request, &damaged, format_args!("bit {bit} of byte {place}"));
        }
    });
}

#[test]
fn a_byte_that_comes_twice_or_too_late_makes_no_other_request() {
    visit_places(|request, frame, place| {
        let mut doubled = frame.to_vec();
        doubled.insert(place, frame[place]);
        check(request, &doubled, format_args!("byte {place} twice"));
        let mut exchanged = frame.to_vec();
        exchanged.swap(place, (place + 1) % frame.len());
        check(request, &exchanged, format_args!("byte {place} too late"));
    });
}

#[test]
fn a_byte_that_is_inserted_or_changed_makes_no_other_request() {
    visit_places(|request, frame, place| {
        for byte in 0..=u8::MAX {
            let mut damaged = frame.to_vec();
            damaged.insert(place, byte);
            check(
                request,
                &damaged,
                format_args!("{byte} before byte {place}"),
            );
            damaged.remove(place);
            damaged[place] = byte;
            check(request, &damaged, format_args!("byte {place} is {byte}"));
        }
    });
}

#[test]
fn a_run_of_bytes_that_is_lost_makes_no_other_request() {
    visit_places(|request, frame, from| {
        for to in from + 1..=frame.len() {
            let damaged = [&frame[..from], &frame[to..]].concat();
            check(request, &damaged, format_args!("without {from} to {to}"));
        }
    });
}
