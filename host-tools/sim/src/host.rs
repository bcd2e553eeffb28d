//! The user's host beside an emulated leg: commands, signs of life and garbage, as bytes.

use crate::emulated_leg::HostBytes;
use crate::link::next_sequence;
use leg_firmware::command::Command;
use leg_firmware::frame::{self, FrameError, MAX_FRAME};
use leg_firmware::host_link::{HOST_SCHEMA, Hello, HostId, HostRequest};
use std::collections::VecDeque;

/// Ticks between two signs of life of the host.
const ALIVE_TICKS: u64 = 400;

/// The only host.
const HOST: HostId = 1;

/// The host and its bytes on the way to the leg.
#[derive(Clone, Debug)]
pub struct Host {
    /// Whether it sends no signs of life.
    pub silent: bool,
    queue: VecDeque<u8>,
    sequence: u16,
    rng: fastrand::Rng,
}

impl Host {
    /// A host whose garbage follows from a seed.
    #[must_use]
    pub fn new(seed: u64) -> Self {
        Self {
            silent: false,
            queue: VecDeque::new(),
            sequence: 0,
            rng: fastrand::Rng::with_seed(seed),
        }
    }

    /// Sends a command.
    ///
    /// # Errors
    /// A command that fits into no frame.
    pub fn send(&mut self, command: &Command) -> Result<(), FrameError> {
        if self.sequence == 0 {
            let schema = HOST_SCHEMA;
            self.ask(&HostRequest::Identify(Hello { schema }))?;
        }
        self.ask(&HostRequest::Command {
            host: HOST,
            command: *command,
        })
    }

    fn ask(&mut self, request: &HostRequest) -> Result<(), FrameError> {
        self.sequence = next_sequence(self.sequence);
        let mut out = [0; MAX_FRAME];
        let bytes = frame::encode(self.sequence, request, &mut out)?;
        self.queue.extend(bytes);
        Ok(())
    }

    /// Sends bytes that mean nothing.
    pub fn send_garbage(&mut self, count: u32) {
        for _ in 0..count {
            self.queue.push_back(self.rng.u8(..));
        }
        // Ends whatever frame they may look like.
        self.queue.push_back(0);
    }

    /// The bytes of a tick, counted from the start.
    pub fn outgoing(&mut self, tick: u64) -> HostBytes {
        if !self.silent && tick.is_multiple_of(ALIVE_TICKS) && self.queue.is_empty() {
            // It is short enough for any frame.
            let _ = self.send(&Command::KeepAlive);
        }
        let count = self.queue.len().min(HostBytes::new().capacity());
        self.queue.drain(..count).collect()
    }
}
