mod loss;
mod payloads;

use super::{Assembler, CanError, CanFrame, LegAddress, Segmenter};
use crate::frame::MAX_FRAME;

const LEG: LegAddress = LegAddress::ALL[2];
const OTHER: LegAddress = LegAddress::ALL[3];

/// Link frames and faults, in the order in which they came.
type Came = (Vec<Vec<u8>>, Vec<CanError>);

/// A link frame of this length; no two are alike.
fn link_frame(length: usize, mark: u8) -> Vec<u8> {
    let mut bytes: Vec<u8> = (1..=255).cycle().take(length - 1).collect();
    if let Some(first) = bytes.first_mut() {
        *first = mark;
    }
    bytes.push(0);
    bytes
}

fn cut(segmenter: &mut Segmenter, link_frame: &[u8]) -> Vec<CanFrame> {
    match segmenter.segments(link_frame) {
        Ok(segments) => segments.collect(),
        Err(error) => panic!("{} bytes: {error}", link_frame.len()),
    }
}

fn push_all<'a, const N: usize>(
    assembler: &mut Assembler<N>,
    frames: impl IntoIterator<Item = &'a CanFrame>,
) -> Came {
    let mut came = Came::default();
    for frame in frames {
        let taken = assembler.push(frame);
        came.0.extend(taken.link_frame.map(<[u8]>::to_vec));
        came.1.extend(taken.fault);
    }
    came
}

fn join(frames: &[CanFrame]) -> Came {
    push_all(&mut Assembler::<MAX_FRAME>::leg_receiver(LEG), frames)
}
