//! Bytes on their way to the host.

use crate::frame::{self, MAX_FRAME};
use crate::host_link::{HostRefusal, HostReply};
use heapless::Deque;

/// Room for three of the longest frames, and for a report beside them: while two hosts are sent the settings, room for a reply is kept
/// free, and the reports to a log go on.
pub(super) const ROOM: usize = 3 * MAX_FRAME + 256;

/// A queue of whole frames.
#[derive(Clone, Debug)]
pub struct Outbox(Deque<u8, ROOM>);

impl Outbox {
    pub const fn new() -> Self {
        Self(Deque::new())
    }

    /// Puts in a frame, or nothing of it if `spare` bytes would not be left free.
    pub fn put(&mut self, sequence: u16, reply: &HostReply, spare: usize) {
        let mut out = [0; MAX_FRAME];
        let Ok(bytes) = frame::encode(sequence, reply, &mut out) else {
            return;
        };
        let free = ROOM - self.0.len();
        if free < bytes.len() + spare {
            return;
        }
        for &byte in bytes {
            // There is room: it was just counted.
            let _ = self.0.push_back(byte);
        }
    }

    /// Puts in a refusal.
    // Apart, so that the reply takes stack only as long as it runs.
    #[inline(never)]
    pub fn refuse(&mut self, sequence: u16, refusal: HostRefusal) {
        self.put(sequence, &HostReply::Refused(refusal), 0);
    }

    /// Takes the next byte.
    pub fn take(&mut self) -> Option<u8> {
        self.0.pop_front()
    }
}
