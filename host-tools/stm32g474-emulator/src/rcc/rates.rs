//! The source in use, and the frequencies that follow from it.

use super::Rcc;
use crate::clocks::Clocks;

/// Frequency of the internal oscillator, Hz.
const HSI_HZ: u32 = 16_000_000;

/// Values of SW and SWS.
pub const SOURCE_HSI: u32 = 1;
pub const SOURCE_HSE: u32 = 2;
pub const SOURCE_PLL: u32 = 3;

/// Values of PLLSRC.
pub const PLL_FROM_HSI: u32 = 2;
pub const PLL_FROM_HSE: u32 = 3;

/// Values of FDCANSEL.
pub const FDCAN_FROM_HSE: u32 = 0;
pub const FDCAN_FROM_PLL: u32 = 1;
const FDCAN_FROM_PCLK: u32 = 2;

impl Rcc {
    /// What the processor and the buses run from, Hz.
    fn system_hz(&self, cycle: u64) -> u32 {
        match self.source(cycle) {
            SOURCE_HSE => self.crystal_hz,
            SOURCE_PLL => self.pll_hz(),
            _ => HSI_HZ,
        }
    }

    /// The source in use: the one that is chosen as soon as it is ready.
    pub(super) fn source(&self, cycle: u64) -> u32 {
        let chosen = self.registers.value(self.fields.source);
        let ready = match chosen {
            SOURCE_HSE => self.hse.ready(cycle),
            SOURCE_PLL => self.pll_gives(cycle),
            _ => true,
        };
        if ready { chosen } else { SOURCE_HSI }
    }

    /// Whether the PLL has locked, and its output R is on.
    pub(super) fn pll_gives(&self, cycle: u64) -> bool {
        self.pll.ready(cycle) && self.registers.is_set(self.fields.pll_r_on)
    }

    fn pll_hz(&self) -> u32 {
        self.vco_hz() / (2 * (self.registers.value(self.fields.pll_r) + 1))
    }

    pub(super) fn pll_input_hz(&self) -> u32 {
        let input = match self.registers.value(self.fields.pll_source) {
            PLL_FROM_HSI => HSI_HZ,
            PLL_FROM_HSE => self.crystal_hz,
            _ => 0,
        };
        input / (self.registers.value(self.fields.pll_divider) + 1)
    }

    pub(super) fn vco_hz(&self) -> u32 {
        self.pll_input_hz() * self.registers.value(self.fields.pll_factor)
    }

    /// The frequencies of the moment.
    #[must_use]
    pub fn clocks(&self, cycle: u64) -> Clocks {
        let system = self.system_hz(cycle);
        let hclk = system / ahb_divider(self.registers.value(self.fields.ahb));
        let [pclk1, timers1] = apb(hclk, self.registers.value(self.fields.apb1));
        let [pclk2, timers2] = apb(hclk, self.registers.value(self.fields.apb2));
        let chosen = |field| self.registers.value(field);
        Clocks {
            hclk,
            pclk1,
            pclk2,
            timers1,
            timers2,
            adc12: adc_hz(chosen(self.fields.adc12), system),
            adc345: adc_hz(chosen(self.fields.adc345), system),
            lpuart1: match chosen(self.fields.lpuart1) {
                0 => pclk1,
                1 => system,
                2 => HSI_HZ,
                _ => 0,
            },
            fdcan: match chosen(self.fields.fdcan) {
                FDCAN_FROM_HSE if self.hse.is_on() => self.crystal_hz,
                FDCAN_FROM_PCLK => pclk1,
                _ => 0,
            },
        }
    }
}

/// HPRE: 8 is a half, 15 a 512th, without a 32nd.
fn ahb_divider(value: u32) -> u32 {
    match value {
        0..8 => 1,
        8..12 => 2 << (value - 8),
        _ => 64 << (value - 12),
    }
}

/// PPRE: frequency of a bus and of its timers, which run twice as fast where the bus is divided.
fn apb(hclk: u32, value: u32) -> [u32; 2] {
    match value {
        0..4 => [hclk, hclk],
        _ => {
            let bus = hclk / (2 << (value - 4));
            [bus, 2 * bus]
        }
    }
}

/// ADC12SEL and ADC345SEL: none, PLL P (not modelled), or the system's clock.
fn adc_hz(value: u32, system: u32) -> u32 {
    if value == 2 { system } else { 0 }
}
