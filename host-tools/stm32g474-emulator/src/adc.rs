//! The converters: ADC1 and ADC2 with their common registers, and ADC3 with those of ADC3 to ADC5.
//!
//! A conversion takes its sampling time and 12.5 periods; the delays of triggers and of flags, a few periods, are not
//! modelled. Not modelled either, and reported where they are asked for: DMA, dual modes, discontinuous and automatic
//! sequences, analogue watchdogs, and hardware triggers of regular conversions. Conversion k of a code, from 0, gives
//! (s + k mod 16) / 16, where s is the input's sum of 16 conversions: so 16 conversions add up to s.

mod clock;
mod converter;
mod group;
mod inputs;
mod places;
mod power;
mod rules;
#[cfg(test)]
mod tests;

pub use inputs::{AnalogueInputs, SOURCE_OHMS, sum_of};

use crate::clocks::Clocks;
use crate::device::Context;
use crate::facts::Facts;
use converter::Converter;
use converter::Group;
use group::{ConverterGroup, KernelClock};

/// Group by group: its common registers, its converters, its interrupt, and its kernel clock.
const GROUPS: [(&str, &[&str], &str, KernelClock); 2] = [
    ("ADC12_COMMON", &["ADC1", "ADC2"], "ADC1_2", |c| c.adc12),
    ("ADC345_COMMON", &["ADC3"], "ADC3", |c| c.adc345),
];

/// All converters.
#[derive(Clone, Debug)]
pub struct AdcConverters {
    groups: Vec<ConverterGroup>,
}

impl AdcConverters {
    /// As after a reset.
    ///
    /// # Panics
    /// If the facts lack a converter's registers.
    #[must_use]
    pub fn new(facts: &'static Facts) -> Self {
        let groups = GROUPS.iter();
        Self {
            groups: groups
                .filter_map(|(common, names, interrupt, kernel)| {
                    ConverterGroup::new(facts, common, names, (interrupt, *kernel))
                })
                .collect(),
        }
    }

    /// The clock of a converter, Hz; 0 for one that is not here.
    #[must_use]
    pub fn hz(&self, name: &str, clocks: &Clocks) -> u32 {
        let group = self.groups.iter().find(|group| group.has(name));
        group.map_or(0, |group| group.clock_of(clocks).hz())
    }

    /// As after a reset of the group that a block belongs to: `ADC1`, `ADC12_COMMON`.
    pub fn reset(&mut self, block: &str) {
        for group in self.groups.iter_mut().filter(|group| group.has(block)) {
            group.reset();
        }
    }

    /// As after a reset of the chip.
    pub fn reset_all(&mut self) {
        self.groups.iter_mut().for_each(ConverterGroup::reset);
    }

    /// The input that a rank of a converter's injected sequence, 0 to 3, converts.
    #[must_use]
    pub fn injected_input(&self, name: &str, rank: usize) -> Option<u8> {
        self.named(name)?.injected_input(rank)
    }

    /// The code of a rank of a converter's injected sequence, 0 to 3, without what reading its register does.
    #[must_use]
    pub fn injected_code(&self, name: &str, rank: usize) -> Option<u32> {
        self.named(name)?.injected_code(rank)
    }

    fn named(&self, name: &str) -> Option<&Converter> {
        let mut converters = self.groups.iter().flat_map(|group| &group.converters);
        converters.find(|one| one.name() == name)
    }

    /// The processor reads a register of a block; none where the block is not modelled.
    pub fn read(
        &mut self,
        block: &str,
        offset: u32,
        inputs: &dyn AnalogueInputs,
        context: &mut Context<'_>,
    ) -> Option<u32> {
        let group = self.groups.iter_mut().find(|group| group.has(block))?;
        group.advance(inputs, context);
        Some(group.read(block, offset))
    }

    /// The processor writes a register of a block; none where the block is not modelled.
    pub fn write(
        &mut self,
        block: &str,
        (offset, value): (u32, u32),
        inputs: &dyn AnalogueInputs,
        context: &mut Context<'_>,
    ) -> Option<()> {
        let group = self.groups.iter_mut().find(|group| group.has(block))?;
        group.advance(inputs, context);
        group.write(block, offset, value, inputs, context);
        Some(())
    }

    /// TIM1's second trigger comes in a cycle, which is not after the moment.
    pub fn trigger(&mut self, cycle: u64, inputs: &dyn AnalogueInputs, context: &mut Context<'_>) {
        self.advance(inputs, context);
        for group in &mut self.groups {
            group.trigger(cycle, inputs, context);
        }
    }

    /// Whether TIM1's second trigger reaches a converter from now on: a fault of the chip, for tests of what notices it.
    pub fn set_trigger_reaches(&mut self, name: &'static str, reached: bool) {
        if let Some(group) = self.groups.iter_mut().find(|group| group.has(name)) {
            group.set_reached(name, reached);
        }
    }

    /// The next cycle in which something happens by itself.
    #[must_use]
    pub fn next_event(&self) -> Option<u64> {
        let converters = self.groups.iter().flat_map(|group| &group.converters);
        converters.filter_map(Converter::next_event).min()
    }

    /// Does what is due at the moment.
    pub fn advance(&mut self, inputs: &dyn AnalogueInputs, context: &mut Context<'_>) {
        for group in &mut self.groups {
            group.advance(inputs, context);
        }
    }

    /// Their interrupts and the levels.
    #[must_use]
    pub fn interrupts(&self) -> Vec<(&'static str, bool)> {
        let groups = self.groups.iter();
        groups
            .map(|group| {
                let raised = group.converters.iter().any(Converter::interrupt);
                (group.interrupt, raised)
            })
            .collect()
    }

    /// Cycles from the begin of a converter's injected sequence to its end, with what the registers say.
    #[must_use]
    pub fn injected_cycles(&self, name: &str, clocks: &Clocks) -> Option<u64> {
        let group = self.groups.iter().find(|group| group.has(name))?;
        let converter = group.converters.iter().find(|one| one.name() == name)?;
        let halves = converter.sequence_halves(Group::Injected);
        group.clock_of(clocks).cycles(halves)
    }
}
