//! The inputs of the converters.

use crate::adc::AnalogueInputs;
use crate::facts::{Facts, Pin};
use crate::gpio::{Gpio, PinMode};
use std::cell::RefCell;
use std::collections::BTreeMap;

/// What the converters get at their inputs.
pub struct Inputs<'a> {
    /// Whose pins have to be in analogue mode.
    pub ports: &'a [Gpio],
    /// What the board gives, by pin: sums of 16 conversions.
    pub analogue: &'a BTreeMap<Pin, u16>,
    /// Where what was converted is noted.
    pub sampled: &'a RefCell<BTreeMap<Pin, u16>>,
}

impl AnalogueInputs for Inputs<'_> {
    fn sum16(&self, converter: &str, input: u8) -> Option<u16> {
        let pin = Facts::of_chip().converter_pin(converter, input)?;
        let port = self.ports.iter().find(|p| p.pin(0).port == pin.port)?;
        if port.mode(pin.number) != PinMode::Analogue {
            return None;
        }
        let value = self.analogue.get(&pin).copied()?;
        self.sampled.borrow_mut().insert(pin, value);
        Some(value)
    }
}
