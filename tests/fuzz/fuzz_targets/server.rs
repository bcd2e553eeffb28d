//! Whatever bytes come, the server answers every frame with one frame of the same sequence, and no motor is driven with
//! more than its supply.
#![no_main]

use leg_firmware::frame::{Decoder, MAX_FRAME};
use leg_firmware::protocol::Reply;
use leg_firmware::server::Server;
use leg_fuzz::{NoBoard, armed, feed, framed, requests};
use libfuzzer_sys::arbitrary::{self, Arbitrary};
use libfuzzer_sys::fuzz_target;
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
}

/// A server and the decoder in front of it.
struct End {
    server: Server<NoBoard>,
    decoder: Decoder,
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
            check(sequence, answer.expect("every reply fits"));
        }
    }

    /// A frame after whatever came before.
    fn push_frame(&mut self, frame: &[u8]) {
        self.push(&[0]);
        self.push(frame);
    }
}

fn check(sequence: u16, answer: &[u8]) {
    let mut found = feed(&mut Decoder::new(), answer);
    let (answered, payload) = found.pop().expect("one frame").expect("a good one");
    assert!(found.is_empty());
    assert_eq!(answered, sequence);
    let (reply, rest) = postcard::take_from_bytes::<Reply>(&payload).expect("a reply");
    assert!(rest.is_empty());
    if let Reply::Ticked(tick) = reply {
        let sound = |duty: &f32| duty.abs() <= 1.0;
        assert!(tick.drive.duty.iter().all(sound), "{tick:?}");
    }
}

fn damaged(which: u8, damage: &[(u16, u8)]) -> Vec<u8> {
    static REQUESTS: LazyLock<Vec<Vec<u8>>> = LazyLock::new(requests);
    let mut payload = REQUESTS[usize::from(which) % REQUESTS.len()].clone();
    for &(place, changed) in damage {
        let place = usize::from(place) % payload.len();
        payload[place] ^= changed;
    }
    payload
}

fuzz_target!(|input: (bool, Vec<Step>)| {
    let (armed_first, steps) = input;
    let mut end = End {
        server: Server::new(NoBoard),
        decoder: Decoder::new(),
    };
    if armed_first {
        static ARMED: LazyLock<Vec<Vec<u8>>> = LazyLock::new(armed);
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
                let frame = framed(1, &damaged(*which, damage));
                (0..=times % REPEATS).for_each(|_| end.push_frame(&frame));
            }
        }
    }
});
