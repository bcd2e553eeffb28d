//! Clocks, voltage and wait states.

use super::runs::moving;
use super::{Mistake, mistakes};

const CLOCKS: &str = "firmware/stm32g474/src/clocks.rs";

const fn clocks(right: &'static str, wrong: &'static str, report: &'static str) -> Mistake {
    Mistake::new(CLOCKS, right, wrong, moving, report)
}

mistakes! {
    pll_multiplies_wrongly: clocks(
        "PllMul::MUL85",
        "PllMul::MUL80",
        "the processor's clock, Hz, is 160000000",
    );
    boost_omitted: clocks(
        "    pac::PWR.cr5().modify(|w| w.0 &= !R1MODE);\n",
        "",
        "the processor runs at 170000000 Hz in range 1 normal, whose limit is 150000000 Hz",
    );
    wait_states_too_few: clocks(
        "    rcc::reinit(config(), &mut peripherals.RCC);\n",
        "    rcc::reinit(config(), &mut peripherals.RCC);
    pac::FLASH.acr().modify(|w| w.set_latency(pac::flash::vals::Latency::WS2));\n",
        "the flash has 2 wait states at 170000000 Hz in range 1 boost, and needs 4",
    );
}
