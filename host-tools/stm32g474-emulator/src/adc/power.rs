//! A converter's way to its first conversion: power, regulator, calibration, enable.

use super::converter::{Converter, Surroundings};
use crate::device::Context;

/// The regulator's start, µs: the datasheet's `tADCVREG_STUP`, as in ST's `stm32g4xx_ll_adc.h`.
const REGULATOR_START_US: u64 = 20;
/// Half periods that a calibration takes: the datasheet's `tCAL`, 112 periods in ST's `stm32g4xx_ll_adc.h`.
const CALIBRATION: u64 = 2 * 112;
/// Half periods after a calibration in which `ADEN` cannot be set: 4 periods, `LL_ADC_DELAY_CALIB_ENABLE_ADC_CYCLES`.
const AFTER_CALIBRATION: u64 = 2 * 4;
/// Half periods from `ADEN` to `ADRDY`: the datasheet's `tSTAB`, one conversion, as in ST's `stm32g4xx_ll_adc.h`.
const STABILISATION: u64 = 2 * 15;

impl Converter {
    /// Deep power-down and regulator.
    pub(super) fn power(&mut self, deep: bool, regulator: bool, context: &mut Context<'_>) {
        let places = &self.places;
        let (was_deep, was_on) = (self.is(places.deep_power_down), self.is(places.regulator));
        if (deep, regulator) == (was_deep, was_on) {
            return;
        }
        if self.is_enabled() {
            self.report(
                context,
                "_CR: DEEPPWD or ADVREGEN is changed while the converter is switched on",
            );
        }
        if deep && regulator {
            self.report(context, "_CR: ADVREGEN is set in deep power-down");
        }
        let (deep_place, regulator_place) = (places.deep_power_down, places.regulator);
        self.file.set_value(deep_place, u32::from(deep));
        self.file.set_value(regulator_place, u32::from(regulator));
        if deep {
            self.power_down();
        }
        let runs = regulator && !deep;
        let since = self.regulator.filter(|_| was_on && !was_deep);
        self.regulator = runs.then(|| since.unwrap_or(context.cycle));
    }

    /// Deep power-down: the calibration is lost.
    pub(super) fn power_down(&mut self) {
        self.calibration = None;
        self.calibrated_at = None;
        self.calibrated = [false; 2];
        self.ready = None;
        self.runs = [None; 2];
    }

    /// The regulator has to be up before anything is asked of the converter.
    fn check_regulator(&self, what: &str, context: &mut Context<'_>) {
        let hclk = u64::from(context.clocks.hclk);
        let start = (hclk * REGULATOR_START_US).div_ceil(1_000_000);
        match self.regulator {
            None => self.report(
                context,
                &format!("_CR: {what} is set without the regulator"),
            ),
            Some(since) if context.cycle < since + start => {
                let text = format!(
                    "_CR: {what} is set before the regulator has had its {REGULATOR_START_US} µs"
                );
                self.report(context, &text);
            }
            Some(_) => {}
        }
    }

    pub(super) fn calibrate(&mut self, around: &Surroundings<'_>, context: &mut Context<'_>) {
        self.check_regulator("ADCAL", context);
        self.check_clock(around, context);
        if self.is(self.places.enabled) {
            return self.report(context, "_CR: ADCAL is set while ADEN is set");
        }
        let cycles = around.clock.cycles(CALIBRATION);
        self.calibration = Some(cycles.map_or(u64::MAX, |cycles| context.cycle + cycles));
        self.file.set_value(self.places.calibrate, 1);
    }

    pub(super) fn enable(&mut self, around: &Surroundings<'_>, context: &mut Context<'_>) {
        self.check_regulator("ADEN", context);
        self.check_clock(around, context);
        if self.is(self.places.calibrate) {
            return self.report(context, "_CR: ADEN is set while ADCAL is set");
        }
        let wait = around.clock.cycles(AFTER_CALIBRATION).unwrap_or_default();
        if self
            .calibrated_at
            .is_some_and(|end| context.cycle < end + wait)
        {
            return self.report(
                context,
                "_CR: ADEN is set within 4 converter periods after the calibration, and stays clear",
            );
        }
        self.file.set_value(self.places.enabled, 1);
        let cycles = around.clock.cycles(STABILISATION);
        self.ready = Some(cycles.map_or(u64::MAX, |cycles| context.cycle + cycles));
    }

    pub(super) fn disable(&mut self, context: &mut Context<'_>) {
        let busy = self.busy();
        if !self.is(self.places.enabled) {
            return self.report(context, "_CR: ADDIS is set while ADEN is clear");
        }
        if busy.regular || busy.injected {
            return self.report(context, "_CR: ADDIS is set during conversions");
        }
        self.file.set_value(self.places.enabled, 0);
        self.ready = None;
    }
}
