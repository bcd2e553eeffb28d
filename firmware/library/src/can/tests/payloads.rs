use super::{LEG, OTHER, cut, join, link_frame, push_all};
use crate::can::{
    Assembler, CanError, CanFrame, Identifier, LegAddress, PAYLOAD_MAX, SEGMENT_MAX, SegmentError,
    Segmenter,
};
use crate::command::Command;
use crate::frame::{MAX_FRAME, encode};

/// The sizes of ISO 11898-1's table of data length codes.
const SIZES: [usize; 16] = [0, 1, 2, 3, 4, 5, 6, 7, 8, 12, 16, 20, 24, 32, 48, 64];

#[test]
fn the_identifiers_layout_is_fixed() {
    let first = LegAddress::ALL[0];
    for (identifier, bits) in [
        (Identifier::UrgentToAll, 0x000),
        (Identifier::Urgent(first), 0x001),
        (Identifier::ToLeg(first), 0x101),
        (Identifier::ToHost(LegAddress::ALL[5]), 0x206),
    ] {
        assert_eq!(identifier.bits(), bits);
    }
    let known = (0..=u16::MAX).filter_map(|bits| Some((bits, Identifier::from_bits(bits)?)));
    let known: Vec<_> = known.collect();
    assert_eq!(known.len(), 1 + 3 * 6);
    for (bits, identifier) in known {
        assert_eq!(identifier.bits(), bits);
        assert!(bits < 1 << 11);
    }
}

#[test]
fn a_stop_wins_from_commands_and_these_from_what_legs_send() {
    for a in LegAddress::ALL {
        for b in LegAddress::ALL {
            assert!(Identifier::UrgentToAll.bits() < Identifier::Urgent(a).bits());
            assert!(Identifier::Urgent(a).bits() < Identifier::ToLeg(b).bits());
            assert!(Identifier::ToLeg(a).bits() < Identifier::ToHost(b).bits());
        }
    }
}

#[test]
fn the_payloads_layout_is_fixed() {
    let mut segmenter = Segmenter::new(Identifier::ToLeg(LEG));
    let frames = cut(&mut segmenter, &[1, 2, 3, 4, 5, 6, 7, 8, 0]);
    let [frame] = frames.as_slice() else {
        panic!("{} frames", frames.len())
    };
    assert_eq!(frame.payload(), [0xc9, 0, 1, 2, 3, 4, 5, 6, 7, 8, 0, 0xcc]);
    let frames = cut(&mut segmenter, &link_frame(63, 9));
    assert_eq!(frames[0].payload()[..3], [0x80 | 62, 1, 9]);
    assert_eq!(frames[1].payload(), [1, 2, 0]);
}

#[test]
fn every_length_comes_back_in_payloads_that_can_fd_has() {
    let mut segmenter = Segmenter::new(Identifier::ToLeg(LEG));
    let mut assembler = Assembler::<MAX_FRAME>::leg_receiver(LEG);
    for length in 1..=MAX_FRAME {
        let sent = link_frame(length, 7);
        let frames = cut(&mut segmenter, &sent);
        assert_eq!(frames.len(), length.div_ceil(SEGMENT_MAX));
        for frame in &frames {
            let size = frame.payload().len();
            assert!(SIZES.contains(&size), "{size}");
            assert_eq!(
                CanFrame::new(frame.identifier(), frame.payload()),
                Ok(*frame)
            );
        }
        let (received, faults) = push_all(&mut assembler, &frames);
        assert_eq!((received, faults), (vec![sent], vec![]), "{length} bytes");
    }
}

#[test]
fn what_is_for_others_is_not_looked_at() {
    let sent = link_frame(9, 1);
    for identifier in [
        Identifier::ToLeg(OTHER),
        Identifier::Urgent(OTHER),
        Identifier::ToHost(LEG),
    ] {
        let frames = cut(&mut Segmenter::new(identifier), &sent);
        assert_eq!(join(&frames), (vec![], vec![]), "{identifier:?}");
        assert!(!Identifier::received_by(LEG).contains(&identifier));
    }
    let mut host = Assembler::<MAX_FRAME>::host_receiver(LEG);
    for identifier in Identifier::received_by(LEG) {
        let frames = cut(&mut Segmenter::new(identifier), &sent);
        assert_eq!(join(&frames).0.len(), 1, "{identifier:?}");
        assert_eq!(
            push_all(&mut host, &frames),
            (vec![], vec![]),
            "{identifier:?}"
        );
    }
}

#[test]
fn only_a_whole_link_frame_is_sent_and_an_urgent_one_in_one_piece() {
    for wrong in [&[][..], &[1, 2], &[1, 0, 2, 0], &[0, 0]] {
        let mut segmenter = Segmenter::new(Identifier::ToLeg(LEG));
        let refused = segmenter.segments(wrong).map(drop);
        assert_eq!(refused, Err(SegmentError::NotOneFrame), "{wrong:?}");
    }
    let mut urgent = Segmenter::new(Identifier::UrgentToAll);
    assert!(urgent.segments(&link_frame(SEGMENT_MAX, 1)).is_ok());
    assert_eq!(
        urgent.segments(&link_frame(SEGMENT_MAX + 1, 1)).map(drop),
        Err(SegmentError::TooLongForUrgent)
    );
}

#[test]
fn an_urgent_frame_in_pieces_is_refused() {
    let frames = cut(
        &mut Segmenter::new(Identifier::ToLeg(LEG)),
        &link_frame(100, 1),
    );
    for frame in frames {
        let Ok(urgent) = CanFrame::new(Identifier::Urgent(LEG), frame.payload()) else {
            panic!("the size is one that CAN FD has")
        };
        assert_eq!(join(&[urgent]), (vec![], vec![CanError::Unfinished]));
    }
}

#[test]
fn every_stop_is_urgent_enough_to_fit() {
    let mut out = [0; MAX_FRAME];
    let Ok(stop) = encode(u16::MAX, &Command::Stop, &mut out) else {
        panic!("a stop fits")
    };
    assert!(
        Segmenter::new(Identifier::UrgentToAll)
            .segments(stop)
            .is_ok()
    );
}

#[test]
fn a_payload_of_another_size_than_its_header_asks_for_is_refused() {
    let refused = |size: usize, length: u8| {
        let mut payload = vec![1; size];
        if let Some(head) = payload.first_mut() {
            *head = 0x80 | length;
        }
        match CanFrame::new(Identifier::ToLeg(LEG), &payload) {
            Ok(frame) => !join(&[frame]).1.is_empty(),
            Err(fault) => fault == CanError::WrongLength,
        }
    };
    for size in 0..=PAYLOAD_MAX + 1 {
        for length in 0..=63 {
            // The shortest payload that holds the header and the segment.
            let held = usize::from(length) + 2;
            let asked = SIZES.into_iter().find(|&size| size >= held);
            let right = length > 0 && asked == Some(size);
            assert_eq!(
                refused(size, length),
                !right,
                "{size} bytes, length {length}"
            );
        }
    }
}
