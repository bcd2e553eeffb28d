//! Supply and temperature, which change slowly: ADC3, asked by a task between ticks.

use crate::converters::SIXTEEN;
use core::sync::atomic::{AtomicU16, Ordering};
use embassy_stm32::Peri;
use embassy_stm32::adc::{Adc, AdcConfig, Resolution, Rovsm, SampleTime, Trovs};
use embassy_stm32::peripherals::{ADC3, PB0, PB1};

static SUPPLY: AtomicU16 = AtomicU16::new(0);
static TEMPERATURE: AtomicU16 = AtomicU16::new(0);

/// The last supply voltage, as the sum of 16 conversions.
#[inline(always)]
pub fn supply_code() -> u16 {
    SUPPLY.load(Ordering::Relaxed)
}

/// The last temperature of the drivers, as the sum of 16 conversions.
#[inline(always)]
pub fn temperature_code() -> u16 {
    TEMPERATURE.load(Ordering::Relaxed)
}

/// ADC3 and its inputs.
pub struct SlowSensors {
    converter: Adc<'static, ADC3>,
    supply: Peri<'static, PB1>,
    temperature: Peri<'static, PB0>,
}

impl SlowSensors {
    /// Calibrates the converter and reads both inputs for the first time.
    pub fn new(
        converter: Peri<'static, ADC3>,
        supply: Peri<'static, PB1>,
        temperature: Peri<'static, PB0>,
    ) -> Self {
        let config = AdcConfig {
            resolution: Some(Resolution::BITS12),
            oversampling_ratio: Some(SIXTEEN),
            oversampling_shift: Some(0),
            oversampling_mode: Some((Rovsm::CONTINUED, Trovs::AUTOMATIC, true)),
            ..AdcConfig::default()
        };
        let mut sensors = Self {
            converter: Adc::new(converter, config),
            supply,
            temperature,
        };
        sensors.read();
        sensors
    }

    /// Reads both inputs, which takes 80 µs. A divider and a sensor's filter need the long sampling time.
    pub fn read(&mut self) {
        let time = SampleTime::CYCLES92_5;
        let supply = self.converter.blocking_read(&mut self.supply, time);
        SUPPLY.store(supply, Ordering::Relaxed);
        let temperature = self.converter.blocking_read(&mut self.temperature, time);
        TEMPERATURE.store(temperature, Ordering::Relaxed);
    }
}
