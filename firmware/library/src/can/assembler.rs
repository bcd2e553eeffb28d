//! CAN frames become link frames again.

use super::can_frame::Header;
use super::{CanError, CanFrame, Identifier, LegAddress};
use crate::frame::MAX_FRAME;
use heapless::Vec;

/// What a CAN frame brought. Both can be there at once: a link frame may follow upon a gap.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Assembled<'a> {
    /// A whole link frame with its final zero, for a [`crate::frame::Decoder`].
    pub link_frame: Option<&'a [u8]>,
    /// What was noticed to be wrong.
    pub fault: Option<CanError>,
}

impl Assembled<'_> {
    const NOTHING: Self = Self {
        link_frame: None,
        fault: None,
    };

    const fn fault(fault: CanError) -> Self {
        Self {
            link_frame: None,
            fault: Some(fault),
        }
    }
}

/// Where in a link frame the stream is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Place {
    /// Between two link frames.
    Between,
    /// Inside one, all of which so far is there.
    Inside,
    /// Inside one of which something is missing.
    Skipping,
}

/// Joins what arrives for one receiver to whole link frames of up to `N` bytes.
///
/// It gives out whole link frames only, the urgent ones at once; so all that comes out of it, in that order, is a stream
/// for one [`crate::frame::Decoder`].
#[derive(Debug)]
pub struct Assembler<const N: usize = MAX_FRAME> {
    ordinary: Identifier,
    /// The counter that the next CAN frame should have.
    expected: Option<u8>,
    place: Place,
    link_frame: Vec<u8, N>,
}

impl<const N: usize> Assembler<N> {
    /// What a leg receives from the host: under its own address, and urgent to all.
    #[must_use]
    pub const fn leg_receiver(leg: LegAddress) -> Self {
        Self::receiving(Identifier::ToLeg(leg))
    }

    /// What the host receives from a leg.
    #[must_use]
    pub const fn host_receiver(leg: LegAddress) -> Self {
        Self::receiving(Identifier::ToHost(leg))
    }

    const fn receiving(ordinary: Identifier) -> Self {
        Self {
            ordinary,
            expected: None,
            place: Place::Between,
            link_frame: Vec::new(),
        }
    }

    /// Takes the next CAN frame from the bus; one for another receiver brings nothing.
    pub fn push<'a>(&'a mut self, frame: &'a CanFrame) -> Assembled<'a> {
        let identifier = frame.identifier();
        if identifier == self.ordinary {
            return self.join(frame);
        }
        match (identifier, self.ordinary) {
            (Identifier::UrgentToAll, Identifier::ToLeg(_)) => whole(frame),
            (Identifier::Urgent(to), Identifier::ToLeg(leg)) if to == leg => whole(frame),
            _ => Assembled::NOTHING,
        }
    }

    fn join(&mut self, frame: &CanFrame) -> Assembled<'_> {
        let (header, segment) = match frame.unpack() {
            Ok(unpacked) => unpacked,
            Err(fault) => {
                self.place = Place::Skipping;
                return Assembled::fault(fault);
            }
        };
        let gap = self.gap(header);
        if gap == Some(CanError::Doubled) {
            return Assembled::fault(CanError::Doubled);
        }
        self.expected = Some(header.counter.wrapping_add(1));
        let unfinished = self.enter(header, gap);
        let overflow = self.append(segment);
        Assembled {
            fault: gap.or(unfinished).or(overflow),
            link_frame: self.finished(),
        }
    }

    /// What the counter shows.
    fn gap(&self, header: Header) -> Option<CanError> {
        match self.expected {
            _ if header.first => None,
            None if header.begins => None,
            Some(expected) if header.counter == expected => None,
            Some(expected) if header.counter == expected.wrapping_sub(1) => Some(CanError::Doubled),
            None | Some(_) => Some(CanError::Lost),
        }
    }

    /// Finds the place of a segment; and whether the link frame before it has no end.
    fn enter(&mut self, header: Header, gap: Option<CanError>) -> Option<CanError> {
        let before = self.place;
        if header.begins {
            self.place = Place::Inside;
            self.link_frame.clear();
            return (before == Place::Inside).then_some(CanError::Unfinished);
        }
        if gap.is_some() || before == Place::Between {
            self.place = Place::Skipping;
        }
        None
    }

    fn append(&mut self, segment: &[u8]) -> Option<CanError> {
        if self.place != Place::Inside || self.link_frame.extend_from_slice(segment).is_ok() {
            return None;
        }
        self.place = Place::Skipping;
        Some(CanError::TooLong)
    }

    /// The link frame if it has come to its end.
    fn finished(&mut self) -> Option<&[u8]> {
        let ended = self.link_frame.last() == Some(&0);
        if self.place != Place::Inside || !ended {
            return None;
        }
        self.place = Place::Between;
        Some(&self.link_frame)
    }
}

/// The link frame of an urgent CAN frame. Its counter is not checked: a second stop harms nobody, and one that was
/// taken for a double would.
fn whole(frame: &CanFrame) -> Assembled<'_> {
    match frame.unpack() {
        Err(fault) => Assembled::fault(fault),
        Ok((header, segment)) if header.begins && segment.last() == Some(&0) => Assembled {
            link_frame: Some(segment),
            fault: None,
        },
        Ok(_) => Assembled::fault(CanError::Unfinished),
    }
}
