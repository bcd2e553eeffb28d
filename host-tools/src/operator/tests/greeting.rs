//! Boards that do not answer as they should.

use crate::operator::{Host, Interrupt, Operator};
use crate::transport::Transport;
use leg_firmware::frame::{self, MAX_FRAME};
use leg_firmware::host_link::{HostRefusal, HostReply};
use std::collections::VecDeque;
use std::io;
use std::time::Duration;

/// A board that always answers the same.
struct Always {
    reply: HostReply,
    answers: VecDeque<u8>,
    now: Duration,
}

impl Always {
    fn new(reply: HostReply) -> Self {
        Self {
            reply,
            answers: VecDeque::new(),
            now: Duration::ZERO,
        }
    }
}

impl Transport for Always {
    fn name(&self) -> &'static str {
        "a strange board"
    }

    fn send(&mut self, bytes: &[u8]) -> io::Result<()> {
        let mut decoder = frame::Decoder::new();
        for &byte in bytes {
            if let Some(Ok(frame)) = decoder.push(byte) {
                let mut out = [0; MAX_FRAME];
                let reply = frame::encode(frame.sequence, &self.reply, &mut out).unwrap();
                self.answers.extend(reply);
            }
        }
        Ok(())
    }

    fn receive(&mut self, bytes: &mut [u8], timeout: Duration) -> io::Result<usize> {
        let Some(byte) = self.answers.pop_front() else {
            self.now += timeout;
            return Err(io::ErrorKind::TimedOut.into());
        };
        *bytes.first_mut().unwrap() = byte;
        Ok(1)
    }

    fn now(&self) -> Duration {
        self.now
    }
}

fn greeting(reply: HostReply) -> String {
    let board = Box::new(Always::new(reply));
    match Operator::open(board, Host::FIXED, Interrupt::default()) {
        Ok(_) => String::new(),
        Err(error) => error.to_string(),
    }
}

#[test]
fn other_firmware_and_silence_are_told_apart() {
    let schema = HostRefusal::SchemaMismatch { schema: [0xab; 8] };
    let other = greeting(HostReply::Refused(schema));
    assert!(
        other.starts_with(
            "the firmware at a strange board speaks another protocol (schema abababababababab, this program "
        ),
        "{other}"
    );
    let silent = greeting(HostReply::Done);
    assert_eq!(silent, "a strange board does not answer");
}
