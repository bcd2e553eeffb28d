//! For tests of devices: a bus that says registers and fields by their names.

#![allow(clippy::unwrap_used)]

use crate::clocks::Clocks;
use crate::device::{Context, Device};
use crate::facts::{Block, Facts};
use crate::findings::Findings;

/// Processor, buses and timers at 170 MHz, as the board runs.
pub const BOARD_CLOCKS: Clocks = Clocks {
    hclk: 170_000_000,
    pclk1: 170_000_000,
    pclk2: 170_000_000,
    timers1: 170_000_000,
    timers2: 170_000_000,
    adc12: 170_000_000,
    adc345: 170_000_000,
    lpuart1: 170_000_000,
    fdcan: 170_000_000,
};

/// A bus with a device.
pub struct DeviceBench<D: Device> {
    /// The device.
    pub device: D,
    /// The moment.
    pub cycle: u64,
    /// The frequencies.
    pub clocks: Clocks,
    findings: Findings,
    block: &'static Block,
}

impl<D: Device> DeviceBench<D> {
    /// A device for a block of the chip, at cycle 1000.
    pub fn new(block: &str, device: impl FnOnce(&'static Block) -> D) -> Self {
        let block = Facts::chip().block(block).unwrap();
        Self {
            device: device(block),
            cycle: 1_000,
            clocks: BOARD_CLOCKS,
            findings: Findings::default(),
            block,
        }
    }

    /// Does something with the device.
    pub fn act<T>(&mut self, act: impl FnOnce(&mut D, &mut Context<'_>) -> T) -> T {
        let mut context = Context {
            cycle: self.cycle,
            clocks: &self.clocks,
            findings: &mut self.findings,
        };
        act(&mut self.device, &mut context)
    }

    /// Turns to another block of the device.
    pub fn select(&mut self, block: &str) {
        self.block = Facts::chip().block(block).unwrap();
    }

    /// Reads a register.
    pub fn read(&mut self, register: &str) -> u32 {
        let offset = self.block.register(register).unwrap().offset;
        self.act(|device, context| device.read(offset, context))
    }

    /// Writes a register.
    pub fn write(&mut self, register: &str, value: u32) {
        let offset = self.block.register(register).unwrap().offset;
        self.act(|device, context| device.write(offset, value, context));
    }

    /// Reads a field.
    pub fn get(&mut self, register: &str, field: &str) -> u32 {
        let mask = self.mask(register, field);
        (self.read(register) & mask) >> mask.trailing_zeros()
    }

    /// Reads a register, sets fields, writes it.
    pub fn set(&mut self, register: &str, fields: &[(&str, u32)]) {
        let mut word = self.read(register);
        for (field, value) in fields {
            let mask = self.mask(register, field);
            word = word & !mask | value << mask.trailing_zeros();
        }
        self.write(register, word);
    }

    /// Writes a register: fields with values, and zeros beside them.
    pub fn put(&mut self, register: &str, fields: &[(&str, u32)]) {
        let word = fields.iter().fold(0, |word, (field, value)| {
            word | value << self.mask(register, field).trailing_zeros()
        });
        self.write(register, word);
    }

    /// Lets time pass, event by event.
    pub fn run_to(&mut self, cycle: u64) {
        while let Some(event) = self.device.next_event().filter(|event| *event <= cycle) {
            assert!(event >= self.cycle, "an event of the past");
            self.cycle = event;
            self.act(|device, context| device.advance(context));
            let next = self.device.next_event();
            assert!(next.is_none_or(|next| next > event), "an event stays due");
        }
        self.cycle = cycle;
        self.act(|device, context| device.advance(context));
    }

    /// Lets so many cycles pass.
    pub fn run(&mut self, cycles: u64) {
        self.run_to(self.cycle + cycles);
    }

    /// The findings since the last call.
    pub fn findings(&mut self) -> Vec<String> {
        let findings = std::mem::take(&mut self.findings);
        findings.list().iter().map(|f| f.text.clone()).collect()
    }

    fn mask(&self, register: &str, field: &str) -> u32 {
        let register = self.block.register(register).unwrap();
        let field = register.fields.iter().find(|known| known.name == field);
        field.unwrap().mask
    }
}
