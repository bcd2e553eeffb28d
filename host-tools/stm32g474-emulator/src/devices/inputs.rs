//! The inputs of the converters.

use crate::adc::{AnalogueInputs, SOURCE_OHMS};
use crate::facts::{Facts, Pin};
use crate::gpio::{Gpio, PinMode};
use std::cell::RefCell;
use std::collections::BTreeMap;

/// Where the chip's own voltage is converted: embassy-stm32 names the same for `VrefInt`.
const REFERENCE_INPUT: (&str, u8) = ("ADC3", 18);

/// The chip's own voltage has to be sampled for 4 µs (datasheet, tS_vrefint): as a source of so many ohms.
const REFERENCE_OHMS: u32 = 10_000;

/// What the converters get at their inputs.
pub struct Inputs<'a> {
    /// Whose pins have to be in analogue mode.
    pub ports: &'a [Gpio],
    /// What the board gives, by pin: sums of 16 conversions.
    pub analogue: &'a BTreeMap<Pin, u16>,
    /// The chip's own voltage.
    pub reference: u16,
    /// Where what was converted is noted.
    pub sampled: &'a RefCell<BTreeMap<Pin, u16>>,
}

impl AnalogueInputs for Inputs<'_> {
    fn sum16(&self, converter: &str, input: u8) -> Option<u16> {
        if (converter, input) == REFERENCE_INPUT {
            return Some(self.reference);
        }
        let pin = Facts::chip().converter_pin(converter, input)?;
        let port = self.ports.iter().find(|p| p.pin(0).port == pin.port)?;
        if port.mode(pin.number) != PinMode::Analogue {
            return None;
        }
        let value = self.analogue.get(&pin).copied()?;
        self.sampled.borrow_mut().insert(pin, value);
        Some(value)
    }

    fn is_reference(&self, converter: &str, input: u8) -> bool {
        (converter, input) == REFERENCE_INPUT
    }

    fn source_ohms(&self, converter: &str, input: u8) -> u32 {
        if (converter, input) == REFERENCE_INPUT {
            REFERENCE_OHMS
        } else {
            SOURCE_OHMS
        }
    }
}
