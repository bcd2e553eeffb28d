//! A line on which ordinary frames wait for long, and urgent ones do not.

use super::{begin_move, emulated, host, state};
use crate::operator::{Host, Interrupt, Operator, OperatorError};
use crate::transport::Transport;
use crate::transport::emulated::EmulatedEnd;
use leg_firmware::supervisor::State;
use leg_sim::emulated_leg::Beginning;
use std::io;
use std::time::Duration;

/// From the second frame of the host on, its ordinary ones do not arrive.
struct Clogged {
    inner: EmulatedEnd,
    sent: u32,
}

impl Transport for Clogged {
    fn name(&self) -> &str {
        self.inner.name()
    }

    fn send(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.sent += 1;
        if self.sent > 1 {
            return Ok(());
        }
        self.inner.send(bytes)
    }

    fn send_urgent(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.inner.send(bytes)
    }

    fn receive(&mut self, bytes: &mut [u8], timeout: Duration) -> io::Result<usize> {
        self.inner.receive(bytes, timeout)
    }

    fn now(&self) -> Duration {
        self.inner.now()
    }
}

#[test]
fn a_stop_does_not_wait_for_ordinary_frames() {
    let leg = emulated(Beginning::Hanging);
    let mut driving = host(&leg, 1);
    begin_move(&mut driving);
    let line = Box::new(Clogged {
        inner: leg.beside(),
        sent: 0,
    });
    let mut stopping = Operator::open(line, Host::FIXED, Interrupt::default()).unwrap();
    // The stop arrives; what the leg does afterwards is asked by an ordinary frame.
    let result = stopping.stop();
    assert!(matches!(result, Err(OperatorError::Silent { .. })));
    assert_eq!(state(&mut driving), State::Held);
}
