//! An emulated leg at the other end of a bus on which every frame arrives.

use super::CanPort;
use crate::transport::Transport;
use crate::transport::emulated::EmulatedTransport;
use leg_firmware::can::{Assembler, CanFrame, Identifier, LegAddress, Segmenter};
use std::collections::VecDeque;
use std::io;
use std::time::Duration;

/// Bytes that are read at a time.
const READ_BYTES: usize = 256;

/// A host's node on that bus. What it sends reaches the leg in frames, as what comes back: both are taken apart and put together
/// as by a board.
pub struct EmulatedCan {
    line: EmulatedTransport,
    to_leg: Assembler,
    from_leg: Segmenter,
    /// What the leg has sent of a link's frame that is not whole.
    begun: Vec<u8>,
    frames: VecDeque<CanFrame>,
}

impl EmulatedCan {
    /// Of a host of an emulated leg, which has that address.
    pub fn new(line: EmulatedTransport, leg: LegAddress) -> Self {
        Self {
            line,
            to_leg: Assembler::leg_receiver(leg),
            from_leg: Segmenter::new(Identifier::ToHost(leg)),
            begun: Vec::new(),
            frames: VecDeque::new(),
        }
    }

    fn take(&mut self, bytes: &[u8]) -> io::Result<()> {
        for piece in bytes.split_inclusive(|&byte| byte == 0) {
            self.begun.extend(piece);
            if piece.ends_with(&[0]) {
                let frames = self.from_leg.segments(&self.begun);
                self.frames.extend(frames.map_err(super::not_one_frame)?);
                self.begun.clear();
            }
        }
        Ok(())
    }
}

impl CanPort for EmulatedCan {
    fn name(&self) -> &str {
        self.line.name()
    }

    fn send(&mut self, frame: &CanFrame) -> io::Result<()> {
        match self.to_leg.push(frame).link_frame {
            Some(link_frame) => self.line.send(link_frame),
            None => Ok(()),
        }
    }

    fn receive(&mut self, timeout: Duration) -> io::Result<CanFrame> {
        let until = self.now() + timeout;
        loop {
            if let Some(frame) = self.frames.pop_front() {
                return Ok(frame);
            }
            let mut bytes = [0; READ_BYTES];
            let left = until.saturating_sub(self.now());
            let count = self.line.receive(&mut bytes, left)?;
            self.take(bytes.get(..count).unwrap_or_default())?;
        }
    }

    fn now(&self) -> Duration {
        self.line.now()
    }

    fn clock_is_emulated(&self) -> bool {
        true
    }
}
