//! Lines that lose frames, and lines on which nothing gets through any more.

use super::{
    BadLine, begin_move, cancel_in_mid_move, hanging_leg, host, is_failed, lean, operator, state,
    stiffness, telemetry,
};
use crate::cancel_flag::CancelFlag;
use crate::operator::{Operator, OperatorError};
use crate::transport::Transport;
use crate::transport::emulated::{EmulatedLine, EmulatedTransport};
use leg_firmware::command::Command;
use leg_firmware::supervisor::State;
use std::cell::Cell;
use std::io;
use std::rc::Rc;
use std::time::Duration;

/// What becomes of the frames of a host.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum LineState {
    #[default]
    Whole,
    /// Nothing gets through any more.
    Silent,
    /// The system reports an error.
    Broken,
}

fn breakable(leg: &EmulatedLine, cancel: &CancelFlag) -> (Operator, Rc<Cell<LineState>>) {
    let state = Rc::<Cell<LineState>>::default();
    let now = Rc::clone(&state);
    let send = move |inner: &mut EmulatedTransport, bytes: &[u8]| match now.get() {
        LineState::Whole => inner.send(bytes),
        LineState::Silent => Ok(()),
        LineState::Broken => Err(io::ErrorKind::BrokenPipe.into()),
    };
    (operator(BadLine::new(leg, send, |_| ()), cancel), state)
}

#[test]
fn a_stop_that_nobody_acknowledged_is_reported_whatever_went_before() {
    // Ctrl-C in mid-move, on a line to which this happens in the same moment.
    let interrupted = |becomes| {
        let (leg, cancel) = (hanging_leg(), CancelFlag::default());
        let (mut operator, line) = breakable(&leg, &cancel);
        cancel_in_mid_move(&mut operator, cancel, move || line.set(becomes));
        operator.reach(&lean(25.0))
    };
    let error = error_of!(interrupted(LineState::Silent), OperatorError::NotStopped(_));
    assert!(
        error
            .failure()
            .render(false)
            .contains("press the emergency stop")
    );
    assert!(is_failed(&error));
    error_of!(
        interrupted(LineState::Broken),
        OperatorError::ConnectionLost(..)
    );
    error_of!(interrupted(LineState::Whole), OperatorError::Cancelled);
}

/// As a bus on which nobody acknowledges, while its board starts.
#[test]
fn a_stop_goes_out_as_soon_as_the_line_takes_frames_again() {
    let (leg, full) = (hanging_leg(), Rc::new(Cell::new(0)));
    let left = Rc::clone(&full);
    let send = move |inner: &mut EmulatedTransport, bytes: &[u8]| match left.get() {
        0 => inner.send(bytes),
        count => {
            left.set(count - 1);
            Err(io::ErrorKind::TimedOut.into())
        }
    };
    let mut operator = operator(BadLine::new(&leg, send, |_| ()), &CancelFlag::default());
    begin_move(&mut operator);
    full.set(20);
    operator.stop().unwrap();
    assert_eq!(telemetry(&mut operator).state, State::Held);
    // For longer than a stop is repeated.
    full.set(u32::MAX);
    error_of!(operator.stop(), OperatorError::NotStopped(_));
}

#[test]
fn a_limit_is_not_said_to_be_held_where_no_stop_was_acknowledged() {
    let leg = hanging_leg();
    let (mut operator, line) = breakable(&leg, &CancelFlag::default());
    let result = operator.drive(|operator| {
        let limited = operator.reach(&stiffness(1e4)).unwrap_err();
        line.set(LineState::Silent);
        operator.command(Command::Clear).ok();
        Err::<(), _>(limited)
    });
    error_of!(result, OperatorError::NotStopped(_));
}

/// How a frame is lost.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Loss {
    Silent,
    /// The leg reports that it could not read a frame.
    InPieces,
    /// The leg obeys, and its answer is lost.
    Answer,
    /// Another host stops the leg meanwhile.
    Stopped,
}

/// What comes of a move whose frame is lost: it is the fourth, after the introduction, the settings and the arming.
fn lost_move(loss: Loss) -> (Result<(), OperatorError>, bool) {
    let leg = hanging_leg();
    let mut other = host(&leg, 2);
    let mut sent = 0;
    let deaf_until = Rc::new(Cell::new(Duration::ZERO));
    let deaf = Rc::clone(&deaf_until);
    let send = move |inner: &mut EmulatedTransport, bytes: &[u8]| {
        sent += 1;
        match loss {
            _ if sent != 4 => inner.send(bytes),
            Loss::Silent => Ok(()),
            Loss::InPieces => inner.send(&bytes[3..]),
            Loss::Stopped => other.stop().map(drop).map_err(io::Error::other),
            Loss::Answer => {
                deaf_until.set(inner.now() + Duration::from_millis(100));
                inner.send(bytes)
            }
        }
    };
    let receive = move |inner: &mut EmulatedTransport| {
        while inner.now() < deaf.get() {
            let _ = inner.receive(&mut [0; 99], Duration::from_millis(1));
        }
    };
    let line = BadLine::new(&leg, send, receive);
    let mut operator = operator(line, &CancelFlag::default());
    let mut moving = false;
    let result = operator.drive(|operator| {
        operator.command(Command::Arm)?;
        operator.command(Command::Move { x: 0.1, y: 0.0 })?;
        moving = telemetry(operator).moving;
        Ok(())
    });
    assert_eq!(state(&mut operator), State::Held);
    (result, moving)
}

#[test]
fn a_lost_move_is_sent_again_but_not_to_a_leg_that_was_stopped() {
    for loss in [Loss::Silent, Loss::InPieces, Loss::Answer] {
        let (result, moving) = lost_move(loss);
        result.unwrap();
        assert!(moving, "{loss:?}");
    }
    let (result, moving) = lost_move(Loss::Stopped);
    error_of!(result, OperatorError::Unacknowledged(_));
    assert!(!moving);
}

#[test]
fn a_stop_does_not_wait_for_ordinary_frames() {
    let leg = hanging_leg();
    let mut driving = host(&leg, 1);
    begin_move(&mut driving);
    // From the second frame of the host on, its ordinary ones do not arrive.
    let mut sent = 0;
    let send = move |inner: &mut EmulatedTransport, bytes: &[u8]| {
        sent += 1;
        if sent > 1 { Ok(()) } else { inner.send(bytes) }
    };
    let line = BadLine {
        urgent_passes: true,
        ..BadLine::new(&leg, send, |_| ())
    };
    // The stop arrives; what the leg does afterwards is asked by an ordinary frame.
    let stopped = operator(line, &CancelFlag::default()).stop();
    error_of!(stopped, OperatorError::NoAnswer(_));
    assert_eq!(state(&mut driving), State::Held);
}

#[test]
fn ctrl_c_ends_the_wait_for_telemetry_and_telemetry_itself() {
    let (leg, cancel) = (hanging_leg(), CancelFlag::default());
    let end = Duration::from_secs(1);
    let flag = cancel.clone();
    let send = |inner: &mut EmulatedTransport, bytes: &[u8]| inner.send(bytes);
    let cancel_at_end = move |inner: &mut EmulatedTransport| {
        if inner.now() >= end {
            flag.set();
        }
    };
    let mut operator = operator(BadLine::new(&leg, send, cancel_at_end), &cancel);
    operator.start_stream(u16::MAX).unwrap();
    let long = Duration::from_secs(20);
    let ended = operator
        .next_streamed(long)
        .and_then(|_| operator.next_streamed(long));
    error_of!(ended, OperatorError::Cancelled);
    assert!(operator.now() < end + Duration::from_millis(100));
    // Ctrl-C does not keep it from ending the stream.
    operator.end_stream().unwrap();
}
