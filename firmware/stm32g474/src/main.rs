//! The firmware on a NUCLEO-G474RE: the control interrupt, and below it the tasks that serve the host, keep the settings
//! and look after the board.
//!
//! Wiring: `firmware/BOARD.md`.
//!
//! # Not shown
//!
//! No test runs this image, for no emulator has the chip. What decides something is in the library and tested there;
//! what is here are registers, written by the reference manual and by nothing else. Not shown to work are: the clocks;
//! that the update falls where the timer is at zero, and that it starts the converters; that a code is the sum of 16
//! conversions and comes in the time that `leg_firmware::board::timing` says; the breaks, their polarity and their
//! filters, and that a debugger's halt switches the outputs off; direction and scale of encoders and currents; how long
//! a tick takes; flash, its ECC and its NMI; what RAM keeps over which reset; the watchdog and its oscillator; both
//! transports, bit timing and delay compensation above all; whether a driver needs time between its enable and its
//! first pulse.
#![no_std]
#![no_main]

mod can_bus;
mod check_ins;
mod clocks;
mod control;
mod converters;
mod cycles;
mod encoders;
mod fatal;
mod flash;
mod hot;
mod housekeeping;
mod link;
mod nucleo;
mod power;
mod priorities;
mod serial;
mod settings_task;
mod slow_sensors;
mod start;
mod switches;
mod watchdog;

use defmt_rtt as _;
use embassy_executor::Spawner;

defmt::timestamp!("{=u64:us}", embassy_time::Instant::now().as_micros());

#[embassy_executor::main]
async fn main(spawner: Spawner) {
    hot::load();
    let origin = fatal::origin();
    let peripherals = embassy_stm32::init(clocks::config());
    clocks::watch();
    priorities::set();
    start::start(spawner, peripherals, origin).await;
}
