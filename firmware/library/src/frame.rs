//! Frames on a byte stream: COBS(sequence, payload, CRC-32), then a zero.
//!
//! The sequence is a `u16` and the CRC a `u32`, both little-endian; the CRC (ISO-HDLC) covers what precedes it.
//! The payload is a message in postcard's format. A zero occurs nowhere inside a frame, so a receiver that lost its
//! place finds it again at the next zero.

use crate::store::SETTINGS_MAX;
use cobs::{DecodeResult, DecoderState};
use crc::{CRC_32_ISO_HDLC, Crc};
use postcard_schema::Schema;
use serde::{Deserialize, Serialize};

#[cfg(test)]
mod tests;

/// Longest payload, bytes.
pub const MAX_PAYLOAD: usize = 1112;

// Settings are the longest message; beside them are the numbers of their variants.
const _: () = assert!(SETTINGS_MAX + 2 <= MAX_PAYLOAD);

const SEQUENCE: usize = size_of::<u16>();
const CHECKSUM: usize = size_of::<u32>();
const MAX_BODY: usize = SEQUENCE + MAX_PAYLOAD + CHECKSUM;

/// Longest frame on the wire without its final zero, bytes.
const MAX_ENCODED: usize = cobs::max_encoding_length(MAX_BODY);

/// Longest frame on the wire, bytes.
pub const MAX_FRAME: usize = MAX_ENCODED + 1;

const CRC: Crc<u32> = Crc::<u32>::new(&CRC_32_ISO_HDLC);

/// Why a frame is not accepted.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, Schema)]
pub enum FrameError {
    /// It is longer than [`MAX_FRAME`].
    TooLong,
    /// It is too short to hold a sequence and a CRC.
    TooShort,
    /// It is not COBS.
    BadCobs,
    /// Its CRC belongs to other bytes.
    BadCrc,
    /// The message has no form in postcard's format.
    NotSerialisable,
}

impl core::fmt::Display for FrameError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.write_str(match self {
            Self::TooLong => "the frame is too long",
            Self::TooShort => "the frame is too short to hold a sequence and a CRC",
            Self::BadCobs => "the frame is not COBS",
            Self::BadCrc => "the frame's CRC belongs to other bytes",
            Self::NotSerialisable => "the message has no form in postcard's format",
        })
    }
}

impl core::error::Error for FrameError {}

/// A frame whose CRC was right.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Frame<'a> {
    /// Chosen by the host for a request; the reply has the same.
    pub sequence: u16,
    /// The message in postcard's format.
    pub payload: &'a [u8],
}

impl<'a> Frame<'a> {
    /// The message inside; `None` if the payload is anything but exactly one `T`.
    #[must_use]
    // Apart: settings take a kilobyte of stack at each step of what reads them.
    #[inline(never)]
    pub fn message<T: Deserialize<'a>>(&self) -> Option<T> {
        match postcard::take_from_bytes(self.payload) {
            Ok((message, [])) => Some(message),
            Ok(_) | Err(_) => None,
        }
    }
}

/// Writes a message as a frame into `out` and returns the part that was written, final zero included.
///
/// # Errors
/// [`FrameError::TooLong`] if the message takes more than [`MAX_PAYLOAD`] bytes; [`FrameError::NotSerialisable`] if
/// postcard refuses it for another reason.
pub fn encode<'a, T: Serialize>(
    sequence: u16,
    message: &T,
    out: &'a mut [u8; MAX_FRAME],
) -> Result<&'a [u8], FrameError> {
    let mut body = [0; MAX_BODY];
    let length = fill(sequence, message, &mut body)?;
    let body = body.get(..length).ok_or(FrameError::TooLong)?;
    let encoded = cobs::try_encode(body, out).map_err(|_| FrameError::TooLong)?;
    let frame = out.get_mut(..=encoded).ok_or(FrameError::TooLong)?;
    if let Some(last) = frame.last_mut() {
        *last = 0;
    }
    Ok(frame)
}

/// Writes sequence, message and CRC; returns how many bytes they take.
fn fill<T: Serialize>(
    sequence: u16,
    message: &T,
    body: &mut [u8; MAX_BODY],
) -> Result<usize, FrameError> {
    let (head, rest) = body.split_at_mut(SEQUENCE);
    head.copy_from_slice(&sequence.to_le_bytes());
    let payload = rest.get_mut(..MAX_PAYLOAD).ok_or(FrameError::TooLong)?;
    let written = postcard::to_slice(message, payload).map_err(|error| match error {
        postcard::Error::SerializeBufferFull => FrameError::TooLong,
        _ => FrameError::NotSerialisable,
    })?;
    let checked = SEQUENCE + written.len();
    let (checked_bytes, rest) = body
        .split_at_mut_checked(checked)
        .ok_or(FrameError::TooLong)?;
    let checksum = CRC.checksum(checked_bytes).to_le_bytes();
    rest.first_chunk_mut::<CHECKSUM>()
        .ok_or(FrameError::TooLong)?
        .copy_from_slice(&checksum);
    Ok(checked + CHECKSUM)
}

/// Finds frames in a stream of bytes.
#[derive(Debug)]
pub struct Decoder {
    state: DecoderState,
    body: [u8; MAX_BODY],
    length: usize,
    too_long: bool,
}

impl Decoder {
    /// A decoder at the start of a stream.
    #[must_use]
    pub const fn new() -> Self {
        Self {
            state: DecoderState::Idle,
            body: [0; MAX_BODY],
            length: 0,
            too_long: false,
        }
    }

    /// Takes the stream's next byte; a zero ends a frame, which is then given.
    ///
    /// Zeros between frames are skipped, so a sender may send one to end a frame of which the receiver has only a part.
    pub fn push(&mut self, byte: u8) -> Option<Result<Frame<'_>, FrameError>> {
        match self.state.feed(byte) {
            Ok(DecodeResult::NoData | DecodeResult::DataStart) => None,
            Ok(DecodeResult::DataContinue(decoded)) => {
                self.append(decoded);
                None
            }
            Ok(DecodeResult::DataComplete) => Some(self.finish()),
            Err(_) => {
                self.restart();
                Some(Err(FrameError::BadCobs))
            }
        }
    }

    fn append(&mut self, byte: u8) {
        match self.body.get_mut(self.length) {
            Some(place) => {
                *place = byte;
                self.length += 1;
            }
            None => self.too_long = true,
        }
    }

    /// Forgets the frame so far; returns its length and whether it was too long.
    fn restart(&mut self) -> (usize, bool) {
        let length = core::mem::take(&mut self.length);
        (length, core::mem::take(&mut self.too_long))
    }

    fn finish(&mut self) -> Result<Frame<'_>, FrameError> {
        match self.restart() {
            (_, true) => Err(FrameError::TooLong),
            (length, false) => unpack(self.body.get(..length).unwrap_or_default()),
        }
    }
}

impl Clone for Decoder {
    fn clone(&self) -> Self {
        #[allow(clippy::needless_match, reason = "the crate gives its state no Clone")]
        let state = match self.state {
            DecoderState::Idle => DecoderState::Idle,
            DecoderState::Grab(left) => DecoderState::Grab(left),
            DecoderState::GrabChain(left) => DecoderState::GrabChain(left),
        };
        Self { state, ..*self }
    }
}

impl Default for Decoder {
    fn default() -> Self {
        Self::new()
    }
}

fn unpack(body: &[u8]) -> Result<Frame<'_>, FrameError> {
    let (checked, checksum) = body
        .split_last_chunk::<CHECKSUM>()
        .ok_or(FrameError::TooShort)?;
    let (sequence, payload) = checked
        .split_first_chunk::<SEQUENCE>()
        .ok_or(FrameError::TooShort)?;
    if CRC.checksum(checked) != u32::from_le_bytes(*checksum) {
        return Err(FrameError::BadCrc);
    }
    Ok(Frame {
        sequence: u16::from_le_bytes(*sequence),
        payload,
    })
}
