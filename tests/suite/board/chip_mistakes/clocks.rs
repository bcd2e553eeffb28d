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
        "Latency::WS4",
        "Latency::WS2",
        "the flash has 2 wait states at 170000000 Hz in range 1 boost, and needs 4",
    );
    full_clock_in_one_step: clocks(
        "AHBPrescaler::DIV2",
        "AHBPrescaler::DIV1",
        "to 170000000 Hz without 1 µs at half of that",
    );
    task_timer_counts_twice_as_fast: clocks(
        "    timer.psc().write_value(TASK_TIMER_DIVISOR - 1);\n",
        "",
        "TIM15's rate, counts a second, is 2000000",
    );
    serial_line_runs_from_the_bus: clocks(
        "    config.mux.lpuart1sel = Uartsel::SYS;\n",
        "",
        "baud",
    );
}
