//! CAN frames become link frames again.

use super::can_frame::Header;
use super::{CanFault, CanFrame, Identifier, LegAddress};
use crate::frame::MAX_FRAME;
use heapless::Vec;

/// What a CAN frame brought. Both can be there at once: a link frame may follow upon a gap.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Taken<'a> {
    /// A whole link frame with its final zero, for a [`crate::frame::Decoder`].
    pub link_frame: Option<&'a [u8]>,
    /// What was noticed to be wrong.
    pub fault: Option<CanFault>,
}

impl Taken<'_> {
    const NOTHING: Self = Self {
        link_frame: None,
        fault: None,
    };

    const fn fault(fault: CanFault) -> Self {
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
    pub const fn of_leg(leg: LegAddress) -> Self {
        Self::of(Identifier::ToLeg(leg))
    }

    /// What the host receives from a leg.
    #[must_use]
    pub const fn of_host(leg: LegAddress) -> Self {
        Self::of(Identifier::ToHost(leg))
    }

    const fn of(ordinary: Identifier) -> Self {
        Self {
            ordinary,
            expected: None,
            place: Place::Between,
            link_frame: Vec::new(),
        }
    }

    /// Takes the next CAN frame from the bus; one for another receiver brings nothing.
    pub fn push<'a>(&'a mut self, frame: &'a CanFrame) -> Taken<'a> {
        let identifier = frame.identifier();
        if identifier == self.ordinary {
            return self.join(frame);
        }
        match (identifier, self.ordinary) {
            (Identifier::UrgentToAll, Identifier::ToLeg(_)) => whole(frame),
            (Identifier::Urgent(to), Identifier::ToLeg(leg)) if to == leg => whole(frame),
            _ => Taken::NOTHING,
        }
    }

    fn join(&mut self, frame: &CanFrame) -> Taken<'_> {
        let (header, segment) = match frame.unpack() {
            Ok(unpacked) => unpacked,
            Err(fault) => {
                self.place = Place::Skipping;
                return Taken::fault(fault);
            }
        };
        let gap = self.gap(header);
        if gap == Some(CanFault::Doubled) {
            return Taken::fault(CanFault::Doubled);
        }
        self.expected = Some(header.counter.wrapping_add(1));
        let unfinished = self.enter(header, gap);
        let overflow = self.append(segment);
        Taken {
            fault: gap.or(unfinished).or(overflow),
            link_frame: self.finished(),
        }
    }

    /// What the counter tells.
    fn gap(&self, header: Header) -> Option<CanFault> {
        match self.expected {
            _ if header.first => None,
            None if header.begins => None,
            Some(expected) if header.counter == expected => None,
            Some(expected) if header.counter == expected.wrapping_sub(1) => Some(CanFault::Doubled),
            None | Some(_) => Some(CanFault::Lost),
        }
    }

    /// Finds the place of a segment; tells if a link frame before it has no end.
    fn enter(&mut self, header: Header, gap: Option<CanFault>) -> Option<CanFault> {
        let before = self.place;
        if header.begins {
            self.place = Place::Inside;
            self.link_frame.clear();
            return (before == Place::Inside).then_some(CanFault::Unfinished);
        }
        if gap.is_some() || before == Place::Between {
            self.place = Place::Skipping;
        }
        None
    }

    fn append(&mut self, segment: &[u8]) -> Option<CanFault> {
        if self.place != Place::Inside || self.link_frame.extend_from_slice(segment).is_ok() {
            return None;
        }
        self.place = Place::Skipping;
        Some(CanFault::TooLong)
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

/// The link frame of an urgent CAN frame. Its counter is not looked at: a second stop harms nobody, and one that was
/// taken for a double would.
fn whole(frame: &CanFrame) -> Taken<'_> {
    match frame.unpack() {
        Err(fault) => Taken::fault(fault),
        Ok((header, segment)) if header.begins && segment.last() == Some(&0) => Taken {
            link_frame: Some(segment),
            fault: None,
        },
        Ok(_) => Taken::fault(CanFault::Unfinished),
    }
}
