//! Link frames become CAN frames.

use super::can_frame::Header;
use super::{CanFrame, Identifier, SEGMENT_MAX};

/// Why something cannot be sent.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SegmentError {
    /// It is not one link frame: not empty, and with a zero at its end and nowhere else.
    NotOneFrame,
    /// It is longer than [`SEGMENT_MAX`], and the identifier is an urgent one.
    TooLongForUrgent,
}

impl core::fmt::Display for SegmentError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.write_str(match self {
            Self::NotOneFrame => "what is sent has to be one whole frame with its final zero",
            Self::TooLongForUrgent => "an urgent frame has to fit into one CAN frame",
        })
    }
}

impl core::error::Error for SegmentError {}

/// Cuts link frames into the CAN frames of one identifier, and counts them.
///
/// An identifier has one segmenter in the whole system; the first frame of a new one restarts the counter of the receiver.
#[derive(Debug)]
pub struct Segmenter {
    identifier: Identifier,
    counter: u8,
    first: bool,
}

impl Segmenter {
    /// A segmenter that has sent nothing yet.
    #[must_use]
    pub const fn new(identifier: Identifier) -> Self {
        Self {
            identifier,
            counter: 0,
            first: true,
        }
    }

    /// The CAN frames of one link frame, to be sent in their order.
    ///
    /// Dropping the rest of them gives the link frame up; the receiver notices when the next one begins.
    ///
    /// # Errors
    /// [`SegmentError`] if `link_frame` is not one, or not short enough for an urgent identifier.
    pub fn segments<'a>(&'a mut self, link_frame: &'a [u8]) -> Result<Segments<'a>, SegmentError> {
        let zero = link_frame.iter().position(|&byte| byte == 0);
        if zero.map(|index| index + 1) != Some(link_frame.len()) {
            return Err(SegmentError::NotOneFrame);
        }
        if self.identifier.urgent() && link_frame.len() > SEGMENT_MAX {
            return Err(SegmentError::TooLongForUrgent);
        }
        Ok(Segments {
            segmenter: self,
            rest: link_frame,
            begins: true,
        })
    }

    fn header(&mut self, begins: bool) -> Header {
        let counter = self.counter;
        self.counter = counter.wrapping_add(1);
        Header {
            begins,
            first: core::mem::take(&mut self.first),
            counter,
        }
    }
}

/// The CAN frames of one link frame: see [`Segmenter::segments`].
#[derive(Debug)]
pub struct Segments<'a> {
    segmenter: &'a mut Segmenter,
    rest: &'a [u8],
    begins: bool,
}

impl Iterator for Segments<'_> {
    type Item = CanFrame;

    fn next(&mut self) -> Option<CanFrame> {
        let length = self.rest.len().min(SEGMENT_MAX);
        let (segment, rest) = self.rest.split_at_checked(length)?;
        if segment.is_empty() {
            return None;
        }
        self.rest = rest;
        let header = self
            .segmenter
            .header(core::mem::replace(&mut self.begins, false));
        CanFrame::pack(self.segmenter.identifier, header, segment)
    }
}
