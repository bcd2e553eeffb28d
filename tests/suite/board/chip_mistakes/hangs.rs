//! Programs that hang: the watchdog resets the chip in time, and the next start says so.

use super::{Mistake, mistakes};
use crate::common::chip::{MS, findings, identity_after, reset_within, started_with};
use std::error::Error;
use std::path::Path;
use stm32g474_emulator::board::Board;

const CONTROL: &str = "firmware/stm32g474/src/control.rs";

/// When the program hangs, ms after its start.
const HANG_MS: u64 = 150;

/// The longest from a hang to the reset: 109 ms of the watchdog, 60 ms to miss a task, and the start.
const RESET_MS: u64 = 180;

/// What happens to a program that hangs later.
fn hanging(image: &Path) -> String {
    told(image, HANG_MS + RESET_MS)
}

/// What happens to a program that never feeds the watchdog.
fn unfed(image: &Path) -> String {
    told(image, 125)
}

fn told(image: &Path, within_ms: u64) -> String {
    after_reset(image, within_ms).unwrap_or_else(|error| error.to_string())
}

/// Which reset comes in time, and what the chip says of it afterwards.
fn after_reset(image: &Path, within_ms: u64) -> Result<String, Box<dyn Error>> {
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
        run: hanging,
        report: "IndependentWatchdog, Watchdog, ``, findings: []",
    };
    task_that_masks_interrupts_and_hangs: Mistake {
        file: "firmware/stm32g474/src/link.rs",
        right: "        self.alive();\n        self.link",
        wrong: "        if embassy_time::Instant::now().as_millis() > 150 {
            cortex_m::interrupt::disable();
            loop {}
        }
        self.alive();\n        self.link",
        run: hanging,
        report: "IndependentWatchdog, Watchdog, ``, findings: []",
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
        run: hanging,
        report: "IndependentWatchdog, Watchdog, `the control interrupt did not check in`, findings: []",
    };
}
