//! Whatever comes before a delimiter, the frame that follows it is decoded, alone and as it was sent.
#![no_main]

use leg_firmware::frame::{Decoder, MAX_PAYLOAD};
use leg_fuzz::{feed, framed};
use libfuzzer_sys::arbitrary::{self, Arbitrary};
use libfuzzer_sys::fuzz_target;

#[derive(Arbitrary, Debug)]
struct Input {
    before: Vec<u8>,
    sequence: u16,
    payload: Vec<u8>,
    /// Damage to a copy of the frame that goes before it: place, and what is added to the byte there.
    damage: Vec<(u16, u8)>,
}

fuzz_target!(|input: Input| {
    let payload = &input.payload[..input.payload.len().min(MAX_PAYLOAD)];
    let good = framed(input.sequence, payload);
    let mut damaged = good.clone();
    for &(place, added) in &input.damage {
        let place = usize::from(place) % damaged.len();
        damaged[place] = damaged[place].wrapping_add(added);
    }
    let mut decoder = Decoder::new();
    feed(&mut decoder, &input.before);
    feed(&mut decoder, &damaged);
    feed(&mut decoder, &[0]);
    let expected = Ok((input.sequence, payload.to_vec()));
    assert_eq!(feed(&mut decoder, &good), [expected]);
});
