//! Supply, temperature, and the chip's own voltage: ADC3, started by TIM1's update with the others.
//!
//! In step with them it disturbs none of their conversions in a way that changes from tick to tick, and it never rests for more
//! than a millisecond, after which a conversion may be wrong (both by ST's errata ES0430). The chip's own voltage has to be
//! sampled for 4 µs; so eight conversions make a code here, and it is doubled.

use crate::converters::{analogue, calibrate, clear, codes, convert_once, wait_for_timer};
use embassy_stm32::Peri;
use embassy_stm32::gpio::Flex;
use embassy_stm32::pac;
use embassy_stm32::pac::adc::vals::SampleTime;
use embassy_stm32::peripherals::{ADC3, PB0, PB1};
use leg_firmware::board::checked_supply;

/// Inputs of ADC3 on PB1 and PB0, and the chip's own voltage.
const INPUTS: [(u8, SampleTime); 3] = [
    (1, SampleTime::CYCLES47_5),
    (12, SampleTime::CYCLES47_5),
    (18, SampleTime::CYCLES247_5),
];

/// 8 conversions make a code.
const EIGHT: u8 = 2;

/// The codes of a tick, as if 16 conversions made one.
pub struct SlowCodes {
    /// Motor supply; at an end of its range where the converters' reference is out of its own.
    pub supply: u16,
    /// Temperature of the drivers.
    pub temperature: u16,
    /// Whether something was converted since the last call.
    pub fresh: bool,
}

/// ADC3, waiting for the timer.
pub struct SlowSensors {
    _pins: [Flex<'static>; 2],
}

impl SlowSensors {
    /// Calibrates the converter and lets it wait for TIM1, which must not run yet.
    pub fn new(
        converter: Peri<'static, ADC3>,
        supply: Peri<'static, PB1>,
        temperature: Peri<'static, PB0>,
    ) -> Self {
        let pins = [
            analogue(Flex::new(supply)),
            analogue(Flex::new(temperature)),
        ];
        calibrate(converter, EIGHT);
        pac::ADC345_COMMON.ccr().modify(|w| w.set_vrefen(true));
        // It is there within 12 µs, and supply and temperature take 23. In the first tick its code is of then.
        convert_once(pac::ADC3, INPUTS);
        wait_for_timer(pac::ADC3, INPUTS, false);
        Self { _pins: pins }
    }

    /// Takes the codes. Supply and temperature are of this tick; the chip's own voltage, which comes last, may be of the one
    /// before.
    #[inline(always)]
    pub fn take(&self) -> SlowCodes {
        let flags = pac::ADC3.isr().read();
        let [supply, temperature, reference] = codes(pac::ADC3).map(|code| code << 1);
        clear(pac::ADC3);
        SlowCodes {
            supply: checked_supply(supply, reference),
            temperature,
            fresh: flags.jeoc(),
        }
    }
}
