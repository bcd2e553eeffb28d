//! What guards the leg and shows in no tick that is as it should be.

use super::runs::{losing_its_crystal, losing_its_supply, moving};
use super::{Mistake, mistakes};

const POWER: &str = "firmware/stm32g474/src/power.rs";
const MAIN: &str = "firmware/stm32g474/src/main.rs";
const SYSTEM_BREAKS: &str = "TIM1's pulses go on";

mistakes! {
    outputs_that_come_back_by_themselves: Mistake::new(
        POWER,
        "w.set_aoe(false);",
        "w.set_aoe(true);",
        moving,
        "TIM1's outputs are on while the drivers are not enabled",
    );
    drivers_left_enabled: Mistake::new(
        POWER,
        "    pac::GPIOC.bsrr().write(|w| w.set_br(ENABLE_PIN, true));\n",
        "",
        moving,
        "the drivers are enabled while TIM1's outputs are off",
    );
    outputs_that_float_when_off: Mistake::new(
        POWER,
        "w.set_ossi(Ossi::IDLE_LEVEL);",
        "w.set_ossi(Ossi::DISABLED);",
        moving,
        "TIM1_BDTR: BK2E is set without OSSI and OSSR",
    );
    pulses_by_an_open_drain: Mistake::new(
        POWER,
        "AfType::output(OutputType::PushPull, Speed::Medium)",
        "AfType::output(OutputType::OpenDrain, Speed::Medium)",
        moving,
        "PA8 is an open drain: nothing makes it high",
    );
    pulses_not_preloaded: Mistake::new(
        POWER,
        "w.set_ocpe(channel % 2, true);",
        "w.set_ocpe(channel % 2, false);",
        moving,
        "TIM1's compare values are not preloaded",
    );
    power_stage_not_locked: Mistake::new(
        POWER,
        "w.set_lock(Lock::LEVEL3);",
        "w.set_lock(Lock::LEVEL1);",
        moving,
        "TIM1's level of LOCK is 1, and has to be 3",
    );
    interrupt_that_stays_pending: Mistake::new(
        POWER,
        "    set_up_breaks();\n    // Takes",
        "    set_up_breaks();\n    timer.dier().modify(|w| w.set_uie(true));\n    // Takes",
        moving,
        "the interrupt TIM1_UP_TIM16 stays pending: the program asks for it, and has not enabled it",
    );
    interrupt_without_a_handler: Mistake::new(
        POWER,
        "    set_up_breaks();\n    // Takes",
        "    set_up_breaks();
    timer.dier().modify(|w| w.set_uie(true));
    #[allow(unsafe_code)]
    unsafe { cortex_m::peripheral::NVIC::unmask(pac::Interrupt::TIM1_UP_TIM16) };
    // Takes",
        moving,
        "the interrupt TIM1_UP_TIM16 comes, and has no handler",
    );
    ccm_protected_before_it_is_written: Mistake::new(
        MAIN,
        "    hot::load();\n",
        "    embassy_stm32::pac::RCC.apb2enr().modify(|w| w.set_syscfgen(true));
    embassy_stm32::pac::SYSCFG.swpr().write(|w| w.0 = u32::MAX);
    hot::load();\n",
        moving,
        "page 0 of the CCM is written, which SYSCFG_SWPR protects",
    );
    ccm_protected_before_its_clock_is_on: Mistake::new(
        MAIN,
        "    let Some(peripherals) = clocks::start() else {
        fatal::end(&ShortText::new(\"the crystal does not start\"));
    };
    memory_guard::set();\n",
        "    memory_guard::set();
    let Some(peripherals) = clocks::start() else {
        fatal::end(&ShortText::new(\"the crystal does not start\"));
    };\n",
        moving,
        "SYSCFG is accessed while its clock is off",
    );
    crystal_not_watched: Mistake::new(MAIN, "    clocks::watch();\n", "", losing_its_crystal, SYSTEM_BREAKS);
    supply_not_watched: Mistake::new(MAIN, "    supply_watch::start();\n", "", losing_its_supply, SYSTEM_BREAKS);
    supply_break_not_connected: Mistake::new(
        POWER,
        "        w.set_pvdl(true);\n",
        "",
        losing_its_supply,
        SYSTEM_BREAKS,
    );
}
