//! Pins: what drives them from outside, their levels, and the signals that they are routed to.

use super::{Devices, ENCODER_TIMERS};
use crate::device::Context;
use crate::facts::{Facts, Pin};
use crate::gpio::{Gpio, Outside, PinMode};

/// The inputs of TIM1's breaks.
const BREAK_INPUTS: [&str; 2] = ["BKIN", "BKIN2"];

impl Devices {
    pub(super) fn route_breaks(&mut self, context: &mut Context<'_>) {
        let mut changed = false;
        for port in &mut self.ports {
            changed |= port.take_changed();
        }
        if changed {
            self.break_pins = BREAK_INPUTS.map(|signal| self.pin_of("TIM1", signal));
        }
        for (index, pin) in self.break_pins.into_iter().enumerate() {
            let level = pin.and_then(|pin| self.level(pin)).unwrap_or(false);
            if self.break_levels.get(index) != Some(&level) {
                self.tim1.set_break_input(index, level, context);
            }
            if let Some(before) = self.break_levels.get_mut(index) {
                *before = level;
            }
        }
    }

    /// The pin that the image has given to a peripheral's signal.
    #[must_use]
    pub fn pin_of(&self, peripheral: &str, signal: &str) -> Option<Pin> {
        let facts = Facts::chip();
        self.ports.iter().find_map(|port| {
            (0..16).map(|number| port.pin(number)).find(|pin| {
                matches!(port.mode(pin.number), PinMode::Alternate(function)
                    if facts.alternate_function(*pin, function).contains(&(peripheral, signal)))
            })
        })
    }

    fn port(&self, pin: Pin) -> Option<&Gpio> {
        self.ports.iter().find(|port| port.pin(0).port == pin.port)
    }

    /// Says what drives a pin from outside.
    pub fn set_outside(&mut self, pin: Pin, outside: Outside) {
        let mut ports = self.ports.iter_mut();
        if let Some(port) = ports.find(|port| port.pin(0).port == pin.port) {
            port.set_outside(pin.number, outside);
        }
    }

    /// Moves an encoder, 0 to 2, to a count, on tracks that are routed to its timer or not.
    pub fn set_encoder(&mut self, encoder: usize, count: u32, routed: bool) {
        if let Some(timer) = self.encoders.get_mut(encoder) {
            timer.set_position(count, routed);
        }
    }

    /// Whether a pin is routed to a signal of an encoder's timer.
    #[must_use]
    pub fn encoder_routed(&self, encoder: usize, pin: Pin, signal: &str) -> bool {
        let timer = ENCODER_TIMERS.get(encoder);
        timer.is_some_and(|timer| self.is_routed(pin, timer, signal))
    }

    /// Whether the image has given a pin to a peripheral's signal.
    #[must_use]
    pub fn is_routed(&self, pin: Pin, peripheral: &str, signal: &str) -> bool {
        let mode = self.port(pin).map(|port| port.mode(pin.number));
        matches!(mode, Some(PinMode::Alternate(function))
            if Facts::chip().alternate_function(pin, function).contains(&(peripheral, signal)))
    }

    /// Whether a pin that the chip drives is let go of where it should be high.
    #[must_use]
    pub fn is_open_drain(&self, pin: Pin) -> bool {
        self.port(pin)
            .is_some_and(|port| port.is_open_drain(pin.number))
    }

    /// The level of a pin; none where nothing gives it one.
    #[must_use]
    pub fn level(&self, pin: Pin) -> Option<bool> {
        self.port(pin)?.level(pin.number)
    }
}
