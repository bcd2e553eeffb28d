//! 170 MHz from the board's 24 MHz crystal.

use embassy_stm32::rcc::mux::{Adcsel, Fdcansel};
use embassy_stm32::rcc::{Hse, HseMode, Pll, PllMul, PllPreDiv, PllRDiv, PllSource, Sysclk};
use embassy_stm32::time::Hertz;
use embassy_stm32::{Config, Peripherals, pac, rcc};

/// PWR_CR5.R1MODE, set for the normal voltage of range 1, clear for the boosted one: bit 8 by RM0440 and by ST's own
/// description of the registers. stm32-metapac 21.0.0 has it at bit 0, so that `config.boost` alone boosts nothing.
const R1MODE: u32 = 1 << 8;

/// Starts the chip at 170 MHz.
///
/// `init` resets PWR, and so its boost: it leaves the chip at 16 MHz. Above 150 MHz the voltage has to be boosted before.
pub fn start() -> Peripherals {
    let mut peripherals = embassy_stm32::init(Config::default());
    pac::PWR.cr5().modify(|w| w.0 &= !R1MODE);
    rcc::reinit(config(), &mut peripherals.RCC);
    peripherals
}

/// 24 MHz / 6 × 85 / 2 = 170 MHz for processor, buses, timers, converters and CAN: `leg_firmware::board::timing` counts on
/// it.
fn config() -> rcc::Config {
    let mut config = rcc::Config::default();
    config.hse = Some(Hse {
        freq: Hertz::mhz(24),
        mode: HseMode::Oscillator,
    });
    config.pll = Some(Pll {
        source: PllSource::HSE,
        prediv: PllPreDiv::DIV6,
        mul: PllMul::MUL85,
        divp: None,
        divq: None,
        divr: Some(PllRDiv::DIV2),
    });
    config.sys = Sysclk::PLL1_R;
    config.boost = true;
    config.mux.adc12sel = Adcsel::SYS;
    config.mux.adc345sel = Adcsel::SYS;
    config.mux.fdcansel = Fdcansel::PCLK1;
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
