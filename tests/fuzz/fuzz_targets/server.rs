//! Whatever bytes come, the server answers every frame with one frame of the same sequence, no motor is driven with more
//! than its supply, and what the leg says to its own host are whole replies.
#![no_main]

use leg_firmware::frame::{Decoder, MAX_FRAME};
use leg_firmware::host_link::HostReply;
use leg_firmware::recorder::Recorder;
use leg_firmware_bench::protocol::Reply;
use leg_firmware_bench::server::Server;
use leg_fuzz::{NoBoard, armed, brought, feed, framed, host_requests, requests};
use libfuzzer_sys::arbitrary::{self, Arbitrary};
use libfuzzer_sys::fuzz_target;
use serde::Deserialize;
use std::sync::LazyLock;

/// Most times that a request is sent in a row.
const REPEATS: u8 = 32;

#[derive(Arbitrary, Debug)]
enum Step {
    /// Bytes of no frame.
    Bytes(Vec<u8>),
    /// A good frame with any payload.
    Payload { sequence: u16, payload: Vec<u8> },
    /// A request with some bytes changed, in a good frame.
    Request {
        which: u8,
        damage: Vec<(u16, u8)>,
        times: u8,
    },
    /// A host's request with some bytes changed, in a good frame, in good ticks.
    HostRequest {
        which: u8,
        damage: Vec<(u16, u8)>,
        times: u8,
    },
    /// A good frame with any payload, in good ticks.
    HostPayload { sequence: u16, payload: Vec<u8> },
}

/// A server, the decoder in front of it, and the one of the host that talks to the leg behind it.
struct End {
    server: Server<NoBoard, Box<Recorder>>,
    decoder: Decoder,
    host: Decoder,
}

impl End {
    fn push(&mut self, bytes: &[u8]) {
        let mut out = [0; MAX_FRAME];
        for &byte in bytes {
            let Some(request) = self.decoder.push(byte) else {
                continue;
            };
            let sequence = request.map_or(0, |frame| frame.sequence);
            let answer = self.server.answer(request, &mut out);
            let reply = reply(sequence, answer.expect("every reply fits"));
            self.check(&reply);
        }
    }

    fn check(&mut self, reply: &Reply) {
        match reply {
            // The new leg's line is another one.
            Reply::Started => self.host = Decoder::new(),
            Reply::Ticked(tick) => {
                let sound = |duty: &f32| duty.abs() <= 1.0;
                assert!(tick.drive.duty.iter().all(sound), "{tick:?}");
                let finite = |number: f32| assert!(number.is_finite(), "{tick:?}");
                tick.telemetry.map(finite);
                for found in feed(&mut self.host, &tick.link) {
                    let (_, payload) = found.expect("a good frame");
                    whole::<HostReply>(&payload);
                }
            }
            _ => {}
        }
    }

    /// A frame after whatever came before.
    fn push_frame(&mut self, frame: &[u8]) {
        self.push(&[0]);
        self.push(frame);
    }

    /// A frame for the leg, after whatever it has heard before.
    fn push_to_leg(&mut self, sequence: u16, payload: &[u8]) {
        for tick in brought(sequence, payload) {
            self.push_frame(&framed(1, &tick));
        }
    }
}

/// The only reply in an answer to a request of this sequence.
fn reply(sequence: u16, answer: &[u8]) -> Reply {
    let mut found = feed(&mut Decoder::new(), answer);
    let (answered, payload) = found.pop().expect("one frame").expect("a good one");
    assert!(found.is_empty());
    assert_eq!(answered, sequence);
    whole(&payload)
}

/// The message that fills a payload.
fn whole<T: for<'a> Deserialize<'a>>(payload: &[u8]) -> T {
    let (message, rest) = postcard::take_from_bytes(payload).expect("a message");
    assert!(rest.is_empty());
    message
}

fn damaged(payloads: &[Vec<u8>], which: u8, damage: &[(u16, u8)]) -> Vec<u8> {
    let mut payload = payloads[usize::from(which) % payloads.len()].clone();
    for &(place, changed) in damage {
        let place = usize::from(place) % payload.len();
        payload[place] ^= changed;
    }
    payload
}

static ARMED: LazyLock<Vec<Vec<u8>>> = LazyLock::new(armed);
static REQUESTS: LazyLock<Vec<Vec<u8>>> = LazyLock::new(requests);
static HOST_REQUESTS: LazyLock<Vec<Vec<u8>>> = LazyLock::new(host_requests);

fuzz_target!(|input: (bool, Vec<Step>)| {
    let (armed_first, steps) = input;
    let mut end = End {
        server: Server::new(NoBoard, Box::default()),
        decoder: Decoder::new(),
        host: Decoder::new(),
    };
    if armed_first {
        for payload in ARMED.iter() {
            end.push_frame(&framed(1, payload));
        }
    }
    for step in &steps {
        match step {
            Step::Bytes(bytes) => end.push(bytes),
            Step::Payload { sequence, payload } => end.push_frame(&framed(*sequence, payload)),
            Step::Request {
                which,
                damage,
                times,
            } => {
                let frame = framed(1, &damaged(&REQUESTS, *which, damage));
                (0..=times % REPEATS).for_each(|_| end.push_frame(&frame));
            }
            Step::HostRequest {
                which,
                damage,
                times,
            } => {
                let payload = damaged(&HOST_REQUESTS, *which, damage);
                (0..=times % REPEATS).for_each(|_| end.push_to_leg(1, &payload));
            }
            Step::HostPayload { sequence, payload } => end.push_to_leg(*sequence, payload),
        }
    }
});
