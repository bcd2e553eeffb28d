//! The lines of the interrupts.

use stm32_metapac::metadata::METADATA;

/// The interrupts by their numbers; several peripherals may share one.
#[derive(Clone, Debug)]
pub struct Lines {
    numbers: Vec<(&'static str, u32)>,
    /// The lines that are high, bit by number.
    pub levels: u128,
}

impl Lines {
    /// All lines low.
    pub fn new() -> Self {
        let all = METADATA.interrupts.iter();
        Self {
            numbers: all.map(|one| (one.name, one.number)).collect(),
            levels: 0,
        }
    }

    /// All lines low again.
    pub fn clear(&mut self) {
        self.levels = 0;
    }

    /// A peripheral drives the line of an interrupt: high, or not.
    pub fn raise(&mut self, name: &str, level: bool) {
        if !level {
            return;
        }
        if let Some((_, number)) = self.numbers.iter().find(|(known, _)| *known == name) {
            self.levels |= 1 << number;
        }
    }
}
