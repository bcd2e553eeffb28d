//! Programs that hang: the watchdog resets the chip in time, and the next start says so.

use super::runs::moving;
use super::{Mistake, mistakes};
use crate::common::chip::{MS, findings, identity_after, reset_within, started_with};
use std::error::Error;
use std::path::Path;
use stm32g474_emulator::board::Board;

const CONTROL: &str = "firmware/stm32g474/src/control.rs";
const TICK_WATCHDOG: &str = "firmware/stm32g474/src/tick_watchdog.rs";

/// When the program hangs, ms after its start.
const HANG_MS: u64 = 150;

/// The longest from a hang to the reset: 109 ms of the watchdog, 60 ms to miss a task, and the start.
const RESET_MS: u64 = 180;

/// What happens to a program that makes an access that is forbidden.
pub fn failing(image: &Path) -> String {
    told(image, HANG_MS + 20)
}

/// The longest from a hang of the control tick to the reset.
const HUNG_TICK_MS: u64 = 2;

/// What happens to a program whose control tick hangs later, or comes no more.
fn hanging_tick(image: &Path) -> String {
    // A task that is to stop the tick may be waiting for its next round of 10 ms.
    told(image, HANG_MS + 10 + HUNG_TICK_MS)
}

/// What happens to a program that hangs later.
fn hanging(image: &Path) -> String {
    told(image, HANG_MS + RESET_MS)
}

/// What happens to a program that never feeds the watchdog.
fn unfed(image: &Path) -> String {
    told(image, 125)
}

fn told(image: &Path, within_ms: u64) -> String {
    reset_report(image, within_ms).unwrap_or_else(|error| error.to_string())
}

/// Which reset comes in time, and what the chip says of it afterwards.
fn reset_report(image: &Path, within_ms: u64) -> Result<String, Box<dyn Error>> {
    let mut session = started_with(image, Board::default(), 10)?;
    let chip = session.chip().ok_or("no chip")?;
    let left = (within_ms * MS).saturating_sub(chip.cycle());
    let Some(cause) = reset_within(chip, left) else {
        return Ok(format!("no reset within {within_ms} ms"));
    };
    let identity = identity_after(chip)?;
    let words = identity.crash_report;
    let found = findings(chip);
    Ok(format!(
        "{cause:?}, {:?}, `{words}`, findings: {found:?}",
        identity.reset
    ))
}

mistakes! {
    watchdog_not_fed: Mistake {
        file: "firmware/stm32g474/src/watchdog.rs",
        right: "None => self.dog.pet(),",
        wrong: "None => {}",
        run: unfed,
        report: "IndependentWatchdog, Watchdog, ``, findings: []",
    };
    tick_that_hangs: Mistake {
        file: CONTROL,
        right: "    let started = DWT::cycle_count();\n",
        wrong: "    let started = DWT::cycle_count();
    if embassy_time::Instant::now().as_millis() > 150 {
        loop {}
    }\n",
        run: hanging_tick,
        report: "WindowWatchdog, HungTick, ``, findings: []",
    };
    task_that_masks_interrupts_and_hangs: Mistake {
        file: "firmware/stm32g474/src/link.rs",
        right: "        self.alive();\n        self.link",
        wrong: "        if embassy_time::Instant::now().as_millis() > 150 {
            cortex_m::interrupt::disable();
            loop {}
        }
        self.alive();\n        self.link",
        run: hanging_tick,
        report: "WindowWatchdog, HungTick, ``, findings: []",
    };
    task_that_waits_for_ever: Mistake {
        file: "firmware/stm32g474/src/serial.rs",
        right: "        session.turn();\n",
        wrong: "        if embassy_time::Instant::now().as_millis() > 150 {
            core::future::pending::<()>().await;
        }
        session.turn();\n",
        run: hanging,
        report: "IndependentWatchdog, Watchdog, `the link task did not check in`, findings: []",
    };
    control_interrupt_that_stops: Mistake {
        file: "firmware/stm32g474/src/housekeeping.rs",
        right: "        watchdog.round();\n",
        wrong: "        if embassy_time::Instant::now().as_millis() > 150 {
            cortex_m::peripheral::NVIC::mask(embassy_stm32::interrupt::ADC1_2);
        }
        watchdog.round();\n",
        run: hanging_tick,
        report: "WindowWatchdog, HungTick, ``, findings: []",
    };
    window_watchdog_not_started: Mistake {
        file: TICK_WATCHDOG,
        right: "REFRESH: u32 = 0x80 | 0x7f;",
        wrong: "REFRESH: u32 = 0x7f;",
        run: moving,
        report: "the window watchdog WWDG was not started",
    };
    window_watchdog_refreshed_by_a_task: Mistake {
        file: "firmware/stm32g474/src/link.rs",
        right: "        self.alive();\n        self.link",
        wrong: "        crate::tick_watchdog::refresh();\n        self.alive();\n        self.link",
        run: moving,
        report: "WWDG is refreshed by a task while the pulses are on",
    };
    window_watchdog_not_refreshed: Mistake {
        file: CONTROL,
        right: "        tick_watchdog::refresh();\n",
        wrong: "",
        run: moving,
        report: "was reset (WindowWatchdog)",
    };
    window_watchdog_too_slow: Mistake {
        file: TICK_WATCHDOG,
        right: "    refresh();\n}\n\n/// The duties",
        wrong: "    pac::WWDG.cfr().modify(|w| w.set_wdgtb(pac::wwdg::vals::Wdgtb::DIV2));
    refresh();\n}\n\n/// The duties",
        run: moving,
        report: "the window watchdog's time may come to 3084 µs, and must not exceed 2000",
    };
    window_watchdog_with_a_closed_window: Mistake {
        file: TICK_WATCHDOG,
        right: "    refresh();\n}\n\n/// The duties",
        wrong: "    pac::WWDG.cfr().modify(|w| w.set_w(0x60));
    refresh();\n}\n\n/// The duties",
        run: moving,
        report: "the watchdog is refreshed before its window opens",
    };
}
