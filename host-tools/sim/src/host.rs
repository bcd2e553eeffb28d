//! The user's host beside an emulated leg: commands, keep-alives and random bytes.

use crate::emulated_leg::HostBytes;
use crate::link::next_sequence;
use leg_firmware::command::Command;
use leg_firmware::frame::{self, Decoder, FrameError, MAX_FRAME};
use leg_firmware::host_link::{HOST_SCHEMA, Hello, HostId, HostRefusal, HostReply, HostRequest};
use std::collections::VecDeque;

/// Ticks between two keep-alives of the host.
const ALIVE_TICKS: u64 = 400;

/// The only host.
const HOST: HostId = 1;

/// The host and its bytes on the way to the leg.
#[derive(Clone, Debug)]
pub struct Host {
    /// Whether it sends no keep-alives.
    pub silent: bool,
    queue: VecDeque<u8>,
    sequence: u16,
    rng: fastrand::Rng,
    decoder: Decoder,
    answers: Vec<Answer>,
    /// The other replies of the last tick.
    replies: Vec<(u16, HostReply)>,
}

/// What became of a request.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Answer {
    /// The request's number; 0 is of one that could not be read.
    pub number: u16,
    /// Why it is not done.
    pub result: Result<(), HostRefusal>,
}

impl Host {
    /// A host whose random bytes follow from a seed.
    #[must_use]
    pub fn new(seed: u64) -> Self {
        Self {
            silent: false,
            queue: VecDeque::new(),
            sequence: 0,
            rng: fastrand::Rng::with_seed(seed),
            decoder: Decoder::new(),
            answers: Vec::new(),
            replies: Vec::new(),
        }
    }

    /// Sends a command, and gives the number of its [`Answer`].
    ///
    /// # Errors
    /// A command that fits into no frame.
    pub fn send(&mut self, command: &Command) -> Result<u16, FrameError> {
        self.ask(&HostRequest::Command {
            host: HOST,
            command: *command,
        })
    }

    /// Asks for something, and gives the number of its reply.
    ///
    /// # Errors
    /// A request that fits into no frame.
    pub fn ask(&mut self, request: &HostRequest) -> Result<u16, FrameError> {
        if self.sequence == 0 {
            let schema = HOST_SCHEMA;
            self.queue_up(&HostRequest::Identify(Hello { schema }))?;
        }
        self.queue_up(request)
    }

    fn queue_up(&mut self, request: &HostRequest) -> Result<u16, FrameError> {
        self.sequence = next_sequence(self.sequence);
        let mut out = [0; MAX_FRAME];
        let bytes = frame::encode(self.sequence, request, &mut out)?;
        self.queue.extend(bytes);
        Ok(self.sequence)
    }

    /// Takes what the leg sent in a tick.
    pub fn receive(&mut self, bytes: &[u8]) {
        self.answers.clear();
        self.replies.clear();
        for byte in bytes {
            // A frame that cannot be read answers nothing.
            let Some(Ok(frame)) = self.decoder.push(*byte) else {
                continue;
            };
            let result = match frame.message() {
                Some(HostReply::Done) => Ok(()),
                Some(HostReply::Refused(refusal)) => Err(refusal),
                Some(reply) => {
                    self.replies.push((frame.sequence, reply));
                    continue;
                }
                None => continue,
            };
            self.answers.push(Answer {
                number: frame.sequence,
                result,
            });
        }
    }

    /// What the leg answered in the last tick.
    #[must_use]
    pub fn answers(&self) -> &[Answer] {
        &self.answers
    }

    /// What the leg replied in the last tick to what it was asked besides, with the requests' numbers.
    #[must_use]
    pub fn replies(&self) -> &[(u16, HostReply)] {
        &self.replies
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
