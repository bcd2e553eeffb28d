//! Whether the converters' reference is what all codes are taken for, by the chip's own voltage of 1.2 V.
//!
//! Every code is a part of the converters' reference, which is the supply of the chip: if that sags, load cells, currents and
//! supply all seem more than they are.

/// The code of the chip's own voltage with a reference of 3.3 V, and what of it is in question: 3.0 V, and 3.6 V. The voltage
/// is 1.182 to 1.232 V: datasheet of the STM32G474, "Embedded voltage reference".
const LOWEST: u16 = code(1_182, 3_600);
const HIGHEST: u16 = code(1_232, 3_000);

/// The code of a voltage, in mV, with a reference.
const fn code(voltage: u32, reference: u32) -> u16 {
    (voltage * 16 * 4_095 / reference) as u16
}

/// The code of the motor supply: the highest or the lowest where the reference is out of range, so that the leg is held as with
/// a supply that has failed; `reference` is the code of the chip's own voltage, which is high where the reference is low.
#[must_use]
#[inline(always)]
pub const fn checked_supply(supply: u16, reference: u16) -> u16 {
    if reference > HIGHEST {
        0
    } else if reference < LOWEST {
        u16::MAX
    } else {
        supply
    }
}

#[cfg(test)]
mod tests {
    use super::{checked_supply, code};

    #[test]
    fn a_reference_in_range_leaves_the_supply_alone() {
        for (voltage, reference) in [(1_212, 3_300), (1_182, 3_500), (1_232, 3_050)] {
            assert_eq!(checked_supply(40_000, code(voltage, reference)), 40_000);
        }
    }

    #[test]
    fn a_reference_out_of_range_is_a_supply_that_has_failed() {
        const LATEST_MV: [u32; 2] = [2_870, 3_760];
        for voltage in [1_182, 1_212, 1_232] {
            let [low, high] = LATEST_MV.map(|mv| checked_supply(40_000, code(voltage, mv)));
            assert_eq!([low, high], [0, u16::MAX], "{voltage}");
        }
        let [low, high] = LATEST_MV.map(|mv| f64::from(mv) * 1e-3);
        let words = format!("{low:.2} and {high:.2} V at the latest");
        assert!(
            include_str!("../../../SAFETY.md").contains(&words),
            "{words}"
        );
        // A converter that reads nothing, and one at its end.
        assert_eq!(checked_supply(40_000, 0), u16::MAX);
        assert_eq!(checked_supply(40_000, u16::MAX), 0);
    }
}
