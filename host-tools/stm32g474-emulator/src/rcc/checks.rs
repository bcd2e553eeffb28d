//! What the clock tree forbids: the PLL's limits, a source that is switched off under its user, a clock that is not there.

use super::Rcc;
use super::rates::{
    FDCAN_FROM_HSE, FDCAN_FROM_PLL, PLL_FROM_HSE, PLL_FROM_HSI, SOURCE_HSE, SOURCE_HSI, SOURCE_PLL,
};
use crate::device::{Context, FieldPlace};

/// Limits of the PLL, Hz: datasheet of the STM32G474, PLL characteristics.
const PLL_INPUT_HZ: [u32; 2] = [2_660_000, 16_000_000];
const PLL_VCO_HZ: [u32; 2] = [96_000_000, 344_000_000];

impl Rcc {
    /// The PLL is switched on: its source and its rates.
    pub(super) fn check_pll(&self, context: &mut Context<'_>) {
        let within = |value, [low, high]: [u32; 2]| (low..=high).contains(&value);
        let (input, vco) = (self.pll_input_hz(), self.vco_hz());
        if !within(input, PLL_INPUT_HZ) {
            context.findings.add(format!(
                "RCC_PLLCFGR: the PLL's input is {input} Hz, outside of {PLL_INPUT_HZ:?}"
            ));
        }
        if !within(vco, PLL_VCO_HZ) {
            context.findings.add(format!(
                "RCC_PLLCFGR: the PLL's oscillator is at {vco} Hz, outside of {PLL_VCO_HZ:?}"
            ));
        }
        let ready = match self.registers.value(self.fields.pll_source) {
            PLL_FROM_HSI => self.hsi.ready(context.cycle),
            PLL_FROM_HSE => self.hse.ready(context.cycle),
            _ => true,
        };
        if !ready {
            let text = "RCC_CR: PLLON is set while the PLL's source is not ready";
            context.findings.add(text);
        }
    }

    /// What the processor's clock depends on, directly or through the PLL, has to stay on; and the crystal's bypass must not
    /// change under it. As ST's description says at the fields.
    pub(super) fn check_oscillators(&self, value: u32, context: &mut Context<'_>) {
        let fields = self.fields;
        let on = |field: FieldPlace| field.extract(value) != 0;
        let source = self.source(context.cycle);
        let of_pll = self.registers.value(fields.pll_source);
        let pll_stays = self.pll.is_on() && on(fields.pll_on);
        let chip = |used: bool| used.then_some("the chip runs from it");
        let pll = |used: bool| (used && pll_stays).then_some("the PLL runs from it");
        let switches = [
            (chip(source == SOURCE_HSI), fields.hsi_on, "HSI"),
            (pll(of_pll == PLL_FROM_HSI), fields.hsi_on, "HSI"),
            (chip(source == SOURCE_HSE), fields.hse_on, "HSE"),
            (pll(of_pll == PLL_FROM_HSE), fields.hse_on, "HSE"),
            (chip(source == SOURCE_PLL), fields.pll_on, "PLL"),
        ];
        for (used, field, name) in switches {
            if let Some(how) = used.filter(|_| !on(field)) {
                let text = format!("RCC_CR: {name} is switched off while {how}");
                context.findings.add(text);
            }
        }
        if self.hse.is_on() && on(fields.hse_bypass) != self.registers.is_set(fields.hse_bypass) {
            let text = "RCC_CR: HSEBYP is changed while HSE is on";
            context.findings.add(text);
        }
    }

    /// FDCAN needs the clock that it is given: HSE may be off, and PLL Q is not modelled.
    pub(super) fn check_fdcan(&self, context: &mut Context<'_>) {
        let fields = &self.fields;
        let text = match self.registers.value(fields.fdcan) {
            FDCAN_FROM_HSE if !self.hse.is_on() => {
                "RCC_CCIPR: FDCANSEL gives FDCAN HSE, which is off"
            }
            FDCAN_FROM_PLL => "RCC_CCIPR: FDCANSEL gives FDCAN PLL Q, which is not modelled",
            _ => return,
        };
        if self.registers.is_set(fields.fdcan_on) {
            context.findings.add(text);
        }
    }
}
