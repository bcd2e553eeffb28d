//! The power stage: TIM1, its pins and its breaks.

use super::runs::moving;
use super::{Mistake, mistakes};

const POWER: &str = "firmware/stm32g474/src/power.rs";

const fn power(right: &'static str, wrong: &'static str, report: &'static str) -> Mistake {
    Mistake::new(POWER, right, wrong, moving, report)
}

mistakes! {
    timer_clock_off: power(
        "    rcc::enable_and_reset::<TIM1>();\n",
        "",
        "TIM1 is accessed while its clock is off",
    );
    pulse_pin_with_another_function: power(
        "CHANNEL_AF: u8 = 6;",
        "CHANNEL_AF: u8 = 5;",
        "PA8 is not routed to TIM1_CH1",
    );
    break_pin_with_another_function: power(
        "BREAK_1_AF: u8 = 12;",
        "BREAK_1_AF: u8 = 7;",
        "TIM1's break 1 is raised, and driver fault at PB10 rests",
    );
    stop_pin_with_another_function: power(
        "BREAK_2_AF: u8 = 6;",
        "BREAK_2_AF: u8 = 2;",
        "PC3 is not routed to TIM1_BKIN2",
    );
    pulses_of_pwm_mode_2: power(
        "w.set_ocm(channel % 2, Ocm::PWM_MODE1);",
        "w.set_ocm(channel % 2, Ocm::PWM_MODE2);",
        "the chip's pins carry Drive { duty: [",
    );
    pulses_of_inverted_polarity: power(
        "w.set_cce(channel, true));",
        "{ w.set_cce(channel, true); w.set_ccp(channel, true); });",
        "the chip's pins carry Drive { duty: [",
    );
    repetitions_too_few: power(
        "w.set_rep(REPETITIONS)",
        "w.set_rep(REPETITIONS - 2)",
        "TIM1's update period, cycles, is 17000, and has to be 21250",
    );
    update_at_the_top: power(
        "w.set_rep(REPETITIONS)",
        "w.set_rep(REPETITIONS - 1)",
        "TIM1's update period, cycles, is 19125, and has to be 21250",
    );
    driver_break_of_the_wrong_polarity: power(
        "w.set_bkp(0, Bkp::ACTIVE_LOW);",
        "w.set_bkp(0, Bkp::ACTIVE_HIGH);",
        "TIM1's break 1 is raised, and driver fault at PB10 rests",
    );
    stop_break_of_the_wrong_polarity: power(
        "w.set_bkp(1, Bkp::ACTIVE_HIGH);",
        "w.set_bkp(1, Bkp::ACTIVE_LOW);",
        "TIM1's break 2 is raised, and emergency stop at PC3 rests",
    );
    driver_break_without_its_filter: power(
        "        w.set_bkf(0, BREAK_FILTER);\n",
        "",
        "driver fault: noise of 34 cycles at PB10 ends TIM1's pulses",
    );
    stop_break_without_its_filter: power(
        "        w.set_bkf(1, BREAK_FILTER);\n",
        "",
        "emergency stop: noise of 34 cycles at PC3 ends TIM1's pulses",
    );
    filter_too_long: power(
        "FilterValue::FDTS_DIV8_N8",
        "FilterValue::FDTS_DIV32_N8",
        "emergency stop: TIM1's pulses go on after 80 cycles",
    );
    driver_break_not_enabled: power(
        "        w.set_bke(0, true);\n",
        "",
        "driver fault: TIM1's pulses go on after 80 cycles",
    );
    stop_break_not_enabled: power(
        "        w.set_bke(1, true);\n",
        "",
        "emergency stop: TIM1's pulses go on after 80 cycles",
    );
    stop_break_not_let_through: power(
        "        w.set_bk2ine(true);\n",
        "",
        "emergency stop: TIM1's pulses go on after 80 cycles",
    );
    breaks_armed_before_their_pins: power(
        "    take_breaks();\n    pac::TIM1.cr1()",
        "    pac::TIM1.cr1()",
        "TIM1's break 1 is raised, and driver fault at PB10 rests",
    );
}
