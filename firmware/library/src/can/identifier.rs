//! The 11-bit identifiers: who sends, to whom, and how urgently.

use super::LegAddress;

const CLASS_SHIFT: u32 = 8;
const URGENT: u16 = 0;
const TO_LEG: u16 = 1;
const TO_HOST: u16 = 2;
const EVERYBODY: u16 = 0;

/// A CAN identifier of the bus.
///
/// | bits | meaning                                                       |
/// |------|---------------------------------------------------------------|
/// | 10–8 | 0: host to leg, urgent; 1: host to leg; 2: leg to host        |
/// | 7–3  | zero                                                          |
/// | 2–0  | address of the leg, 1 to 6; with an urgent 0: of all legs     |
///
/// Where two nodes begin at once the lower identifier goes on. So a stop wins from everything, one of all legs even
/// from that of one; a command wins from what legs send; and leg 1 from leg 6, where both would send.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Identifier {
    /// From the host to all legs, before everything else: 0x000.
    UrgentToAll,
    /// From the host to a leg, before everything but [`Self::UrgentToAll`]: 0x001 to 0x006.
    Urgent(LegAddress),
    /// From the host to a leg: 0x101 to 0x106.
    ToLeg(LegAddress),
    /// From a leg to the host: 0x201 to 0x206.
    ToHost(LegAddress),
}

impl Identifier {
    /// The identifier's 11 bits.
    #[must_use]
    pub const fn bits(self) -> u16 {
        match self {
            Self::UrgentToAll => pack(URGENT, EVERYBODY),
            Self::Urgent(leg) => pack(URGENT, leg.number() as u16),
            Self::ToLeg(leg) => pack(TO_LEG, leg.number() as u16),
            Self::ToHost(leg) => pack(TO_HOST, leg.number() as u16),
        }
    }

    /// The identifier with these 11 bits; `None` if the bus has no such one.
    #[must_use]
    pub const fn from_bits(bits: u16) -> Option<Self> {
        let low = bits & !(u16::MAX << CLASS_SHIFT);
        let class = bits >> CLASS_SHIFT;
        match (class, LegAddress::new(low as u8)) {
            (URGENT, None) if low == EVERYBODY => Some(Self::UrgentToAll),
            (URGENT, Some(leg)) => Some(Self::Urgent(leg)),
            (TO_LEG, Some(leg)) => Some(Self::ToLeg(leg)),
            (TO_HOST, Some(leg)) => Some(Self::ToHost(leg)),
            _ => None,
        }
    }

    /// What a leg has to receive; a controller's filters let these through and nothing else.
    #[must_use]
    pub const fn received_by(leg: LegAddress) -> [Self; 3] {
        [Self::UrgentToAll, Self::Urgent(leg), Self::ToLeg(leg)]
    }

    /// Whether a link frame under it has to fit into one CAN frame, which then needs no counter.
    #[must_use]
    pub const fn urgent(self) -> bool {
        matches!(self, Self::UrgentToAll | Self::Urgent(_))
    }
}

const fn pack(class: u16, address: u16) -> u16 {
    class << CLASS_SHIFT | address
}
