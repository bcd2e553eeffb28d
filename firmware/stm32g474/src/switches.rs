//! The address switches: PC10, PC11 and PC12 against ground.

use embassy_stm32::Peri;
use embassy_stm32::gpio::{Input, Pull};
use embassy_stm32::peripherals::{PC10, PC11, PC12};
use leg_firmware::board::LinkChoice;

/// What the switches choose now; open ones, and pins without one, count as zeros.
pub fn read(
    one: Peri<'static, PC10>,
    two: Peri<'static, PC11>,
    four: Peri<'static, PC12>,
) -> LinkChoice {
    let pins = [
        Input::new(one, Pull::Up),
        Input::new(two, Pull::Up),
        Input::new(four, Pull::Up),
    ];
    // The pull-ups charge pins and wires in well under this time.
    cortex_m::asm::delay(SETTLING_CYCLES);
    LinkChoice::from_switches(pins.map(|pin| pin.is_low()))
}

/// 100 µs.
const SETTLING_CYCLES: u32 = leg_firmware::board::timing::CLOCK_HZ / 10_000;
