//! The independent watchdog, which resets the chip unless it is fed; it is fed only while every task checks in.
//!
//! It runs from the chip's own slow oscillator of 32 kHz, which is anywhere from 29.5 to 34 kHz over temperature and
//! supply: the nominal 100 ms are 94 to 109 ms since it was last fed, a round before a task was found to be
//! missing, see [`leg_firmware::board::WatchedTask`]; the outputs are switched off as soon as it is.

use crate::check_ins::CHECK_INS;
use crate::{control, fatal, power};
use embassy_stm32::peripherals::IWDG;
use embassy_stm32::wdg::IndependentWatchdog;
use embassy_stm32::{Peri, pac};
use leg_firmware::board::{CheckIns, ShortText, TaskWatchdog, WatchedTask};

/// Nominal time from the last feeding to the reset, µs.
const TIMEOUT_US: u32 = 100_000;
const _: () = assert!(TIMEOUT_US as u64 > 5 * 1000 * CheckIns::PERIOD_MS);

/// At most 4 ms, in steps of 20 to 40 µs, for a round of the loop of `delay` takes two to four cycles: the oscillator starts within 130 µs, and five
/// of its periods follow.
const SETTLING_STEPS: u32 = 100;
const SETTLING_STEP_ROUNDS: u32 = leg_firmware::board::timing::CLOCK_HZ / 100_000;

/// The watchdog, and the count of missed tasks.
pub struct Watchdog {
    dog: IndependentWatchdog<'static, IWDG>,
    tasks: TaskWatchdog,
    resets: bool,
}

impl Watchdog {
    /// Starts it; nothing but a reset stops it. It rests while a debugger halts the processor.
    pub fn start(dog: Peri<'static, IWDG>) -> Self {
        pac::DBGMCU.apb1lfzr().modify(|w| w.set_iwdg(true));
        let mut dog = IndependentWatchdog::new(dog, TIMEOUT_US);
        dog.unleash();
        wait_for_settings();
        // Until it is fed for the first time it counts from its highest value.
        dog.pet();
        Self {
            dog,
            tasks: TaskWatchdog::default(),
            resets: false,
        }
    }

    /// Whether the reset is on its way.
    pub const fn resets(&self) -> bool {
        self.resets
    }

    /// Feeds the watchdog if no task is missing; to be called every [`CheckIns::PERIOD_MS`].
    pub fn round(&mut self) {
        match self.tasks.poll(&CHECK_INS) {
            None => self.dog.pet(),
            Some(_) if self.resets => {}
            Some(absent) => {
                self.resets = true;
                give_up(absent);
            }
        }
    }
}

/// Waits until the watchdog has taken its settings over, which it does in its own clock once it runs. A feeding before that
/// lets it count from its highest value again: 512 ms.
fn wait_for_settings() {
    for _ in 0..SETTLING_STEPS {
        let status = pac::IWDG.sr().read();
        if !status.pvu() && !status.rvu() && !status.wvu() {
            return;
        }
        cortex_m::asm::delay(SETTLING_STEP_ROUNDS);
    }
}

/// Switches off at once what the reset will switch off, and keeps the name of the task for the next start.
fn give_up(absent: WatchedTask) {
    control::cut();
    power::cut_outputs();
    fatal::keep(&ShortText::new(absent.name()).text(" did not check in"));
}
