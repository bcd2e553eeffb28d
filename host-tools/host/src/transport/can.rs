//! One leg of a CAN FD bus, through a port that sends and receives CAN frames.

mod emulated;
#[cfg(target_os = "linux")]
mod interface;
#[cfg(target_os = "linux")]
mod sender_lock;
#[cfg(target_os = "linux")]
mod socket;

#[cfg(target_os = "linux")]
pub use socket::SocketCan;

pub use emulated::EmulatedCan;

use super::{Transport, host_time};
use leg_firmware::can::{
    Assembler, CanError, CanFrame, Identifier, LegAddress, SegmentError, Segmenter,
};
use std::collections::VecDeque;
use std::io;
use std::time::Duration;

/// A node on a CAN FD bus.
pub trait CanPort {
    /// What it is, for a message to the user: `can0`.
    fn name(&self) -> &str;

    /// Hands a frame to the controller. Those under one identifier are sent in the order in which they were handed over;
    /// an urgent one does not wait for ordinary ones. [`io::ErrorKind::TimedOut`] if the controller does not take it.
    fn send(&mut self, frame: &CanFrame) -> io::Result<()>;

    /// Waits for the next frame; [`io::ErrorKind::TimedOut`] if none came in time.
    fn receive(&mut self, timeout: Duration) -> io::Result<CanFrame>;

    /// Time since some moment, by the clock of the timeouts: the host's, or that of an emulated bus.
    fn now(&self) -> Duration {
        host_time()
    }

    /// Whether that clock is an emulated leg's own.
    fn clock_is_emulated(&self) -> bool {
        false
    }
}

/// The link to one leg of a CAN FD bus.
///
/// There is one for each leg, and not more: two would count under the same identifier. There may be any number of links
/// that send urgent frames only: no receiver looks at their counters.
#[derive(Debug)]
pub struct CanTransport<P> {
    port: P,
    name: String,
    /// None where all frames are sent as urgent ones.
    ordinary: Option<Segmenter>,
    urgent: Segmenter,
    assembler: Assembler,
    received: VecDeque<u8>,
    damaged: u64,
}

impl<P: CanPort> CanTransport<P> {
    /// The link to a leg by a port.
    pub fn new(port: P, leg: LegAddress) -> Self {
        Self {
            ordinary: Some(Segmenter::new(Identifier::ToLeg(leg))),
            ..Self::urgent_only(port, leg)
        }
    }

    /// The link of a host that stops a leg which others drive: everything goes as urgent frames, and so has to be
    /// short.
    pub fn urgent_only(port: P, leg: LegAddress) -> Self {
        Self {
            name: format!("{}, {leg}", port.name()),
            port,
            ordinary: None,
            urgent: Segmenter::new(Identifier::Urgent(leg)),
            assembler: Assembler::host_receiver(leg),
            received: VecDeque::new(),
            damaged: 0,
        }
    }

    fn receive_frame(&mut self, timeout: Duration) -> io::Result<()> {
        let frame = self.port.receive(timeout)?;
        let taken = self.assembler.push(&frame);
        // A double costs nothing.
        let damaged = taken.fault.is_some_and(|fault| fault != CanError::Doubled);
        self.damaged += u64::from(damaged);
        self.received.extend(taken.link_frame.unwrap_or_default());
        Ok(())
    }
}

impl<P: CanPort> Transport for CanTransport<P> {
    fn name(&self) -> &str {
        &self.name
    }

    fn send(&mut self, bytes: &[u8]) -> io::Result<()> {
        if bytes.last().is_some_and(|&byte| byte != 0) {
            return Err(not_one_frame(SegmentError::NotOneFrame));
        }
        for link_frame in bytes.split_inclusive(|&byte| byte == 0) {
            let segmenter = self.ordinary.as_mut().unwrap_or(&mut self.urgent);
            segment(&mut self.port, segmenter, link_frame)?;
        }
        Ok(())
    }

    /// As any other, and at most [`SEGMENT_MAX`](leg_firmware::can::SEGMENT_MAX) bytes long.
    fn send_urgent(&mut self, link_frame: &[u8]) -> io::Result<()> {
        segment(&mut self.port, &mut self.urgent, link_frame)
    }

    fn damaged(&self) -> u64 {
        self.damaged
    }

    fn receive(&mut self, bytes: &mut [u8], timeout: Duration) -> io::Result<usize> {
        let end = self.port.now() + timeout;
        while self.received.is_empty() && !bytes.is_empty() {
            self.receive_frame(end.saturating_sub(self.port.now()))?;
        }
        io::Read::read(&mut self.received, bytes)
    }

    fn now(&self) -> Duration {
        self.port.now()
    }

    fn clock_is_emulated(&self) -> bool {
        self.port.clock_is_emulated()
    }
}

fn segment(
    port: &mut impl CanPort,
    segmenter: &mut Segmenter,
    link_frame: &[u8],
) -> io::Result<()> {
    for frame in segmenter.segments(link_frame).map_err(not_one_frame)? {
        port.send(&frame)?;
    }
    Ok(())
}

fn not_one_frame(error: SegmentError) -> io::Error {
    io::Error::new(io::ErrorKind::InvalidInput, error)
}
