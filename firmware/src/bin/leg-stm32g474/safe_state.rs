//! Pins that keep the motors off.

use embassy_stm32::Peri;
use embassy_stm32::gpio::{Level, Output, Speed};
use embassy_stm32::peripherals::{PA8, PA9, PA10, PC9};

/// Driver enable and PWM, all low for as long as this lives. The screws hold the leg without power.
pub struct SafeState {
    _pins: [Output<'static>; 4],
}

impl SafeState {
    /// Disables the drivers first, then pulls the PWM pins, which float at reset.
    pub fn new(
        enable: Peri<'static, PC9>,
        pwm_1: Peri<'static, PA8>,
        pwm_2: Peri<'static, PA9>,
        pwm_3: Peri<'static, PA10>,
    ) -> Self {
        Self {
            _pins: [
                Output::new(enable, Level::Low, Speed::Low),
                Output::new(pwm_1, Level::Low, Speed::Low),
                Output::new(pwm_2, Level::Low, Speed::Low),
                Output::new(pwm_3, Level::Low, Speed::Low),
            ],
        }
    }
}
