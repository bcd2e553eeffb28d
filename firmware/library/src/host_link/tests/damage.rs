//! Frames that are damaged, cut or no requests.

use super::{Line, framed, identify, identity, refused};
use crate::frame::{FrameError, MAX_FRAME, encode};
use crate::host_link::{HostRefusal, HostReply, HostRequest};

fn bad(error: FrameError) -> (u16, HostReply) {
    (0, refused(HostRefusal::BadFrame(error)))
}

#[test]
fn a_whole_frame_that_is_no_request_is_refused_under_its_number() {
    let mut out = [0; MAX_FRAME];
    let mut with_a_rest = [0; MAX_FRAME];
    let frames = [
        encode(5, &u64::MAX, &mut out).unwrap(),
        encode(5, &(HostRequest::Telemetry, 0_u8), &mut with_a_rest).unwrap(),
    ];
    for frame in frames {
        let mut line = Line::identified();
        line.hears(frame);
        assert_eq!(line.heard(), [(5, refused(HostRefusal::BadRequest))]);
        assert_eq!(line.leg.note_decode_error, 1);
    }
}

#[test]
fn a_damaged_frame_is_refused_under_zero_and_counted() {
    let mut line = Line::identified();
    for counted in 1..=3 {
        let mut frame = framed(7, &HostRequest::Telemetry);
        frame[1] ^= 1;
        line.hears(&frame);
        assert_eq!(line.heard(), [bad(FrameError::BadCrc)]);
        assert_eq!(line.leg.note_decode_error, counted);
    }
}

/// A damaged frame says nothing of who sent it, so it is answered to any host, too.
#[test]
fn a_damaged_frame_before_the_greeting_is_counted_too() {
    let mut line = Line::new();
    line.hears(&[4, 1, 2, 3, 0]);
    assert_eq!(line.heard(), [bad(FrameError::TooShort)]);
    assert_eq!(line.leg.note_decode_error, 1);
}

#[test]
fn a_good_frame_is_not_misheard() {
    let mut line = Line::identified();
    line.ask(&HostRequest::Telemetry);
    assert_eq!(line.leg.note_decode_error, 0);
}

/// A host that starts while half a frame of another is in: with a zero in front it loses nothing, without one a frame.
#[test]
fn a_greeting_after_half_a_frame_is_read_within_one_frame() {
    let half = framed(7, &HostRequest::SetSettings(super::others()));
    for length in 1..half.len() - 1 {
        let greeting = framed(9, &identify());
        let greeted = (9, HostReply::Identified(identity()));

        let mut line = Line::new();
        line.hears(&half[..length]);
        line.hears(&[0]);
        line.hears(&greeting);
        let heard = line.heard();
        assert_eq!(heard.last(), Some(&greeted), "{length} bytes");
        assert!(heard.len() <= 2, "{length} bytes: {heard:?}");

        let mut line = Line::new();
        line.hears(&half[..length]);
        line.hears(&greeting);
        line.hears(&greeting);
        let heard = line.heard();
        assert_eq!(heard.last(), Some(&greeted), "{length} bytes");
    }
}

#[test]
fn a_frame_that_comes_byte_by_byte_is_read() {
    let mut line = Line::new();
    for byte in framed(9, &identify()) {
        assert_eq!(line.heard(), []);
        line.hears(&[byte]);
    }
    assert_eq!(line.heard(), [(9, HostReply::Identified(identity()))]);
}

#[test]
fn several_frames_at_once_are_answered_each_in_turn() {
    let mut line = Line::new();
    let mut bytes = framed(9, &HostRequest::Telemetry);
    bytes.extend(framed(10, &identify()));
    bytes.extend(framed(11, &HostRequest::Stream(0)));
    line.hears(&bytes);
    assert_eq!(
        line.heard(),
        [
            (9, refused(HostRefusal::NotIdentified)),
            (10, HostReply::Identified(identity())),
            (11, HostReply::Done),
        ]
    );
}
