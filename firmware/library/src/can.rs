//! The frames of [`crate::frame`] on a CAN FD bus that six legs and one host share; no part of it touches hardware.
//!
//! **Identifiers** are the 11-bit ones: see [`Identifier`]. Each is sent by one node only, as CAN demands of two that
//! could send at once, and each is a stream of its own.
//!
//! **Payloads.** A link frame, final zero included, is cut into segments of up to [`SEGMENT_MAX`] bytes, one to a CAN
//! frame. A link frame never shares a CAN frame with another. In front of each segment stand two bytes:
//!
//! | byte | bits | meaning                                                                         |
//! |------|------|---------------------------------------------------------------------------------|
//! | 0    | 7    | the segment begins a link frame                                                 |
//! | 0    | 6    | it is the first that its sender sends: whatever was counted before is forgotten |
//! | 0    | 5–0  | length of the segment, 1 to 62 bytes                                            |
//! | 1    | 7–0  | counter: one more than that of the identifier's last CAN frame, modulo 256      |
//!
//! CAN FD has payloads of 0 to 8, 12, 16, 20, 24, 32, 48 and 64 bytes. What is left of the shortest one that holds
//! header and segment is filled with 0xCC, which needs no stuff bits; the header holds the true length, and a payload
//! of any other size than this shortest one is refused.
//!
//! **Loss.** A receiver gives out whole link frames only. A gap in the counter throws away the link frame that it falls
//! into and no other: bytes from both sides of a gap are never joined. Behind that still stands the frame's CRC-32, for
//! 256 frames lost in a row leave no gap in the counter. A CAN frame that comes twice, as happens when a transmitter
//! does not see that all others have accepted it, is dropped.
//!
//! **Urgency.** A link frame that fits into one CAN frame can go under an urgent identifier, which wins the bus from
//! everything else. It needs no counter, and comes out at once, even between two segments of an ordinary link frame.
//!
//! **Half-sent link frames** come into being where a controller goes bus-off ([`BusGuard`]) or a sender gives up. The
//! sender drops the remaining segments, does not send the first ones again, and goes on with the next link frame: the
//! receiver drops what it has of the old one when that begins. Whether a half-sent request is made again is for
//! whoever waits for its reply.

mod address;
mod assembler;
mod bus_guard;
mod can_frame;
mod error;
mod identifier;
mod segmenter;

pub use address::LegAddress;
pub use assembler::{Assembled, Assembler};
pub use bus_guard::{BusAction, BusGuard, BusState};
pub use can_frame::{CanFrame, PAYLOAD_MAX, SEGMENT_MAX};
pub use error::CanError;
pub use identifier::Identifier;
pub use segmenter::{SegmentError, Segmenter, Segments};

/// Bit rate while nodes arbitrate, bit/s. Every node on the bus has the same.
pub const NOMINAL_BIT_RATE: u32 = 1_000_000;

/// Bit rate of the payload, bit/s. Every node on the bus has the same.
pub const DATA_BIT_RATE: u32 = 5_000_000;

/// Where every node on the bus samples a bit, of either rate, in thousandths of it, as near as its clock allows. Nodes change the rate at their sample points: one that samples later
/// than the sender finds the bit before the payload at its end, or the next one.
pub const SAMPLE_POINT_PERMILLE: u32 = 750;

#[cfg(test)]
mod tests;
