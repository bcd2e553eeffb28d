//! Interrupts, memory and the watchdog.

use super::runs::{latest, moving};
use super::{Mistake, hangs, mistakes};

const fn board(
    file: &'static str,
    right: &'static str,
    wrong: &'static str,
    report: &'static str,
) -> Mistake {
    Mistake::new(file, right, wrong, moving, report)
}

mistakes! {
    control_interrupt_masked: board(
        "firmware/stm32g474/src/control.rs",
        "    unsafe { interrupt::ADC1_2.enable() };\n",
        "",
        "does not begin the control interrupt's handler within 423 cycles",
    );
    section_of_the_tasks_in_the_control_interrupt: board(
        "firmware/stm32g474/src/control.rs",
        "        CHECK_INS.check_in(WatchedTask::Control);\n",
        "        critical_section::with(|_| CHECK_INS.check_in(WatchedTask::Control));\n",
        "was reset (Software)",
    );
    control_interrupt_at_a_lower_priority: board(
        "firmware/stm32g474/src/priorities.rs",
        "ADC1_2.set_priority(CONTROL)",
        "ADC1_2.set_priority(Priority::P7)",
        "the control interrupt ADC1_2 does not preempt",
    );
    control_interrupt_late: Mistake {
        file: "firmware/stm32g474/src/priorities.rs",
        right: "ADC1_2.set_priority(CONTROL)",
        wrong: "ADC1_2.set_priority(Priority::P7)",
        run: latest,
        report: "cycles after its interrupt",
    };
    hot_code_not_copied: board(
        "firmware/stm32g474/src/main.rs",
        "    hot::load();\n",
        "",
        "the code of the CCM is not there",
    );
    stack_too_small: board(
        "memory.x",
        "_flash_start = ORIGIN(FLASH);\n",
        "_flash_start = ORIGIN(FLASH);\n_stack_start = (__sheap + 2055) & ~7;\n",
        "the stack has come down to the variables",
    );
    stack_that_overflows: Mistake {
        file: "firmware/stm32g474/src/housekeeping.rs",
        right: "        watchdog.round();\n",
        wrong: "        watchdog.round();
        if embassy_time::Instant::now().as_millis() > 150 {
            #[inline(never)]
            fn deeper(depth: u32) -> u32 {
                let place = [depth; 64];
                let below = if depth == 0 { 0 } else { deeper(depth - 1) };
                below + core::hint::black_box(&place).iter().sum::<u32>()
            }
            core::hint::black_box(deeper(core::hint::black_box(1_000_000)));
        }\n",
        run: hangs::failing,
        report: "Software, Software, `hard fault at ",
    };
    write_to_the_hot_code: Mistake {
        file: "firmware/stm32g474/src/housekeeping.rs",
        right: "        watchdog.round();\n",
        wrong: "        watchdog.round();
        if embassy_time::Instant::now().as_millis() > 150 {
            #[allow(unsafe_code)]
            unsafe { core::ptr::write_volatile(0x1000_0100 as *mut u32, 0) };
        }\n",
        run: hangs::failing,
        report: "Software, Software, `hard fault at ",
    };
    watchdog_fed_by_an_interrupt: board(
        "firmware/stm32g474/src/control.rs",
        "    let started = DWT::cycle_count();\n",
        "    let started = DWT::cycle_count();
    embassy_stm32::pac::IWDG.kr().write(|w| w.set_key(embassy_stm32::pac::iwdg::vals::Key::RESET));\n",
        "IWDG is fed by an interrupt's handler",
    );
    watchdog_fed_before_its_settings_arrive: board(
        "firmware/stm32g474/src/watchdog.rs",
        "        wait_for_settings();\n",
        "",
        "the watchdog's time may come to",
    );
    watchdog_too_slow: board(
        "firmware/stm32g474/src/watchdog.rs",
        "TIMEOUT_US: u32 = 100_000;",
        "TIMEOUT_US: u32 = 1_000_000;",
        "the watchdog's time may come to",
    );
}
