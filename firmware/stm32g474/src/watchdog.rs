//! The independent watchdog, which resets the chip unless it is fed; and it is fed only while everybody checks in.
//!
//! It runs from the chip's own slow oscillator of 32 kHz, which is anywhere from 29.5 to 34 kHz over temperature and
//! supply: the nominal 100 ms are 94 to 109 ms since the last food, which was a round before a member was found to be
//! missed, see [`leg_firmware::board::Member`]; the outputs are switched off as soon as it is.

use crate::{control, fatal, power};
use embassy_stm32::peripherals::IWDG;
use embassy_stm32::wdg::IndependentWatchdog;
use embassy_stm32::{Peri, pac};
use leg_firmware::board::{Member, RollCall, Rounds, Words};

/// Nominal time without food until the reset, µs.
const TIMEOUT_US: u32 = 100_000;
const _: () = assert!(TIMEOUT_US as u64 > 5 * 1000 * RollCall::ROUND_MS);

/// Who has checked in.
pub static ROLL: RollCall = RollCall::new();

/// The watchdog and who is missed.
pub struct Watchdog {
    dog: IndependentWatchdog<'static, IWDG>,
    rounds: Rounds,
    bites: bool,
}

impl Watchdog {
    /// Starts it; nothing but a reset stops it. It rests while a debugger halts the processor.
    pub fn start(dog: Peri<'static, IWDG>) -> Self {
        pac::DBGMCU.apb1lfzr().modify(|w| w.set_iwdg(true));
        let mut dog = IndependentWatchdog::new(dog, TIMEOUT_US);
        dog.unleash();
        // Until it is fed for the first time it counts from its highest value.
        dog.pet();
        Self {
            dog,
            rounds: Rounds::default(),
            bites: false,
        }
    }

    /// Whether the reset is on its way.
    pub const fn bites(&self) -> bool {
        self.bites
    }

    /// Calls the roll, and feeds the watchdog if nobody is missed; to be called every [`RollCall::ROUND_MS`].
    pub fn round(&mut self) {
        match self.rounds.call(&ROLL) {
            None => self.dog.pet(),
            Some(_) if self.bites => {}
            Some(absent) => {
                self.bites = true;
                give_up(absent);
            }
        }
    }
}

/// Switches off at once what the reset will switch off, and leaves word of who is missed.
fn give_up(absent: Member) {
    control::cut();
    power::off();
    fatal::keep(&Words::new(absent.name()).text(" did not check in"));
}
