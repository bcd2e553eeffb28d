//! The clock of a group of converters, by the group's common register.

use crate::clocks::Clocks;
use crate::device::{FieldPlace, RegisterFile};

/// Division of the kernel clock by the value of `PRESC`.
const PRESCALERS: [u32; 12] = [1, 2, 4, 6, 8, 10, 12, 16, 32, 64, 128, 256];

/// What the converters' clock may reach, Hz, with a supply of 3.3 V, inputs against ground, and the core in range 1: one
/// converter, and several of a group. The first is embassy-stm32's `MAX_ADC_CLK_FREQ`, too; the second by memory of the
/// datasheet's table "ADC characteristics".
pub const LIMIT_HZ: (u32, u32) = (60_000_000, 52_000_000);

/// The clock of converters: a frequency and its division.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ConverterClock {
    hz: u32,
    divisor: u32,
    hclk: u32,
}

/// Where the common register has it.
#[derive(Clone, Copy, Debug)]
pub struct ClockPlaces {
    /// `CKMODE`.
    pub mode: FieldPlace,
    /// `PRESC`.
    pub prescaler: FieldPlace,
}

impl ClockPlaces {
    /// Finds them.
    #[must_use]
    pub fn new(common: &RegisterFile) -> Self {
        Self {
            mode: common.field("CCR", "CKMODE"),
            prescaler: common.field("CCR", "PRESC"),
        }
    }

    /// The clock of the moment, by the kernel clock of the group.
    #[must_use]
    pub fn clock(&self, common: &RegisterFile, kernel: u32, clocks: &Clocks) -> ConverterClock {
        let (hz, divisor) = match common.value(self.mode) {
            0 => {
                let value = usize::try_from(common.value(self.prescaler)).unwrap_or_default();
                (kernel, PRESCALERS.get(value).copied().unwrap_or(1))
            }
            mode => (clocks.hclk, 1 << (mode - 1)),
        };
        ConverterClock {
            hz,
            divisor,
            hclk: clocks.hclk,
        }
    }
}

impl ConverterClock {
    /// Whether it stands still.
    #[must_use]
    pub fn is_off(&self) -> bool {
        self.hz == 0
    }

    /// Its frequency, rounded up, Hz.
    #[must_use]
    pub fn hz(&self) -> u32 {
        self.hz.div_ceil(self.divisor)
    }

    /// Cycles of the processor in so many half periods, rounded up; none if the clock stands still.
    #[must_use]
    pub fn cycles(&self, halves: u64) -> Option<u64> {
        let product = halves * u64::from(self.divisor) * u64::from(self.hclk);
        (self.hz > 0).then(|| product.div_ceil(2 * u64::from(self.hz)))
    }

    /// Nanoseconds in so many half periods.
    #[must_use]
    pub fn nanoseconds(&self, halves: u64) -> u64 {
        let product = halves * u64::from(self.divisor) * 500_000_000;
        product / u64::from(self.hz.max(1))
    }
}
