//! PWR, as far as the speed of the processor depends on it, and the limits of that speed; and the voltage detector.

use crate::clocks::Clocks;
use crate::device::{Context, Device, FieldPlace, RegisterFile};
use crate::facts::Block;

/// Highest frequency of the processor, Hz, and the highest at each number of wait states: RM0440, tables of the voltage
/// ranges and of the flash's wait states.
const BOOST: &[u32] = &[
    34_000_000,
    68_000_000,
    102_000_000,
    136_000_000,
    170_000_000,
];
const RANGE_1: &[u32] = &[30_000_000, 60_000_000, 90_000_000, 120_000_000, 150_000_000];
const RANGE_2: &[u32] = &[12_000_000, 24_000_000, 26_000_000];

/// The supply below which the voltage detector acts, by PLS, mV: "around" these, says ST's driver of a sister
/// (stm32l4xx_ll_pwr.h); level 7 is a pin.
const DETECTOR_MV: [u32; 7] = [2_000, 2_200, 2_400, 2_500, 2_600, 2_800, 2_900];

/// The block.
#[derive(Clone, Debug)]
pub struct Pwr {
    registers: RegisterFile,
    range: FieldPlace,
    normal_mode: FieldPlace,
    detects: FieldPlace,
    level: FieldPlace,
}

impl Pwr {
    /// After a power-up.
    #[must_use]
    pub fn new(block: &'static Block) -> Self {
        let registers = RegisterFile::new(block);
        Self {
            range: registers.field("CR1", "VOS"),
            normal_mode: registers.field("CR5", "R1MODE"),
            detects: registers.field("CR2", "PVDE"),
            level: registers.field("CR2", "PLS"),
            registers,
        }
    }

    /// The core's voltage in words, and what the processor may run at with each number of wait states, Hz.
    fn limits(&self) -> (&'static str, &'static [u32]) {
        match (
            self.registers.value(self.range),
            self.registers.is_set(self.normal_mode),
        ) {
            (1, false) => ("range 1 boost", BOOST),
            (1, true) => ("range 1 normal", RANGE_1),
            _ => ("range 2", RANGE_2),
        }
    }

    /// The core's voltage, in words.
    #[must_use]
    pub fn voltage(&self) -> &'static str {
        self.limits().0
    }

    /// Whether the voltage detector finds a supply of so many millivolts too low.
    #[must_use]
    pub fn detects(&self, supply_mv: u32) -> bool {
        let level = DETECTOR_MV.get(self.registers.value(self.level) as usize);
        self.registers.is_set(self.detects) && level.is_some_and(|level| supply_mv < *level)
    }

    /// Reports a processor that is too fast for its voltage, or for the flash's wait states.
    pub fn check(&self, clocks: &Clocks, wait_states: u32, context: &mut Context<'_>) {
        let (range, limits) = self.limits();
        let highest = limits.last().copied().unwrap_or_default();
        if clocks.hclk > highest {
            context.findings.add(format!(
                "the processor runs at {} Hz in {range}, whose limit is {highest} Hz",
                clocks.hclk
            ));
            return;
        }
        let needed = limits.iter().position(|&limit| clocks.hclk <= limit);
        if needed.is_some_and(|needed| (wait_states as usize) < needed) {
            context.findings.add(format!(
                "the flash has {wait_states} wait states at {} Hz in {range}, and needs {}",
                clocks.hclk,
                needed.unwrap_or_default()
            ));
        }
    }
}

impl Device for Pwr {
    fn reset(&mut self) {
        self.registers.reset();
    }

    fn read(&mut self, offset: u32, _context: &mut Context<'_>) -> u32 {
        self.registers.get(offset)
    }

    fn write(&mut self, offset: u32, value: u32, _context: &mut Context<'_>) {
        self.registers.set(offset, value);
    }
}
