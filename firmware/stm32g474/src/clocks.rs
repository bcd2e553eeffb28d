//! 170 MHz from the board's 24 MHz crystal.

use embassy_stm32::rcc::mux::{Adcsel, Fdcansel};
use embassy_stm32::rcc::{Hse, HseMode, Pll, PllMul, PllPreDiv, PllRDiv, PllSource, Sysclk};
use embassy_stm32::time::Hertz;
use embassy_stm32::{Config, pac};

/// 24 MHz / 6 × 85 / 2 = 170 MHz for processor, buses, timers, converters and CAN, with the core's voltage boosted as
/// that speed asks: `leg_firmware::board::timing` counts on it.
pub fn config() -> Config {
    let mut config = Config::default();
    config.rcc.hse = Some(Hse {
        freq: Hertz::mhz(24),
        mode: HseMode::Oscillator,
    });
    config.rcc.pll = Some(Pll {
        source: PllSource::HSE,
        prediv: PllPreDiv::DIV6,
        mul: PllMul::MUL85,
        divp: None,
        divq: None,
        divr: Some(PllRDiv::DIV2),
    });
    config.rcc.sys = Sysclk::PLL1_R;
    config.rcc.boost = true;
    config.rcc.mux.adc12sel = Adcsel::SYS;
    config.rcc.mux.adc345sel = Adcsel::SYS;
    config.rcc.mux.fdcansel = Fdcansel::PCLK1;
    config
}

/// Lets the chip watch its crystal. If it stops, TIM1's system break ends the pulses, the chip goes on from its own
/// oscillator, and an NMI is raised.
pub fn watch() {
    pac::RCC.cr().modify(|w| w.set_csson(true));
}

/// Whether the crystal has stopped.
pub fn lost() -> bool {
    pac::RCC.cifr().read().cssf()
}
