//! A line that loses a frame.

use super::{emulated, host, state};
use crate::operator::{Host, Interrupt, Operator, OperatorError};
use crate::transport::Transport;
use crate::transport::emulated::EmulatedEnd;
use leg_firmware::command::Command;
use leg_firmware::supervisor::State;
use leg_sim::emulated_leg::Beginning;
use std::io;
use std::time::Duration;

/// How a frame is lost.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Loss {
    Silent,
    /// The leg says that it could not read a frame.
    InPieces,
    /// The leg obeys, and its answer is lost.
    Answer,
    /// Another host stops the leg meanwhile.
    Stopped,
}

/// A line that loses the fourth frame of the host.
struct Spoilt {
    inner: EmulatedEnd,
    other: Operator,
    sent: u32,
    loss: Loss,
    /// Until then the answers are lost.
    deaf_until: Duration,
}

impl Transport for Spoilt {
    fn name(&self) -> &str {
        self.inner.name()
    }

    fn send(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.sent += 1;
        if self.sent != 4 {
            return self.inner.send(bytes);
        }
        match self.loss {
            Loss::Silent => Ok(()),
            Loss::InPieces => self.inner.send(bytes.get(3..).unwrap()),
            Loss::Answer => {
                self.deaf_until = self.inner.now() + Duration::from_millis(100);
                self.inner.send(bytes)
            }
            Loss::Stopped => {
                self.other.stop().unwrap();
                Ok(())
            }
        }
    }

    fn receive(&mut self, bytes: &mut [u8], timeout: Duration) -> io::Result<usize> {
        while self.inner.now() < self.deaf_until {
            let _ = self.inner.receive(bytes, Duration::from_millis(1));
        }
        self.inner.receive(bytes, timeout)
    }

    fn now(&self) -> Duration {
        self.inner.now()
    }
}

/// What comes of a move whose frame is lost: it is the fourth, after the introduction, the settings and
/// the arming.
fn lost_move(loss: Loss) -> (Result<(), OperatorError>, bool) {
    let leg = emulated(Beginning::Hanging);
    let line = Spoilt {
        inner: leg.beside(),
        other: host(&leg, 2),
        sent: 0,
        loss,
        deaf_until: Duration::ZERO,
    };
    let mut operator = Operator::open(Box::new(line), Host::FIXED, Interrupt::default()).unwrap();
    let mut moving = false;
    let result = operator.drive(|operator| {
        operator.command(Command::Arm)?;
        operator.command(Command::Move { x: 0.1, y: 0.0 })?;
        moving = operator.telemetry()?.telemetry.moving;
        Ok(())
    });
    assert_eq!(state(&mut operator), State::Held);
    (result, moving)
}

#[test]
fn a_lost_move_is_sent_again_after_a_look_at_the_leg() {
    for loss in [Loss::Silent, Loss::InPieces, Loss::Answer] {
        let (result, moving) = lost_move(loss);
        result.unwrap();
        assert!(moving, "{loss:?}");
    }
}

#[test]
fn a_lost_move_is_not_sent_again_to_a_leg_that_was_stopped() {
    let (result, moving) = lost_move(Loss::Stopped);
    assert!(matches!(result, Err(OperatorError::Unanswered { .. })));
    assert!(!moving);
}
