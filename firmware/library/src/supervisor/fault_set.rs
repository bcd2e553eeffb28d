//! A set of faults, one bit each.

use super::fault::Fault;
use super::reaction::Reaction;
use postcard_schema::Schema;
use serde::{Deserialize, Serialize};

/// A set of faults.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, Schema)]
pub struct FaultSet(u32);

/// The faults of one reaction.
const fn bits_with(reaction: Reaction) -> u32 {
    let mut bits = 0;
    let mut i = 0;
    while i < Fault::ALL.len() {
        if Fault::ALL[i].reaction() as u8 == reaction as u8 {
            bits |= FaultSet::single(Fault::ALL[i]).0;
        }
        i += 1;
    }
    bits
}

const LIMITS: u32 = bits_with(Reaction::Limit);
const RAMPS: u32 = bits_with(Reaction::RampDown);
const GATES: u32 = bits_with(Reaction::GateOff);

impl FaultSet {
    /// No fault.
    pub const NONE: Self = Self(0);

    /// Those that a counter or its motor may cause: a moving leg is not braked by its counters once one is latched.
    pub const SUSPECT_COUNTERS: Self = Self::single(Fault::EncoderJump)
        .union(Self::single(Fault::EncoderStill))
        .union(Self::single(Fault::EncoderReversed))
        .union(Self::single(Fault::Following));

    /// Those that say that a counter has not counted its tendon: the zero goes with them.
    pub const LOSES_ZERO: Self =
        Self::single(Fault::EncoderJump).union(Self::single(Fault::EncoderReversed));

    /// Those that the check of a load cell raises.
    pub const OF_CELLS: Self = Self::single(Fault::Slack)
        .union(Self::single(Fault::OverTension))
        .union(Self::single(Fault::TensionJump))
        .union(Self::single(Fault::Residual))
        .union(Self::single(Fault::CellStale))
        .union(Self::single(Fault::CellStuck))
        .union(Self::single(Fault::CellSaturated));

    /// Those that a load cell may cause: nothing is driven by one once it is latched. A leg that does not ring down may swing by what its cells
    /// show.
    pub const SUSPECT_CELLS: Self = Self::OF_CELLS.union(Self::single(Fault::Swings));

    /// One fault.
    #[must_use]
    pub const fn single(fault: Fault) -> Self {
        Self(1 << fault.code())
    }

    /// Adds a fault if it is there.
    #[inline(always)]
    pub fn add(&mut self, fault: Fault, there: bool) {
        self.0 |= u32::from(there) << fault.code();
    }

    /// Whether a fault is in it.
    #[must_use]
    pub const fn has(self, fault: Fault) -> bool {
        self.0 & Self::single(fault).0 != 0
    }

    /// Whether there is any.
    #[must_use]
    #[inline(always)]
    pub const fn any(self) -> bool {
        self.0 != 0
    }

    /// Whether any is in both.
    #[must_use]
    #[inline(always)]
    pub const fn overlaps(self, other: Self) -> bool {
        self.0 & other.0 != 0
    }

    /// Those of both.
    #[must_use]
    #[inline(always)]
    pub const fn union(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }

    /// Those that both have.
    #[must_use]
    #[inline(always)]
    pub const fn intersection(self, other: Self) -> Self {
        Self(self.0 & other.0)
    }

    /// Those that the other has not.
    #[must_use]
    #[inline(always)]
    pub const fn difference(self, other: Self) -> Self {
        Self(self.0 & !other.0)
    }

    /// Those that only limit.
    #[must_use]
    #[inline(always)]
    pub const fn limits(self) -> Self {
        Self(self.0 & LIMITS)
    }

    /// Those that do more than limit.
    #[must_use]
    #[inline(always)]
    pub const fn stopping(self) -> Self {
        Self(self.0 & !LIMITS)
    }

    /// The most severe reaction that any of them has.
    #[must_use]
    #[inline(always)]
    pub const fn most_severe(self) -> Option<Reaction> {
        if self.0 & GATES != 0 {
            Some(Reaction::GateOff)
        } else if self.0 & RAMPS != 0 {
            Some(Reaction::RampDown)
        } else if self.0 & !LIMITS != 0 {
            Some(Reaction::Hold)
        } else if self.0 != 0 {
            Some(Reaction::Limit)
        } else {
            None
        }
    }

    /// Every fault in it, in the order of the codes.
    pub fn faults(self) -> impl Iterator<Item = Fault> {
        Fault::ALL.into_iter().filter(move |fault| self.has(*fault))
    }
}

#[cfg(test)]
mod tests {
    use super::{Fault, FaultSet, Reaction};

    #[test]
    fn codes_follow_the_list_and_fit_into_the_bits() {
        for (code, fault) in (1..).zip(Fault::ALL) {
            assert_eq!(fault.code(), code);
            assert!(code < 32);
            let set = FaultSet::single(fault);
            assert_eq!(set.faults().collect::<Vec<_>>(), [fault]);
            assert_eq!(set.most_severe(), Some(fault.reaction()));
        }
    }

    /// As the page on the protocol says: fault n is bit n.
    #[test]
    fn a_fault_is_the_bit_of_its_code_on_the_line() {
        for (fault, expected) in [
            (Fault::Slack, [2, 0]),
            (Fault::OverTension, [4, 0]),
            (Fault::CellSaturated, [0x80, 1]),
        ] {
            let mut bytes = [0; 2];
            assert!(postcard::to_slice(&FaultSet::single(fault), &mut bytes).is_ok());
            assert_eq!(bytes, expected, "{fault:?}");
        }
    }

    #[test]
    fn the_most_severe_reaction_wins() {
        let mut set = FaultSet::single(Fault::Unreachable);
        assert_eq!(set.most_severe(), Some(Reaction::Limit));
        for fault in [Fault::Slack, Fault::OverTension, Fault::DriverFault] {
            set.add(fault, true);
            assert_eq!(set.most_severe(), Some(fault.reaction()));
        }
    }
}
