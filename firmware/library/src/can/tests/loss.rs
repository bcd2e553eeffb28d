use super::{LEG, cut, join, link_frame, push_all};
use crate::can::{Assembler, CanError, CanFrame, Identifier, PAYLOAD_MAX, SEGMENT_MAX, Segmenter};
use crate::frame::{Decoder, FrameError, MAX_FRAME, encode};
use proptest::collection::vec;
use proptest::prelude::{any, proptest};

/// Link frames of 1, 2, 4 and 1 segments, and the CAN frames of each.
fn stream() -> Vec<(Vec<u8>, Vec<CanFrame>)> {
    let mut segmenter = Segmenter::new(Identifier::ToLeg(LEG));
    let lengths = [(9, 1), (SEGMENT_MAX + 1, 2), (4 * SEGMENT_MAX, 3), (22, 4)];
    lengths
        .map(|(length, mark)| {
            let link_frame = link_frame(length, mark);
            let frames = cut(&mut segmenter, &link_frame);
            (link_frame, frames)
        })
        .to_vec()
}

fn link_frames_but(stream: &[(Vec<u8>, Vec<CanFrame>)], damaged: &[usize]) -> Vec<Vec<u8>> {
    let kept = stream
        .iter()
        .enumerate()
        .filter(|(index, _)| !damaged.contains(index));
    kept.map(|(_, (link_frame, _))| link_frame.clone())
        .collect()
}

/// Each CAN frame of the stream with the number of the link frame that it belongs to.
fn numbered(stream: &[(Vec<u8>, Vec<CanFrame>)]) -> Vec<(usize, CanFrame)> {
    let of = |(index, (_, frames)): (usize, &(_, Vec<CanFrame>))| -> Vec<(usize, CanFrame)> {
        frames.iter().map(|frame| (index, *frame)).collect()
    };
    stream.iter().enumerate().flat_map(of).collect()
}

#[test]
fn a_lost_can_frame_costs_its_own_link_frame_only() {
    let stream = stream();
    let frames = numbered(&stream);
    for lost in 0..frames.len() {
        let damaged = frames[lost].0;
        let arrived: Vec<CanFrame> = (0..frames.len())
            .filter(|&i| i != lost)
            .map(|i| frames[i].1)
            .collect();
        let (received, faults) = join(&arrived);
        assert_eq!(received, link_frames_but(&stream, &[damaged]), "{lost}");
        // The very last one and the very first, single one have nothing after or before them that tells.
        let noticed = lost != 0 && lost != frames.len() - 1;
        let expected = if noticed {
            vec![CanError::Lost]
        } else {
            vec![]
        };
        assert_eq!(faults, expected, "{lost}");
    }
}

#[test]
fn a_run_of_lost_can_frames_costs_the_link_frames_that_it_touches() {
    let stream = stream();
    let frames = numbered(&stream);
    for from in 0..frames.len() {
        for to in from + 1..=frames.len() {
            let damaged: Vec<usize> = frames[from..to].iter().map(|frame| frame.0).collect();
            let arrived: Vec<CanFrame> = frames[..from]
                .iter()
                .chain(&frames[to..])
                .map(|f| f.1)
                .collect();
            assert_eq!(join(&arrived).0, link_frames_but(&stream, &damaged));
        }
    }
}

#[test]
fn a_doubled_can_frame_is_dropped() {
    let stream = stream();
    let frames = numbered(&stream);
    // Not the first one of its sender: that is a restart, and comes again.
    for doubled in 1..frames.len() {
        let mut arrived: Vec<CanFrame> = frames.iter().map(|frame| frame.1).collect();
        arrived.insert(doubled, arrived[doubled]);
        let expected = (link_frames_but(&stream, &[]), vec![CanError::Doubled]);
        assert_eq!(join(&arrived), expected, "{doubled}");
    }
}

#[test]
fn exchanged_can_frames_are_never_joined() {
    let stream = stream();
    let frames = numbered(&stream);
    let sent = link_frames_but(&stream, &[]);
    for first in 0..frames.len() - 1 {
        let mut arrived: Vec<CanFrame> = frames.iter().map(|frame| frame.1).collect();
        arrived.swap(first, first + 1);
        let (received, _) = join(&arrived);
        assert!(received.iter().all(|one| sent.contains(one)), "{first}");
    }
}

#[test]
fn the_first_frame_of_a_sender_that_starts_anew_is_no_double() {
    let mut assembler = Assembler::<MAX_FRAME>::leg_receiver(LEG);
    for mark in 1..4 {
        let sent = link_frame(30, mark);
        let frames = cut(&mut Segmenter::new(Identifier::ToLeg(LEG)), &sent);
        assert_eq!(push_all(&mut assembler, &frames), (vec![sent], vec![]));
    }
}

#[test]
fn a_receiver_that_comes_late_begins_with_the_next_link_frame() {
    let stream = stream();
    let frames: Vec<CanFrame> = numbered(&stream).iter().map(|frame| frame.1).collect();
    // From the third segment of the third link frame on.
    let (received, faults) = join(&frames[5..]);
    assert_eq!(received, link_frames_but(&stream, &[0, 1, 2]));
    assert_eq!(faults, [CanError::Lost]);
}

#[test]
fn a_link_frame_given_up_half_sent_costs_itself_only() {
    let mut segmenter = Segmenter::new(Identifier::ToLeg(LEG));
    let long = link_frame(300, 1);
    let next = link_frame(100, 2);
    let mut frames = match segmenter.segments(&long) {
        Ok(segments) => segments.take(3).collect::<Vec<_>>(),
        Err(error) => panic!("{error}"),
    };
    frames.extend(cut(&mut segmenter, &next));
    assert_eq!(
        join(&frames),
        (vec![next.clone()], vec![CanError::Unfinished])
    );
    // Of which the controller sent less than it was given.
    frames.remove(2);
    assert_eq!(join(&frames), (vec![next], vec![CanError::Lost]));
}

#[test]
fn an_urgent_frame_comes_out_between_two_segments() {
    let long = link_frame(100, 1);
    let stop = link_frame(9, 2);
    let ordinary = cut(&mut Segmenter::new(Identifier::ToLeg(LEG)), &long);
    for urgent in [Identifier::Urgent(LEG), Identifier::UrgentToAll] {
        let urgent = cut(&mut Segmenter::new(urgent), &stop);
        let frames = [ordinary[0], urgent[0], urgent[0], ordinary[1]];
        let expected = vec![stop.clone(), stop.clone(), long.clone()];
        assert_eq!(join(&frames), (expected, vec![]));
    }
}

#[test]
fn a_link_frame_that_is_too_long_for_the_receiver_costs_itself_only() {
    let mut segmenter = Segmenter::new(Identifier::ToLeg(LEG));
    let (fits, too_long) = (link_frame(100, 1), link_frame(101, 2));
    let mut frames = cut(&mut segmenter, &too_long);
    frames.extend(cut(&mut segmenter, &fits));
    let came = push_all(&mut Assembler::<100>::leg_receiver(LEG), &frames);
    assert_eq!(came, (vec![fits], vec![CanError::TooLong]));
}

#[test]
fn a_damaged_payload_inside_a_link_frame_costs_it() {
    let mut segmenter = Segmenter::new(Identifier::ToLeg(LEG));
    let (long, next) = (link_frame(150, 1), link_frame(20, 2));
    let mut frames = cut(&mut segmenter, &long);
    let Ok(damaged) = CanFrame::new(Identifier::ToLeg(LEG), &[5, 1, 9]) else {
        panic!("3 bytes are a size that CAN FD has")
    };
    frames[1] = damaged;
    frames.extend(cut(&mut segmenter, &next));
    let (received, faults) = join(&frames);
    assert_eq!(received, [next]);
    assert_eq!(faults, [CanError::WrongLength, CanError::Lost]);
}

#[test]
fn what_256_lost_frames_let_through_the_crc_refuses() {
    // Four segments each; between the second of the one and the third of the other, 256 are lost.
    let of = |sequence, byte: u8| {
        let mut out = [0; MAX_FRAME];
        match encode(sequence, &[byte; 200].as_slice(), &mut out) {
            Ok(link_frame) => cut(&mut Segmenter::new(Identifier::ToLeg(LEG)), link_frame),
            Err(error) => panic!("{error}"),
        }
    };
    let (received, faults) = join(&[&of(1, 7)[..2], &of(2, 8)[2..]].concat());
    assert_eq!(faults, []);
    let mut decoder = Decoder::new();
    let found: Vec<_> = received
        .concat()
        .into_iter()
        .filter_map(|byte| decoder.push(byte).map(|found| found.map(drop)))
        .collect();
    assert_eq!(found, [Err(FrameError::BadCrc)]);
}

/// A frame of any bytes; most with a header that could be one.
fn any_frame((bits, payload, sensible): (u16, Vec<u8>, bool)) -> Option<CanFrame> {
    let mut payload = payload;
    let identifier = Identifier::from_bits(bits % 0x300)?;
    if sensible {
        let length = payload.len().checked_sub(2)?;
        let head = payload.first_mut()?;
        *head = *head & 0xc0 | length as u8;
    }
    CanFrame::new(identifier, &payload).ok()
}

proptest! {
    #[test]
    fn after_any_can_frames_the_next_link_frame_comes(
        before in vec((any::<u16>(), vec(any::<u8>(), 0..=PAYLOAD_MAX), any::<bool>()), 0..60),
        own in any::<bool>(),
    ) {
        let mut assembler = Assembler::<200>::leg_receiver(LEG);
        for (bits, payload, sensible) in before {
            let bits = if own { Identifier::ToLeg(LEG).bits() } else { bits };
            let Some(frame) = any_frame((bits, payload, sensible)) else { continue };
            let taken = assembler.push(&frame);
            assert!(taken.link_frame.is_none_or(|one| one.len() <= 200 && one.last() == Some(&0)));
        }
        let sent = link_frame(150, 1);
        let frames = cut(&mut Segmenter::new(Identifier::ToLeg(LEG)), &sent);
        assert_eq!(push_all(&mut assembler, &frames).0, vec![sent]);
    }
}
