//! The firmware on a NUCLEO-G474RE: the control interrupt, and below it the tasks that serve the host, keep the settings
//! and look after the board.
//!
//! Wiring: `firmware/BOARD.md`.
//!
//! # Not shown
//!
//! This image runs on an emulated chip (`host-tools/stm32g474-emulator`), whose registers, clocks, pins and rules come from
//! the makers' descriptions and from the reference manual as this project reads it. What decides something is in the
//! library and tested there. Not shown to work are:
//!
//! - whatever is analogue: the converters' accuracy and noise, the crystal's start, levels at the pins, what a break's
//!   filter makes of real pulses;
//! - cycles: how long a tick takes with the flash's wait states and caches;
//! - CAN on a real bus: bit timing and delay compensation;
//! - that a debugger's halt switches the timer's outputs off at once; that it resets the chip of a driven leg is shown;
//! - what the write protection of the CCM makes of a write, which the MPU refuses before it;
//! - what RAM keeps over a real reset or a dip of the supply, and how a real flash behaves after a cut;
//! - whether a driver needs time between its enable and its first pulse;
//! - what the driver's fault line does while it sleeps and for 1 ms after its enable: the kit's driver has no enable but SLP.
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
mod memory_guard;
mod nucleo;
mod power;
mod priorities;
mod serial;
mod settings_task;
mod slow_sensors;
mod start;
mod supply_watch;
mod switches;
mod task_sections;
mod tick_watchdog;
mod watchdog;

use defmt_rtt as _;
use embassy_executor::Spawner;
use leg_firmware::board::ShortText;

defmt::timestamp!("{=u64:us}", embassy_time::Instant::now().as_micros());

#[embassy_executor::main]
async fn main(spawner: Spawner) {
    hot::load();
    let origin = fatal::origin();
    priorities::set();
    let Some(peripherals) = clocks::start() else {
        fatal::end(&ShortText::new("the crystal does not start"));
    };
    memory_guard::set();
    clocks::watch();
    supply_watch::start();
    start::start(spawner, peripherals, origin).await;
}
