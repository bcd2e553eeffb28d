//! The fields of RCC that the emulated chip looks at.

use crate::device::places;

places! {
    /// Fields by their makers' names.
    #[derive(Clone, Copy, Debug)]
    pub struct RccFields {
        hsi_on: CR.HSION,
        hsi_ready: CR.HSIRDY,
        hse_on: CR.HSEON,
        hse_ready: CR.HSERDY,
        hse_bypass: CR.HSEBYP,
        css_on: CR.CSSON,
        pll_on: CR.PLLON,
        pll_ready: CR.PLLRDY,
        source: CFGR.SW,
        source_status: CFGR.SWS,
        ahb: CFGR.HPRE,
        apb1: CFGR.PPRE1,
        apb2: CFGR.PPRE2,
        pll_source: PLLCFGR.PLLSRC,
        pll_divider: PLLCFGR.PLLM,
        pll_factor: PLLCFGR.PLLN,
        pll_r_on: PLLCFGR.PLLREN,
        pll_r: PLLCFGR.PLLR,
        css_flag: CIFR.CSSF,
        css_clear: CICR.CSSC,
        hsi48_on: CRRCR.HSI48ON,
        hsi48_ready: CRRCR.HSI48RDY,
        lsi_on: CSR.LSION,
        lsi_ready: CSR.LSIRDY,
        remove_flags: CSR.RMVF,
        adc12: CCIPR.ADC12SEL,
        adc345: CCIPR.ADC345SEL,
        lpuart1: CCIPR.LPUART1SEL,
        fdcan: CCIPR.FDCANSEL,
        fdcan_on: APB1ENR1.FDCANEN,
    }
}
