//! The fields of RCC that the emulated chip looks at.

use crate::device::{FieldPlace, RegisterFile};

/// Fields by their makers' names.
#[derive(Clone, Copy, Debug)]
pub struct Fields {
    pub hsi_on: FieldPlace,
    pub hsi_ready: FieldPlace,
    pub hse_on: FieldPlace,
    pub hse_ready: FieldPlace,
    pub css_on: FieldPlace,
    pub pll_on: FieldPlace,
    pub pll_ready: FieldPlace,
    pub source: FieldPlace,
    pub source_status: FieldPlace,
    pub ahb: FieldPlace,
    pub apb1: FieldPlace,
    pub apb2: FieldPlace,
    pub pll_source: FieldPlace,
    pub pll_divider: FieldPlace,
    pub pll_factor: FieldPlace,
    pub pll_r_on: FieldPlace,
    pub pll_r: FieldPlace,
    pub css_flag: FieldPlace,
    pub css_clear: FieldPlace,
    pub hsi48_on: FieldPlace,
    pub hsi48_ready: FieldPlace,
    pub lsi_on: FieldPlace,
    pub lsi_ready: FieldPlace,
    pub remove_flags: FieldPlace,
    pub adc12: FieldPlace,
    pub adc345: FieldPlace,
    pub lpuart1: FieldPlace,
    pub fdcan: FieldPlace,
    pub fdcan_on: FieldPlace,
}

impl Fields {
    /// Looks them up.
    pub fn new(registers: &RegisterFile) -> Self {
        let field = |register, name| registers.field(register, name);
        Self {
            hsi_on: field("CR", "HSION"),
            hsi_ready: field("CR", "HSIRDY"),
            hse_on: field("CR", "HSEON"),
            hse_ready: field("CR", "HSERDY"),
            css_on: field("CR", "CSSON"),
            pll_on: field("CR", "PLLON"),
            pll_ready: field("CR", "PLLRDY"),
            source: field("CFGR", "SW"),
            source_status: field("CFGR", "SWS"),
            ahb: field("CFGR", "HPRE"),
            apb1: field("CFGR", "PPRE1"),
            apb2: field("CFGR", "PPRE2"),
            pll_source: field("PLLCFGR", "PLLSRC"),
            pll_divider: field("PLLCFGR", "PLLM"),
            pll_factor: field("PLLCFGR", "PLLN"),
            pll_r_on: field("PLLCFGR", "PLLREN"),
            pll_r: field("PLLCFGR", "PLLR"),
            css_flag: field("CIFR", "CSSF"),
            css_clear: field("CICR", "CSSC"),
            hsi48_on: field("CRRCR", "HSI48ON"),
            hsi48_ready: field("CRRCR", "HSI48RDY"),
            lsi_on: field("CSR", "LSION"),
            lsi_ready: field("CSR", "LSIRDY"),
            remove_flags: field("CSR", "RMVF"),
            adc12: field("CCIPR", "ADC12SEL"),
            adc345: field("CCIPR", "ADC345SEL"),
            lpuart1: field("CCIPR", "LPUART1SEL"),
            fdcan: field("CCIPR", "FDCANSEL"),
            fdcan_on: field("APB1ENR1", "FDCANEN"),
        }
    }
}
