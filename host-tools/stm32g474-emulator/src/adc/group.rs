//! Converters with common registers.

use super::clock::{ClockPlaces, ConverterClock};
use super::converter::{Converter, Surroundings};
use super::inputs::AnalogueInputs;
use crate::clocks::Clocks;
use crate::device::{Context, FieldPlace, RegisterFile};
use crate::facts::Facts;
use stm32_metapac::metadata::METADATA;

/// The trigger that TIM1 gives the converters.
const TRIGGER: &str = "TIM1_TRGO2";
/// What the makers put before the numbers of injected triggers.
const INJECTED_TRIGGER: &str = "ADC_JEXT_TRG";

/// What gives a group's kernel clock.
pub type KernelClock = fn(&Clocks) -> u32;

/// Converters with common registers.
#[derive(Clone, Debug)]
pub struct ConverterGroup {
    common: RegisterFile,
    clock: ClockPlaces,
    dual: FieldPlace,
    reference: FieldPlace,
    /// The second converter's flags in the common status.
    second: FieldPlace,
    /// Its converters.
    pub converters: Vec<Converter>,
    /// The number by which each knows [`TRIGGER`].
    triggers: Vec<Option<u32>>,
    /// Converters that the trigger does not reach.
    unreached: Vec<&'static str>,
    /// The name of their interrupt.
    pub interrupt: &'static str,
    kernel: KernelClock,
}

impl ConverterGroup {
    /// As after a reset; none without such registers.
    pub fn new(
        facts: &'static Facts,
        common: &str,
        names: &[&'static str],
        (interrupt, kernel): (&'static str, KernelClock),
    ) -> Option<Self> {
        let common = RegisterFile::new(facts.block(common)?);
        let blocks = names.iter().filter_map(|name| facts.block(name));
        Some(Self {
            clock: ClockPlaces::new(&common),
            dual: common.field("CCR", "DUAL"),
            reference: common.field("CCR", "VREFEN"),
            second: common.field("CSR", "ADRDY_SLV"),
            common,
            converters: blocks.map(Converter::new).collect(),
            triggers: names.iter().map(|name| trigger_number(name)).collect(),
            unreached: Vec::new(),
            interrupt,
            kernel,
        })
    }

    /// Whether a block is one of it.
    pub fn has(&self, block: &str) -> bool {
        let mut converters = self.converters.iter();
        self.common.block().name == block || converters.any(|one| one.name() == block)
    }

    /// As after a reset.
    pub fn reset(&mut self) {
        self.common.reset();
        self.converters.iter_mut().for_each(Converter::reset);
    }

    /// The clock of the moment.
    pub fn clock_of(&self, clocks: &Clocks) -> ConverterClock {
        self.clock
            .clock(&self.common, (self.kernel)(clocks), clocks)
    }

    fn surroundings<'a>(
        &self,
        inputs: &'a dyn AnalogueInputs,
        context: &Context<'_>,
    ) -> Surroundings<'a> {
        let enabled = self.converters.iter().filter(|one| one.is_enabled());
        Surroundings {
            clock: self.clock_of(context.clocks),
            several: enabled.count() > 1,
            reference: self.common.is_set(self.reference),
            inputs,
        }
    }

    /// Does what is due.
    pub fn advance(&mut self, inputs: &dyn AnalogueInputs, context: &mut Context<'_>) {
        let mut events = self.converters.iter().filter_map(Converter::next_event);
        if !events.any(|due| due <= context.cycle) {
            return;
        }
        let around = self.surroundings(inputs, context);
        for converter in &mut self.converters {
            converter.advance(&around, context);
        }
    }

    /// [`TRIGGER`] comes in a cycle.
    pub fn trigger(&mut self, cycle: u64, inputs: &dyn AnalogueInputs, context: &mut Context<'_>) {
        let around = self.surroundings(inputs, context);
        for (converter, number) in self.converters.iter_mut().zip(&self.triggers) {
            if let Some(number) = number
                && !self.unreached.contains(&converter.name())
            {
                converter.trigger(*number, cycle, &around, context);
            }
        }
    }

    /// Whether [`TRIGGER`] reaches a converter from now on.
    pub fn set_reached(&mut self, name: &'static str, reached: bool) {
        self.unreached.retain(|other| *other != name);
        if !reached {
            self.unreached.push(name);
        }
    }

    /// The processor reads a register.
    pub fn read(&mut self, block: &str, offset: u32) -> u32 {
        let mut converters = self.converters.iter_mut();
        if let Some(converter) = converters.find(|one| one.name() == block) {
            return converter.read(offset);
        }
        if offset == self.second.offset {
            return self.status();
        }
        self.common.get(offset)
    }

    /// The flags of both converters.
    fn status(&self) -> u32 {
        let mut flags = self.converters.iter().map(Converter::flags);
        let (first, second) = (flags.next(), flags.next());
        let shift = self.second.mask.trailing_zeros();
        first.unwrap_or_default() | second.unwrap_or_default() << shift
    }

    /// The processor writes a register.
    pub fn write(
        &mut self,
        block: &str,
        offset: u32,
        value: u32,
        inputs: &dyn AnalogueInputs,
        context: &mut Context<'_>,
    ) {
        let around = self.surroundings(inputs, context);
        let mut converters = self.converters.iter_mut();
        match converters.find(|one| one.name() == block) {
            Some(converter) => converter.write(offset, value, &around, context),
            None => self.write_common(offset, value, context),
        }
    }

    fn write_common(&mut self, offset: u32, value: u32, context: &mut Context<'_>) {
        let name = self.common.block().name;
        let fixed = [
            ("CKMODE", self.clock.mode),
            ("PRESC", self.clock.prescaler),
            ("DUAL", self.dual),
        ];
        let changed = self.common.get(offset) ^ value;
        let busy = self.converters.iter().find(|one| one.is_enabled());
        if let Some(converter) = busy {
            for (field, place) in fixed {
                if place.offset == offset && changed & place.mask != 0 {
                    context.findings.add(format!(
                        "{name}_CCR: {field} is changed while {} is switched on",
                        converter.name()
                    ));
                }
            }
        }
        if offset == self.dual.offset && self.dual.extract(value) != 0 {
            context.findings.add(format!(
                "{name}_CCR: DUAL is set, which the emulator does not model"
            ));
        }
        self.common.set(offset, value);
    }
}

/// The number of [`TRIGGER`] among a converter's injected triggers.
fn trigger_number(converter: &str) -> Option<u32> {
    let mut all = METADATA.peripherals.iter();
    let triggers = all.find(|block| block.name == converter)?.triggers;
    let mut numbers = triggers
        .iter()
        .filter(|trigger| trigger.source == TRIGGER)
        .filter_map(|trigger| trigger.signal.strip_prefix(INJECTED_TRIGGER));
    numbers.next()?.parse().ok()
}
