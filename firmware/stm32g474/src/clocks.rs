//! 170 MHz from the board's 24 MHz crystal.

use embassy_stm32::pac::flash::vals::Latency;
use embassy_stm32::pac::timer::vals::Urs;
use embassy_stm32::rcc::mux::{Adcsel, Fdcansel, Uartsel};
use embassy_stm32::rcc::{
    AHBPrescaler, Hse, HseMode, LsConfig, Pll, PllMul, PllPreDiv, PllRDiv, PllSource, Sysclk,
};
use embassy_stm32::time::Hertz;
use embassy_stm32::{Config, Peripherals, pac, rcc};
use leg_firmware::board::timing::{CLOCK_HZ, TASK_TIMER_HZ};

/// PWR_CR5.R1MODE, set for the normal voltage of range 1, clear for the boosted one: bit 8 by RM0440 and by ST's own
/// description of the registers. stm32-metapac 21.0.0 has it at bit 0, so that `config.boost` alone boosts nothing.
const R1MODE: u32 = 1 << 8;

/// The most wait states, which the flash needs above 136 MHz.
const WAIT_STATES: Latency = Latency::WS4;

/// Cycles at half of the full clock that are at least the microsecond for which RM0440 asks there.
const PAUSE_CYCLES: u32 = CLOCK_HZ / 2 / 1_000_000;

/// How long the crystal may take to start, in steps of a millisecond at least: its maker gives 10 ms.
const CRYSTAL_STEPS: u32 = 100;

/// The chip starts with its own oscillator.
pub const START_HZ: u32 = 16_000_000;

/// Cycles of it that are a millisecond at least.
const CRYSTAL_STEP_CYCLES: u32 = START_HZ / 1_000;

/// What TIM15, by which embassy's tasks wait, divides the full clock by.
const TASK_TIMER_DIVISOR: u16 = (CLOCK_HZ / TASK_TIMER_HZ) as u16;

const _: () = assert!(embassy_time::TICK_HZ == TASK_TIMER_HZ as u64);

/// Starts the chip at 170 MHz.
///
/// `init` resets PWR, and so its boost: it leaves the chip at 16 MHz. Above 150 MHz the voltage has to be boosted before.
/// None where the crystal does not start.
pub fn start() -> Option<Peripherals> {
    let mut config = Config::default();
    config.rcc.ls = LsConfig::off();
    let mut peripherals = embassy_stm32::init(config);
    reset_backup_domain();
    if !start_crystal() {
        return None;
    }
    pac::PWR.cr5().modify(|w| w.0 &= !R1MODE);
    rcc::reinit(half_speed(), &mut peripherals.RCC);
    double_speed();
    Some(peripherals)
}

/// Nothing of the backup domain is used, and a short dip of the supply may leave anything in it: by ST's errata of this family an RTC that runs from LSI
/// makes LSI, and so the independent watchdog, faster than specified, and a clock output on PA2 would take the serial line's pin.
fn reset_backup_domain() {
    pac::PWR.cr1().modify(|w| w.set_dbp(true));
    pac::RCC.bdcr().modify(|w| w.set_bdrst(true));
    pac::RCC.bdcr().modify(|w| w.set_bdrst(false));
}

/// Whether the crystal starts: embassy waits for it without an end, and no watchdog runs yet.
fn start_crystal() -> bool {
    pac::RCC.cr().modify(|w| w.set_hseon(true));
    for _ in 0..CRYSTAL_STEPS {
        if pac::RCC.cr().read().hserdy() {
            return true;
        }
        cortex_m::asm::delay(CRYSTAL_STEP_CYCLES);
    }
    false
}

/// 24 MHz / 6 × 85 / 2 = 170 MHz for the converters and the serial line, and half of it for processor and buses.
///
/// embassy goes to its frequency in one step, and so it is asked for half of it. It never learns the whole: what it sets
/// by a bus's frequency must not be used. The serial line and the converters therefore run from the system's clock, whose
/// frequency it knows, and CAN is given its bit timing in cycles. [`double_speed`] mends the timer of embassy's tasks.
fn half_speed() -> rcc::Config {
    let mut config = rcc::Config::default();
    config.ls = LsConfig::off();
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
    config.ahb_pre = AHBPrescaler::DIV2;
    config.boost = true;
    config.mux.adc12sel = Adcsel::SYS;
    config.mux.adc345sel = Adcsel::SYS;
    config.mux.lpuart1sel = Uartsel::SYS;
    config.mux.fdcansel = Fdcansel::PCLK1;
    config
}

/// 170 MHz for processor, buses, timers and CAN, too: `leg_firmware::board::timing` counts on it.
fn double_speed() {
    pac::FLASH.acr().modify(|w| w.set_latency(WAIT_STATES));
    while pac::FLASH.acr().read().latency() != WAIT_STATES {}
    cortex_m::asm::delay(PAUSE_CYCLES);
    pac::RCC.cfgr().modify(|w| w.set_hpre(AHBPrescaler::DIV1));
    // Taken over at once, and without the interrupt that counts the timer's periods.
    let timer = pac::TIM15;
    timer.psc().write_value(TASK_TIMER_DIVISOR - 1);
    timer.cr1().modify(|w| w.set_urs(Urs::COUNTER_ONLY));
    timer.egr().write(|w| w.set_ug(true));
    timer.cr1().modify(|w| w.set_urs(Urs::ANY_EVENT));
}

/// Lets the chip watch its crystal. If it stops, TIM1's system break ends the pulses, the chip goes on from its own
/// oscillator, and an NMI is raised.
pub fn watch() {
    pac::RCC.cr().modify(|w| w.set_csson(true));
}

/// Whether the chip runs from the oscillator with which it starts.
pub fn has_start_clock() -> bool {
    pac::RCC.cfgr().read().sws() == Sysclk::HSI
}

/// Whether the crystal has stopped.
pub fn lost() -> bool {
    pac::RCC.cifr().read().cssf()
}
