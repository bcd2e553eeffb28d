//! The power stage: TIM1 makes the pulses, and its break inputs end them without the processor.
//!
//! TIM1 counts up and down (centre-aligned). The break inputs force its outputs low, and only software can switch them
//! on again. Break 1 (PB10) is the drivers' common fault line, low when raised; break 2 (PC3) the emergency stop, a
//! contact to ground that opens: a torn wire stops the leg as well. What the chip finds of itself is a break, too: a
//! lockup of the processor, a crystal that stops, a supply below 2.9 V, an ECC or parity error; and so is a halt by a debugger. The drivers' enable line (PC9) is a plain pin: it follows within a tick.

use crate::tick_watchdog;
use embassy_stm32::gpio::{AfType, AnyPin, Flex, Level, Output, OutputType, Pull, Speed};
use embassy_stm32::pac;
use embassy_stm32::pac::timer::regs::SrAdv;
use embassy_stm32::pac::timer::vals::{Bkinp, Bkp, Cms, FilterValue, Lock, Mms2, Ocm, Ossi, Ossr};
use embassy_stm32::peripherals::{
    PA8, PA9, PA10, PB2, PB10, PB11, PB15, PC3, PC6, PC7, PC8, PC9, TIM1,
};
use embassy_stm32::{Peri, rcc};
use leg_firmware::board::timing::{PWM_TOP, REPETITIONS};
use leg_firmware::board::{BridgeOutput, FaultLines, PowerPins};

/// TIM1's channels on PA8 to PA10.
const CHANNEL_AF: u8 = 6;
/// TIM1_BKIN on PB10.
const BREAK_1_AF: u8 = 12;
/// TIM1_BKIN2 on PC3.
const BREAK_2_AF: u8 = 6;

/// First of the three direction pins of port C.
const DIRECTION_PIN: usize = 6;
/// Pin of port C.
const ENABLE_PIN: usize = 9;
/// Pin of port C.
const STOP_PIN: usize = 3;
/// Pins of port B.
const FAULT_PINS: [usize; 3] = [2, 11, 15];

/// A break shorter than 0.4 µs is noise: eight samples at an eighth of 170 MHz.
const BREAK_FILTER: FilterValue = FilterValue::FDTS_DIV8_N8;

/// The pins of the power stage.
pub struct PowerParts {
    /// The timer.
    pub timer: Peri<'static, TIM1>,
    /// Pulses of motor 1.
    pub pulse_1: Peri<'static, PA8>,
    /// Pulses of motor 2.
    pub pulse_2: Peri<'static, PA9>,
    /// Pulses of motor 3.
    pub pulse_3: Peri<'static, PA10>,
    /// Direction of motor 1, high to pull in.
    pub direction_1: Peri<'static, PC6>,
    /// Direction of motor 2.
    pub direction_2: Peri<'static, PC7>,
    /// Direction of motor 3.
    pub direction_3: Peri<'static, PC8>,
    /// Enables the drivers, high.
    pub enable: Peri<'static, PC9>,
    /// Fault line of driver 1, low when raised.
    pub fault_1: Peri<'static, PB2>,
    /// Fault line of driver 2.
    pub fault_2: Peri<'static, PB11>,
    /// Fault line of driver 3.
    pub fault_3: Peri<'static, PB15>,
    /// The drivers' common fault line, low when raised.
    pub any_fault: Peri<'static, PB10>,
    /// Emergency stop, high when pressed.
    pub stop: Peri<'static, PC3>,
}

/// TIM1 and the pins around it.
pub struct Power {
    _outputs: [Output<'static>; 4],
    _others: [Flex<'static>; 8],
}

impl Power {
    /// Sets everything up with the outputs off. The timer stands still until [`start`].
    pub fn new(parts: PowerParts) -> Self {
        // The enable line first, and the timer before its pins: whatever comes out of them then is low.
        let enable = Output::new(parts.enable, Level::Low, Speed::Low);
        set_up_timer(parts.timer);
        let output = |pin: Peri<'static, AnyPin>| Output::new(pin, Level::Low, Speed::Low);
        Self {
            _outputs: [
                enable,
                output(parts.direction_1.into()),
                output(parts.direction_2.into()),
                output(parts.direction_3.into()),
            ],
            _others: [
                pulse(Flex::new(parts.pulse_1)),
                pulse(Flex::new(parts.pulse_2)),
                pulse(Flex::new(parts.pulse_3)),
                pulled_up(Flex::new(parts.fault_1)),
                pulled_up(Flex::new(parts.fault_2)),
                pulled_up(Flex::new(parts.fault_3)),
                break_input(Flex::new(parts.any_fault), BREAK_1_AF),
                break_input(Flex::new(parts.stop), BREAK_2_AF),
            ],
        }
    }

    /// What the fault lines show; a break is reported once, or as long as it lasts.
    #[inline(always)]
    pub fn fault_lines(&self, lost: bool) -> FaultLines {
        let (port_b, port_c) = (pac::GPIOB.idr().read().0, pac::GPIOC.idr().read().0);
        let high = |port: u32, pin: usize| port >> pin & 1 == 1;
        let breaks = take_breaks();
        FaultLines {
            drivers: FAULT_PINS.map(|pin| !high(port_b, pin)),
            stop: high(port_c, STOP_PIN),
            // A system break shows where something was driven: the outputs are lost. Elsewhere, as where settings are read
            // that a loss of power has damaged, it is no fault of the drivers.
            driver_break: breaks.bif(0),
            stop_break: breaks.bif(1),
            lost,
        }
    }
}

impl PowerPins for Power {
    #[inline(always)]
    fn set(&mut self, motor: usize, half: BridgeOutput) {
        let pin = DIRECTION_PIN + motor;
        let bit = if half.forward { 1 } else { 1 << 16 };
        pac::GPIOC.bsrr().write(|w| w.0 = bit << pin);
        match motor {
            0 => pac::TIM1.ccr(0).write(|w| w.set_ccr(half.compare)),
            1 => pac::TIM1.ccr(1).write(|w| w.set_ccr(half.compare)),
            _ => pac::TIM1.ccr(2).write(|w| w.set_ccr(half.compare)),
        }
    }

    #[inline(always)]
    fn switch(&mut self, on: bool) {
        if on {
            pac::TIM1.bdtr().modify(|w| w.set_moe(true));
            pac::GPIOC.bsrr().write(|w| w.set_bs(ENABLE_PIN, true));
        } else {
            cut_outputs();
            tick_watchdog::set_rest_in_halt(true);
        }
    }

    #[inline(always)]
    fn is_on(&self) -> bool {
        pac::TIM1.bdtr().read().moe()
    }
}

/// Switches the outputs off, from wherever it is called and whatever has been set up yet.
#[inline(always)]
pub fn cut_outputs() {
    pac::GPIOC.bsrr().write(|w| w.set_br(ENABLE_PIN, true));
    pac::TIM1.bdtr().modify(|w| w.set_moe(false));
}

/// Lets the timer run, and with it the ticks.
///
/// Until their pins were routed and pulled up, the break inputs read whatever there was: what they caught then is cleared.
/// A cause that is there keeps its flag set.
pub fn start() {
    take_breaks();
    pac::TIM1.cr1().modify(|w| w.set_cen(true));
    tick_watchdog::start();
}

fn set_up_timer(_timer: Peri<'static, TIM1>) {
    rcc::enable_and_reset::<TIM1>();
    // A debugger that halts the processor stops the timer, which then switches its outputs off.
    pac::DBGMCU.apb2fzr().modify(|w| w.set_tim1(true));
    // So does a processor that is locked up, a supply that is too low, and a memory that has lost what it held. SRAM has its
    // parity checked only where the option byte SRAM_PE says so.
    pac::SYSCFG.cfgr2().modify(|w| {
        w.set_cll(true);
        w.set_pvdl(true);
        w.set_eccl(true);
        w.set_spl(true);
    });
    let timer = pac::TIM1;
    timer.cr1().write(|w| {
        w.set_cms(Cms::CENTER_ALIGNED1);
        w.set_arpe(true);
    });
    timer.psc().write_value(0);
    timer.arr().write(|w| w.set_arr(PWM_TOP));
    timer.rcr().write(|w| w.set_rep(REPETITIONS));
    for channel in 0..3 {
        timer.ccmr_output(channel / 2).modify(|w| {
            w.set_ocm(channel % 2, Ocm::PWM_MODE1);
            w.set_ocpe(channel % 2, true);
        });
        timer.ccr(channel).write(|w| w.set_ccr(0));
        timer.ccer().modify(|w| w.set_cce(channel, true));
    }
    // The update starts the converters. The outputs' idle level, which is in the same register, is low.
    timer.cr2().write(|w| w.set_mms2(Mms2::UPDATE));
    set_up_breaks();
    // Takes over what has been written; the repetition counter has to be in place before the timer first runs.
    timer.egr().write(|w| w.set_ug(true));
    timer.sr().write_value(SrAdv(0));
}

/// One write of BDTR: it locks itself, and all that shapes the outputs, against later ones but for the switch.
fn set_up_breaks() {
    let timer = pac::TIM1;
    timer.af1().write(|w| {
        w.set_bkine(true);
        w.set_bkinp(Bkinp::NOT_INVERTED);
    });
    timer.af2().write(|w| {
        w.set_bk2ine(true);
        w.set_bk2inp(Bkinp::NOT_INVERTED);
    });
    timer.bdtr().write(|w| {
        w.set_bke(0, true);
        w.set_bkp(0, Bkp::ACTIVE_LOW);
        w.set_bkf(0, BREAK_FILTER);
        w.set_bke(1, true);
        w.set_bkp(1, Bkp::ACTIVE_HIGH);
        w.set_bkf(1, BREAK_FILTER);
        w.set_ossi(Ossi::IDLE_LEVEL);
        w.set_ossr(Ossr::IDLE_LEVEL);
        w.set_aoe(false);
        w.set_moe(false);
        w.set_lock(Lock::LEVEL3);
    });
}

/// The breaks since the last call. A flag whose cause is still there cannot be cleared, and is reported again.
#[inline(always)]
fn take_breaks() -> SrAdv {
    let flags = pac::TIM1.sr().read();
    // Zeros clear flags and ones leave them alone: those that were not seen stay for the next call.
    let mut clear = SrAdv(u32::MAX);
    clear.set_bif(0, !flags.bif(0));
    clear.set_bif(1, !flags.bif(1));
    clear.set_sbif(!flags.sbif());
    pac::TIM1.sr().write_value(clear);
    flags
}

fn pulse(mut pin: Flex<'static>) -> Flex<'static> {
    let kind = AfType::output(OutputType::PushPull, Speed::Medium);
    pin.set_as_af_unchecked(CHANNEL_AF, kind);
    pin
}

fn pulled_up(mut pin: Flex<'static>) -> Flex<'static> {
    pin.set_as_input(Pull::Up);
    pin
}

fn break_input(mut pin: Flex<'static>, af: u8) -> Flex<'static> {
    pin.set_as_af_unchecked(af, AfType::input(Pull::Up));
    pin
}
