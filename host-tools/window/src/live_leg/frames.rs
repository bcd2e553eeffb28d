//! Bytes of a leg, and the numbers of what it is asked.

use leg_firmware::command::Command;
use leg_firmware::frame::{self, Decoder, MAX_FRAME};
use leg_firmware::host_link::{HostId, HostReply, HostRequest};

/// What a leg sends by itself, and what the server asks, have these numbers.
const OF_THE_LEG: u16 = 0;
const OF_THE_SERVER: u16 = u16::MAX;

/// Finds messages in what comes.
#[derive(Default)]
pub struct Frames {
    decoder: Decoder,
    /// Whether the end of a frame has come: the first bytes may be the rest of one.
    begun: bool,
    damaged: u64,
}

impl Frames {
    /// The messages that end in these bytes, with their numbers. What is meant for other pages is among them.
    pub fn take(&mut self, bytes: &[u8]) -> Vec<(u16, HostReply)> {
        let mut found = Vec::new();
        for &byte in bytes {
            let message = match self.decoder.push(byte) {
                None => continue,
                Some(Ok(frame)) => frame.message().map(|message| (frame.sequence, message)),
                Some(Err(_)) => None,
            };
            // A page that comes in the middle of a frame has not seen damage.
            if message.is_none() && self.begun {
                self.damaged += 1;
            }
            self.begun = true;
            found.extend(message);
        }
        found
    }

    /// How many could not be read.
    #[must_use]
    pub const fn damaged(&self) -> u64 {
        self.damaged
    }
}

/// The numbers of a page's requests, one after the other.
#[derive(Clone, Copy, Debug)]
pub struct Numbers {
    last: u16,
}

impl Numbers {
    /// Those after some number.
    #[must_use]
    pub const fn new(last: u16) -> Self {
        Self { last }
    }

    /// The next one.
    pub const fn next(&mut self) -> u16 {
        self.last = self.last.wrapping_add(1);
        while matches!(self.last, OF_THE_LEG | OF_THE_SERVER) {
            self.last = self.last.wrapping_add(1);
        }
        self.last
    }
}

/// A command of a host as a frame; none if it fits into none.
#[must_use]
pub fn framed(number: u16, host: HostId, command: Command) -> Option<Vec<u8>> {
    framed_request(number, &HostRequest::Command { host, command })
}

/// What a host asks as a frame; none if it fits into none.
#[must_use]
pub fn framed_request(number: u16, request: &HostRequest) -> Option<Vec<u8>> {
    let mut out = [0; MAX_FRAME];
    let bytes = frame::encode(number, request, &mut out).ok()?;
    Some(bytes.to_vec())
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test may panic")]
mod tests {
    use super::{Frames, Numbers};
    use leg_firmware::frame::{MAX_FRAME, encode};
    use leg_firmware::host_link::{HostRefusal, HostReply};

    #[test]
    fn messages_are_found_in_any_pieces() {
        let mut bytes = Vec::new();
        let busy = HostReply::Refused(HostRefusal::Busy);
        for (number, reply) in [(7, &HostReply::Done), (8, &busy)] {
            bytes.extend_from_slice(encode(number, reply, &mut [0; MAX_FRAME]).unwrap());
        }
        for size in 1..bytes.len() {
            let mut frames = Frames::default();
            let found: Vec<_> = bytes
                .chunks(size)
                .flat_map(|part| frames.take(part))
                .collect();
            assert_eq!(found, [(7, HostReply::Done), (8, busy.clone())]);
            assert_eq!(frames.damaged(), 0);
        }
    }

    #[test]
    fn half_a_frame_at_the_start_is_no_damage_and_one_later_is() {
        let mut out = [0; MAX_FRAME];
        let bytes = encode(7, &HostReply::Done, &mut out).unwrap();
        let mut frames = Frames::default();
        assert!(frames.take(&bytes[3..]).is_empty());
        assert_eq!(frames.damaged(), 0);
        assert_eq!(frames.take(bytes).len(), 1);
        assert!(frames.take(&bytes[3..]).is_empty());
        assert_eq!(frames.damaged(), 1);
    }

    #[test]
    fn numbers_of_others_are_left_out() {
        let mut numbers = Numbers::new(u16::MAX - 2);
        assert_eq!(
            [numbers.next(), numbers.next(), numbers.next()],
            [u16::MAX - 1, 1, 2]
        );
    }
}
