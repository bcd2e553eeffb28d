//! The firmware on a NUCLEO-G474RE: answers a host over the board's USB serial port.
//!
//! It computes, but drives no motor yet: the drivers stay disabled and the PWM pins low from the first instruction
//! after the clocks on. No test runs this image (no emulator has the chip): clocks, pins, the serial line and the
//! heartbeat are not shown to work.
#![no_std]
#![no_main]

mod clocks;
mod link;
mod safe_state;

use defmt_rtt as _;
use embassy_executor::Spawner;
use embassy_stm32::gpio::{Level, Output, Speed};
use embassy_time::Timer;
use panic_probe as _;
use safe_state::SafeState;

#[embassy_executor::main]
async fn main(spawner: Spawner) {
    let p = embassy_stm32::init(clocks::config());
    let _held = SafeState::new(p.PC9, p.PA8, p.PA9, p.PA10);
    match heartbeat(Output::new(p.PA5, Level::Low, Speed::Low)) {
        Ok(task) => spawner.spawn(task),
        Err(_) => defmt::error!("no room for the heartbeat"),
    }
    match link::open(p.LPUART1, p.PA3, p.PA2) {
        Ok(uart) => link::serve(uart).await,
        Err(_) => defmt::error!("the serial line refuses its settings"),
    }
}

/// Blinks the board's LED once a second for as long as tasks run.
#[embassy_executor::task]
async fn heartbeat(mut led: Output<'static>) {
    loop {
        led.toggle();
        Timer::after_millis(500).await;
    }
}
