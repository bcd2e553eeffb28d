//! The frequencies that the clock tree gives, as the image has set it.

/// The frequencies of the moment, Hz.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Clocks {
    /// Processor, memories and the peripherals of AHB.
    pub hclk: u32,
    /// Peripherals of APB1.
    pub pclk1: u32,
    /// Peripherals of APB2.
    pub pclk2: u32,
    /// Timers on APB1.
    pub timers1: u32,
    /// Timers on APB2.
    pub timers2: u32,
    /// What `ADC12SEL` chooses for ADC1 and ADC2; 0 for none.
    pub adc12: u32,
    /// What `ADC345SEL` chooses for ADC3 to ADC5; 0 for none.
    pub adc345: u32,
    /// What `LPUART1SEL` chooses.
    pub lpuart1: u32,
    /// What `FDCANSEL` chooses.
    pub fdcan: u32,
}

/// The oscillator of the watchdog, Hz: its typical frequency.
pub const LSI_HZ: u32 = 32_000;

impl Clocks {
    /// After a reset: everything from the internal oscillator of 16 MHz.
    pub const RESET: Self = Self {
        hclk: 16_000_000,
        pclk1: 16_000_000,
        pclk2: 16_000_000,
        timers1: 16_000_000,
        timers2: 16_000_000,
        adc12: 0,
        adc345: 0,
        lpuart1: 16_000_000,
        fdcan: 0,
    };

    /// Cycles of the processor in `count` periods of a clock of `hz`, rounded up; none if that clock stands still.
    #[must_use]
    pub fn cycles(&self, count: u64, hz: u32) -> Option<u64> {
        (hz > 0).then(|| (count * u64::from(self.hclk)).div_ceil(u64::from(hz)))
    }
}
