//! Requests and replies as frames on a transport.

use super::OperatorError;
use crate::transport::Transport;
use leg_firmware::frame::{self, Decoder, MAX_FRAME};
use leg_firmware::host_link::{HostRefusal, HostReply, HostRequest};
use leg_sim::link::next_sequence;
use std::collections::VecDeque;
use std::io;
use std::time::Duration;

/// A transport with its frames, and the numbers of the requests.
pub(super) struct FramedTransport {
    pub transport: Box<dyn Transport>,
    decoder: Decoder,
    sequence: u16,
    /// Replies that came and were not read yet, with their numbers.
    replies: VecDeque<(u16, HostReply)>,
    /// Frames that could not be read.
    damaged: u64,
}

impl FramedTransport {
    pub fn new(transport: Box<dyn Transport>, sequence: u16) -> Self {
        Self {
            transport,
            decoder: Decoder::new(),
            sequence,
            replies: VecDeque::new(),
            damaged: 0,
        }
    }

    pub fn damaged_frames(&self) -> u64 {
        self.damaged + self.transport.damaged()
    }

    /// Sends a request and returns its number. It is never 0: that is of what the leg sends by itself.
    pub fn send(&mut self, request: &HostRequest) -> Result<u16, OperatorError> {
        self.send_by(<dyn Transport>::send, request)
    }

    /// The same before all that waits.
    pub fn send_urgent(&mut self, request: &HostRequest) -> Result<u16, OperatorError> {
        self.send_by(<dyn Transport>::send_urgent, request)
    }

    fn send_by(
        &mut self,
        send: fn(&mut (dyn Transport + 'static), &[u8]) -> io::Result<()>,
        request: &HostRequest,
    ) -> Result<u16, OperatorError> {
        self.sequence = next_sequence(self.sequence);
        let mut out = [0; MAX_FRAME];
        let bytes =
            frame::encode(self.sequence, request, &mut out).map_err(OperatorError::Frame)?;
        let sent = send(self.transport.as_mut(), bytes);
        sent.map_err(|source| self.lost(source))?;
        Ok(self.sequence)
    }

    /// The next reply with its number; none if none came in time. Reads once even where there is no time left.
    pub fn receive(&mut self, until: Duration) -> Result<Option<(u16, HostReply)>, OperatorError> {
        loop {
            if let Some(reply) = self.replies.pop_front() {
                return Ok(Some(reply));
            }
            let left = until.saturating_sub(self.transport.now());
            let mut bytes = [0; MAX_FRAME];
            match self.transport.receive(&mut bytes, left) {
                Ok(0) => return Err(self.lost(io::ErrorKind::UnexpectedEof.into())),
                Ok(count) => self.decode(bytes.get(..count).unwrap_or_default()),
                Err(error) if error.kind() == io::ErrorKind::TimedOut => return Ok(None),
                Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
                Err(source) => return Err(self.lost(source)),
            }
        }
    }

    fn decode(&mut self, bytes: &[u8]) {
        for &byte in bytes {
            let Some(frame) = self.decoder.push(byte) else {
                continue;
            };
            let reply = frame
                .ok()
                .and_then(|frame| Some((frame.sequence, frame.message()?)));
            match reply {
                Some(reply) => self.replies.push_back(reply),
                None => self.damaged += 1,
            }
        }
    }

    pub fn name(&self) -> String {
        self.transport.name().into()
    }

    fn lost(&self, source: io::Error) -> OperatorError {
        OperatorError::ConnectionLost(self.name(), source)
    }

    /// The error for a refusal.
    pub fn refused(&self, asked: &'static str, refusal: HostRefusal) -> OperatorError {
        match refusal {
            HostRefusal::SchemaMismatch { schema } => {
                OperatorError::OtherSchema(self.name(), schema)
            }
            refusal => OperatorError::Refused(asked, refusal),
        }
    }
}
