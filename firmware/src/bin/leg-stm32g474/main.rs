//! The firmware on a NUCLEO-G474RE: the control interrupt, and below it the tasks that serve the host, keep the settings
//! and look after the board.
//!
//! # Wiring
//!
//! | pins                | what                                                                              |
//! |---------------------|-----------------------------------------------------------------------------------|
//! | PA8 PA9 PA10        | pulses of motors 1 to 3, 40 kHz, high is on; pull each down at the driver          |
//! | PC6 PC7 PC8         | their directions, high pulls the tendon in                                         |
//! | PC9                 | enables the drivers, high; pull it down at the drivers                             |
//! | PB2 PB11 PB15       | fault lines of drivers 1 to 3, low when raised; pulled up here                     |
//! | PB10                | the three together (a diode from each), low when raised: break 1                   |
//! | PC3                 | emergency stop, a contact to ground that opens: break 2; it has to be there        |
//! | PA0 PA1             | encoder 1, tracks A and B; up to 3.3 V, pulled up here                             |
//! | PB4 PB5             | encoder 2                                                                          |
//! | PB6 PB7             | encoder 3                                                                          |
//! | PC0 PC1 PC2         | load cells 1 to 3, 0 to 3.3 V, more is more tension                                |
//! | PA4 PA6 PA7         | currents of motors 1 to 3, 0 to 3.3 V, half of it is none, more pulls in           |
//! | PB1                 | supply by a divider                                                                |
//! | PB0                 | temperature of the drivers, more is warmer, in a straight line                     |
//! | PA2 PA3             | serial line of the on-board debugger, 921 600 baud                                 |
//! | PB12 PB13           | CAN FD, receive and transmit, 1 and 5 Mbit/s                                       |
//! | PC10 PC11 PC12      | address switches 1, 2, 4 to ground: 1 to 6 is a leg on the bus, else the serial line |
//! | PA5                 | lamp on the board: see [`leg_firmware::board::lit`]                                |
//! | PC13                | button on the board, not used                                                      |
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
    priorities::set();
    start::start(spawner, peripherals, origin).await;
}
