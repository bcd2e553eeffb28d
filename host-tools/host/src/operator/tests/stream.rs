//! Telemetry that comes by itself.

use super::scripted::scripted;
use super::{emulated, host};
use crate::operator::{Host, Interrupt, Operator, OperatorError};
use crate::transport::Transport;
use crate::transport::emulated::EmulatedEnd;
use leg_firmware::host_link::HostReply;
use leg_sim::emulated_leg::Beginning;
use std::io;
use std::time::Duration;

/// Longer than any wait of the operator's own.
const LONG: Duration = Duration::from_secs(20);

#[test]
fn telemetry_goes_on_at_once_beside_another_hosts_introduction() {
    let leg = emulated(Beginning::Hanging);
    let mut listening = host(&leg, 1);
    listening.stream(80).unwrap();
    let first = listening.streamed(LONG).unwrap().unwrap();
    let other = host(&leg, 2);
    let mut last = first.telemetry.tick;
    for _ in 0..10 {
        let next = listening.streamed(LONG).unwrap().unwrap().telemetry.tick;
        assert!(next - last < 240, "{last} to {next}");
        last = next;
    }
    drop(other);
}

/// A line on which the user wants an end at a time.
struct Ended {
    inner: EmulatedEnd,
    interrupt: Interrupt,
    at: Duration,
}

impl Transport for Ended {
    fn name(&self) -> &str {
        self.inner.name()
    }

    fn send(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.inner.send(bytes)
    }

    fn receive(&mut self, bytes: &mut [u8], timeout: Duration) -> io::Result<usize> {
        let received = self.inner.receive(bytes, timeout);
        if self.now() >= self.at {
            self.interrupt.raise();
        }
        received
    }

    fn now(&self) -> Duration {
        self.inner.now()
    }
}

#[test]
fn ctrl_c_ends_the_wait_for_telemetry_and_telemetry_itself() {
    let leg = emulated(Beginning::Hanging);
    let interrupt = Interrupt::default();
    let at = Duration::from_secs(1);
    let line = Ended {
        inner: leg.beside(),
        interrupt: interrupt.clone(),
        at,
    };
    let mut operator = Operator::open(Box::new(line), Host::FIXED, interrupt).unwrap();
    operator.stream(u16::MAX).unwrap();
    let ended = operator
        .streamed(LONG)
        .and_then(|_| operator.streamed(LONG));
    assert!(matches!(ended, Err(OperatorError::Interrupted)));
    assert!(operator.now() < at + Duration::from_millis(100));
    // Ctrl-C does not keep it from letting the line go.
    operator.end_stream().unwrap();
}

#[test]
fn silence_ends_the_wait_for_telemetry_in_time() {
    let mut operator = scripted(|_| Some(HostReply::Done));
    operator.stream(1000).unwrap();
    let before = operator.now();
    assert_eq!(operator.streamed(LONG).unwrap(), None);
    assert_eq!(operator.now() - before, LONG);
}
