//! One CAN FD frame: an identifier and up to 64 bytes.

use super::{CanError, Identifier};

/// Most bytes in a CAN FD frame.
pub const PAYLOAD_MAX: usize = 64;

const HEADER: usize = 2;

/// Most bytes of a link frame in one CAN frame.
pub const SEGMENT_MAX: usize = PAYLOAD_MAX - HEADER;

/// The sizes that a CAN FD payload can have, bytes.
const SIZES: [usize; 16] = [0, 1, 2, 3, 4, 5, 6, 7, 8, 12, 16, 20, 24, 32, 48, 64];

/// Fills a payload up: it alternates often enough to need no stuff bits.
const PADDING: u8 = 0xCC;

const BEGINS: u8 = 0x80;
const FIRST: u8 = 0x40;
const LENGTH: u8 = 0x3f;

/// What stands in front of a segment.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Header {
    /// The segment begins a link frame.
    pub begins: bool,
    /// It is the first that its sender sends.
    pub first: bool,
    /// One more than that of the CAN frame before.
    pub counter: u8,
}

/// A CAN FD frame of the bus.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CanFrame {
    identifier: Identifier,
    size: usize,
    bytes: [u8; PAYLOAD_MAX],
}

impl CanFrame {
    /// A frame as a controller received it.
    ///
    /// # Errors
    /// [`CanError::WrongLength`] if CAN FD has no payload of that size.
    pub fn new(identifier: Identifier, payload: &[u8]) -> Result<Self, CanError> {
        if fitting(payload.len()) != Some(payload.len()) {
            return Err(CanError::WrongLength);
        }
        let mut bytes = [PADDING; PAYLOAD_MAX];
        bytes
            .get_mut(..payload.len())
            .ok_or(CanError::WrongLength)?
            .copy_from_slice(payload);
        Ok(Self {
            identifier,
            size: payload.len(),
            bytes,
        })
    }

    /// Who sends it to whom.
    #[must_use]
    pub const fn identifier(&self) -> Identifier {
        self.identifier
    }

    /// The payload for a controller to send: its size is one that CAN FD has.
    #[must_use]
    pub fn payload(&self) -> &[u8] {
        self.bytes.get(..self.size).unwrap_or_default()
    }

    /// A frame with a segment of at most [`SEGMENT_MAX`] bytes; `None` if it is longer.
    pub(super) fn pack(identifier: Identifier, header: Header, segment: &[u8]) -> Option<Self> {
        let size = fitting(HEADER + segment.len())?;
        let length = u8::try_from(segment.len()).ok()?;
        let mut bytes = [PADDING; PAYLOAD_MAX];
        let (head, rest) = bytes.split_at_mut(HEADER);
        let begins = if header.begins { BEGINS } else { 0 };
        let first = if header.first { FIRST } else { 0 };
        head.copy_from_slice(&[begins | first | length, header.counter]);
        rest.get_mut(..segment.len())?.copy_from_slice(segment);
        Some(Self {
            identifier,
            size,
            bytes,
        })
    }

    /// The header and the segment behind it.
    pub(super) fn unpack(&self) -> Result<(Header, &[u8]), CanError> {
        let (&[flags, counter], rest) = self
            .payload()
            .split_first_chunk::<HEADER>()
            .ok_or(CanError::WrongLength)?;
        let length = usize::from(flags & LENGTH);
        if length == 0 || fitting(HEADER + length) != Some(self.size) {
            return Err(CanError::WrongLength);
        }
        let header = Header {
            begins: flags & BEGINS != 0,
            first: flags & FIRST != 0,
            counter,
        };
        let segment = rest.get(..length).ok_or(CanError::WrongLength)?;
        Ok((header, segment))
    }
}

/// The shortest payload that holds so many bytes.
fn fitting(length: usize) -> Option<usize> {
    SIZES.into_iter().find(|&size| size >= length)
}
