//! What this board needs of the chip beyond what the chip forbids: the times of the tick, the routes of the pins, and a
//! watchdog that ends a hung program soon.

use super::wiring::{self, Route};
use leg_firmware::board::timing::{
    CLOCK_HZ, PWM_TOP, SENSING_CYCLES, SLOW_SENSING_CYCLES, TASK_TIMER_HZ, TICK_CYCLES,
};
use stm32g474_emulator::chip::Chip;
use stm32g474_emulator::facts::Facts;
use stm32g474_emulator::iwdg::LSI_RANGE_HZ;
use stm32g474_emulator::peripherals::Peripherals;
use stm32g474_emulator::processor::Processor;

/// The control interrupt.
const CONTROL: &str = "ADC1_2";

/// The others that the image uses. embassy enables those of DMA and EXTI as well, which nothing raises.
const OTHERS: [&str; 5] = [
    "TIM1_BRK_TIM15",
    "LPUART1",
    "FDCAN2_IT0",
    "FDCAN2_IT1",
    "FLASH",
];

/// What shapes the pulses cannot be written again: the level that `firmware/BOARD.md` promises.
const LOCK_LEVEL: u64 = 3;

/// The longest time of the window watchdog, µs.
const TICK_WATCHDOG_US_MAX: u64 = 2_000;

/// The longest time of the watchdog, µs, where its oscillator is slowest.
const WATCHDOG_US_MAX: u64 = 110_000;

/// What a running image has not set up as the board needs it, as a sentence; none if everything is.
pub fn unmet(chip: &Chip) -> Option<String> {
    let peripherals = &*chip.peripherals();
    numbers(peripherals)
        .or_else(|| unrouted(peripherals))
        .or_else(|| wiring::open_drain(peripherals))
        .or_else(|| not_preloaded(peripherals))
        .or_else(|| wiring::wrong_input(peripherals))
        .or_else(|| watchdog(peripherals))
        .or_else(|| tick_watchdog(peripherals))
        .or_else(|| not_preempted(chip.processor()))
}

fn numbers(chip: &Peripherals) -> Option<String> {
    let devices = &chip.devices;
    let outputs = devices.tim1.outputs();
    let injected = |name| devices.converters.injected_cycles(name, &chip.clocks);
    let sensing = Some(u64::from(SENSING_CYCLES));
    let numbers = [
        (
            "the processor's clock, Hz,",
            Some(chip.clocks.hclk.into()),
            Some(CLOCK_HZ.into()),
        ),
        (
            "TIM1's update period, cycles,",
            Some(devices.tim1.update_period_cycles()),
            Some(TICK_CYCLES.into()),
        ),
        (
            "TIM1's level of LOCK",
            Some(devices.tim1.lock_level().into()),
            Some(LOCK_LEVEL),
        ),
        (
            "TIM15's rate, counts a second,",
            Some(devices.tim15.counts_hz(&chip.clocks).into()),
            Some(TASK_TIMER_HZ.into()),
        ),
        ("TIM1's top", Some(outputs.top.into()), Some(PWM_TOP.into())),
        (
            "the time of ADC1's sequence, cycles,",
            injected("ADC1"),
            sensing,
        ),
        (
            "the time of ADC2's sequence, cycles,",
            injected("ADC2"),
            sensing,
        ),
        (
            "the time of ADC3's sequence, cycles,",
            injected("ADC3"),
            Some(SLOW_SENSING_CYCLES.into()),
        ),
    ];
    let wrong = numbers
        .iter()
        .find(|(_, found, expected)| found != expected);
    wrong.map(|(name, found, expected)| {
        let [found, expected] = [found, expected].map(|number| number.unwrap_or_default());
        format!("{name} is {found}, and has to be {expected}")
    })
}

fn not_preloaded(chip: &Peripherals) -> Option<String> {
    let wrong = "TIM1's compare values are not preloaded: a pulse may get the length of two ticks";
    (!chip.devices.tim1.preloads()).then(|| wrong.into())
}

fn unrouted(chip: &Peripherals) -> Option<String> {
    let routed = |route: &Route| {
        chip.devices
            .is_routed(route.pin, route.peripheral, route.signal)
    };
    if let Some(route) = wiring::routes().iter().find(|route| !routed(route)) {
        let pin = wiring::name(route.pin);
        let (peripheral, signal) = (route.peripheral, route.signal);
        return Some(format!("{pin} is not routed to {peripheral}_{signal}"));
    }
    let open = wiring::LINES.iter().any(|line| line.iter().all(routed));
    (!open).then(|| "neither LPUART1 nor FDCAN2 is routed to its pins".into())
}

fn watchdog(chip: &Peripherals) -> Option<String> {
    let iwdg = &chip.devices.iwdg;
    let Some(end) = iwdg.expires_at() else {
        return Some("the watchdog IWDG was not started".into());
    };
    // It may still count from another value than the one that it is set to.
    let left = end.saturating_sub(chip.cycle);
    let cycles = left.max(iwdg.timeout_cycles(LSI_RANGE_HZ[0], &chip.clocks));
    let us = cycles * 1_000_000 / u64::from(CLOCK_HZ);
    (us > WATCHDOG_US_MAX).then(|| {
        format!("the watchdog's time may come to {us} µs, and must not exceed {WATCHDOG_US_MAX}")
    })
}

/// The watchdog that a tick has to refresh.
fn tick_watchdog(chip: &Peripherals) -> Option<String> {
    let wwdg = &chip.devices.wwdg;
    if wwdg.expires_at().is_none() {
        return Some("the window watchdog WWDG was not started".into());
    }
    let us = wwdg.timeout_cycles(&chip.clocks) * 1_000_000 / u64::from(CLOCK_HZ);
    (us > TICK_WATCHDOG_US_MAX).then(|| {
        format!("the window watchdog's time may come to {us} µs, and must not exceed {TICK_WATCHDOG_US_MAX}")
    })
}

/// The control interrupt has to preempt all others.
fn not_preempted(processor: &Processor) -> Option<String> {
    let control = Facts::chip().interrupt(CONTROL)?;
    let withstands = |name: &&&str| {
        let other = Facts::chip().interrupt(name);
        other.is_some_and(|other| processor.withstands(other, control))
    };
    let other = OTHERS.iter().find(withstands)?;
    Some(format!(
        "the control interrupt {CONTROL} does not preempt {other}: its priority is too low"
    ))
}
