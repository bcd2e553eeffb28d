//! Whatever CAN frames come, what comes out are whole link frames; of a sender's stream with CAN frames lost and doubled,
//! only such as it sent, in its order; and the next undamaged one gets through.
#![no_main]

use leg_firmware::can::{Assembler, CanFrame, Identifier, LegAddress, Segmenter};
use leg_fuzz::framed;
use libfuzzer_sys::arbitrary::{self, Arbitrary};
use libfuzzer_sys::fuzz_target;

const LEG: LegAddress = LegAddress::ALL[0];

/// Fewer than the counter tells apart, so that no loss can hide.
const STREAM_FRAMES: usize = 255;

/// Longest link frame that the receiver takes, bytes.
const TAKEN: usize = 300;

#[derive(Arbitrary, Debug)]
enum Fate {
    Arrives,
    Lost,
    Doubled,
}

#[derive(Arbitrary, Debug)]
struct Input {
    any: Vec<(u16, Vec<u8>)>,
    lengths: Vec<u16>,
    fates: Vec<Fate>,
}

type End = Assembler<TAKEN>;

fn push(end: &mut End, frame: &CanFrame) -> Option<Vec<u8>> {
    let link_frame = end.push(frame).link_frame?;
    assert!(link_frame.len() <= TAKEN && link_frame.ends_with(&[0]));
    Some(link_frame.to_vec())
}

/// A link frame that tells its number.
fn numbered(number: usize, length: u16) -> Vec<u8> {
    let length = usize::from(length) % 400;
    framed(number as u16, &vec![number as u8; length])
}

/// Sends numbered link frames, and checks what of them arrives.
fn damaged_stream(end: &mut End, input: &Input) {
    let mut segmenter = Segmenter::new(Identifier::ToLeg(LEG));
    let mut sent = Vec::new();
    let mut frames = Vec::new();
    for (number, &length) in input.lengths.iter().enumerate() {
        sent.push(numbered(number, length));
        let segments = segmenter.segments(&sent[number]);
        frames.extend(segments.expect("it is one link frame"));
        if frames.len() > STREAM_FRAMES {
            frames.truncate(STREAM_FRAMES);
            break;
        }
    }
    let fates = input.fates.iter().chain(std::iter::repeat(&Fate::Arrives));
    let mut left = sent.iter();
    for (place, (frame, fate)) in frames.iter().zip(fates).enumerate() {
        let times = match fate {
            Fate::Lost => 0,
            // The first of a sender tells that it starts anew, and so is none.
            Fate::Doubled if place > 0 => 2,
            Fate::Arrives | Fate::Doubled => 1,
        };
        for _ in 0..times {
            if let Some(received) = push(end, frame) {
                assert!(left.any(|sent| *sent == received), "joined falsely");
            }
        }
    }
}

fuzz_target!(|input: Input| {
    let mut end = End::leg_receiver(LEG);
    damaged_stream(&mut end, &input);
    for (bits, payload) in &input.any {
        let identifier = Identifier::from_bits(*bits).unwrap_or(Identifier::ToLeg(LEG));
        if let Ok(frame) = CanFrame::new(identifier, payload) {
            push(&mut end, &frame);
        }
    }
    let good = framed(7, &[7; 200]);
    let mut segmenter = Segmenter::new(Identifier::ToLeg(LEG));
    let segments = segmenter.segments(&good).expect("it is one link frame");
    let received: Vec<_> = segments
        .filter_map(|frame| push(&mut end, &frame))
        .collect();
    assert_eq!(received, [good]);
});
