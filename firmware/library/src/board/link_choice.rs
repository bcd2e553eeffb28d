//! Which line a board listens to.

use crate::can::LegAddress;

/// The one line on which a board's host is: a leg that answered on two would not know which of them it answers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LinkChoice {
    /// The serial line that the on-board debugger passes on over USB.
    Serial,
    /// The CAN FD bus, under an address.
    Can(LegAddress),
}

impl LinkChoice {
    /// What three address switches choose, the first the least significant bit of the leg's number: the bus for 1 to 6,
    /// the serial line for none, and for all, which no leg has for an address.
    #[must_use]
    pub fn from_switches(closed: [bool; 3]) -> Self {
        let [one, two, four] = closed.map(u8::from);
        LegAddress::new(one + 2 * two + 4 * four).map_or(Self::Serial, Self::Can)
    }
}

#[cfg(test)]
mod tests {
    use super::LinkChoice;
    use crate::can::LegAddress;

    #[test]
    fn the_switches_are_the_legs_number() {
        for leg in LegAddress::ALL {
            let bit = |bit: u8| leg.number() >> bit & 1 == 1;
            let chosen = LinkChoice::from_switches([bit(0), bit(1), bit(2)]);
            assert_eq!(chosen, LinkChoice::Can(leg));
        }
    }

    #[test]
    fn without_an_address_it_is_the_serial_line() {
        for closed in [[false; 3], [true; 3]] {
            assert_eq!(LinkChoice::from_switches(closed), LinkChoice::Serial);
        }
    }
}
