//! What the fuzz targets share.

mod board;
mod host_requests;
mod requests;

pub use board::NoBoard;
pub use host_requests::{brought, host_requests};
pub use requests::{armed, requests};

use leg_firmware::frame::{Decoder, FrameError, MAX_FRAME, MAX_PAYLOAD, encode};
use serde::ser::SerializeTuple;
use serde::{Serialize, Serializer};

/// A frame's sequence and payload, or why it was refused.
pub type Found = Result<(u16, Vec<u8>), FrameError>;

/// Bytes as they are: postcard writes nothing beside them.
struct Payload<'a>(&'a [u8]);

impl Serialize for Payload<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut tuple = serializer.serialize_tuple(self.0.len())?;
        for byte in self.0 {
            tuple.serialize_element(byte)?;
        }
        tuple.end()
    }
}

/// A good frame with this payload, which is cut to what a frame holds.
pub fn framed(sequence: u16, payload: &[u8]) -> Vec<u8> {
    let payload = &payload[..payload.len().min(MAX_PAYLOAD)];
    let mut out = [0; MAX_FRAME];
    let frame = encode(sequence, &Payload(payload), &mut out);
    frame.expect("the payload fits").to_vec()
}

/// All that a decoder finds.
pub fn feed(decoder: &mut Decoder, bytes: &[u8]) -> Vec<Found> {
    let owned = |found: Result<leg_firmware::frame::Frame<'_>, FrameError>| {
        found.map(|frame| (frame.sequence, frame.payload.to_vec()))
    };
    let mut found = Vec::new();
    for &byte in bytes {
        found.extend(decoder.push(byte).map(owned));
    }
    found
}
