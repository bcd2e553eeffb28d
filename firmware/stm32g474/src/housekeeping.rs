//! What has to be looked after now and then: the watchdog, errors of the encoders, the LED.

use crate::cycles::CycleCounter;
use crate::encoders::Encoders;
use crate::watchdog::Watchdog;
use crate::{control, fatal};
use embassy_stm32::gpio::Output;
use embassy_time::{Duration, Ticker};
use leg_firmware::board::{BLINK_STEP_MS, CheckIns, led_on};
use leg_firmware::supervisor::State;

/// Rounds in a step of the LED.
const ROUNDS_PER_STEP: u32 = (BLINK_STEP_MS / CheckIns::PERIOD_MS) as u32;

/// Steps after which the firmware counts as running well: 1 s.
const SETTLED: u32 = 10;

/// Steps from one line in the log to the next.
const LOG_STEPS: u32 = 50;

/// Does it for ever.
#[embassy_executor::task]
pub async fn keep_house(
    mut watchdog: Watchdog,
    mut cycles: CycleCounter,
    mut led: Output<'static>,
) {
    let mut ticker = Ticker::every(Duration::from_millis(CheckIns::PERIOD_MS));
    let mut rounds: u32 = 0;
    loop {
        ticker.next().await;
        // After a stall or a debugger's halt no rounds are made up for: two within a tick would miss the control interrupt.
        ticker.reset();
        cycles.keep_running();
        watchdog.round();
        if rounds.is_multiple_of(ROUNDS_PER_STEP) {
            report_errors();
            let step = rounds / ROUNDS_PER_STEP;
            show(step, &mut led);
            if step == SETTLED && !watchdog.resets() {
                fatal::settle();
            }
        }
        rounds = rounds.wrapping_add(1);
    }
}

/// Errors of the encoders' signals are reported, and nothing else: what they add up to is found by the supervisor, which compares
/// encoders with load cells.
fn report_errors() {
    for (motor, error) in (1_u8..).zip(Encoders::take_errors()) {
        if error {
            defmt::warn!("encoder {=u8}: both tracks changed at once", motor);
        }
    }
}

/// A step of the LED, and now and then a line in the log.
fn show(step: u32, led: &mut Output<'static>) {
    let (state, faulted) = match control::condition() {
        Some((state, faults)) => (state, faults.any()),
        None => (State::Boot, false),
    };
    led.set_level(led_on(state, faulted, step).into());
    if step.is_multiple_of(LOG_STEPS) {
        defmt::info!("longest tick: {=u32} cycles", control::longest_tick());
    }
}
