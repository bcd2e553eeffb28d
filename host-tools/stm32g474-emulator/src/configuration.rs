//! What an image has made of the chip, in words: for the golden list of a boot.

use crate::clocks::LSI_HZ;
use crate::facts::{Facts, Pin, RegisterField};
use crate::fdcan::timing::BitTiming;
use crate::gpio::{Gpio, PinMode};
use crate::peripherals::Peripherals;

/// Conversions of a converter's sequence that `SMPR` and `SMPR2` share: the inputs below this are in the first.
const INPUTS_OF_FIRST: u32 = 10;

/// One line for each part of the chip that was set up, from clocks to watchdogs.
///
/// Enumerations have the makers' names. What a peripheral's model acts on (period of the updates, rates, timeouts) is asked
/// of the model; the rest is what was written last.
#[must_use]
pub fn lines(chip: &Peripherals) -> Vec<String> {
    let mut lines = vec![processor(chip)];
    for port in &chip.devices.ports {
        lines.extend((0..16).filter_map(|number| pin(chip, port, number)));
    }
    lines.extend(power_timer(chip));
    lines.extend(["TIM2", "TIM3", "TIM4"].map(|name| encoder(chip, name)));
    lines.push(clock_timer(chip));
    lines.extend(["ADC1", "ADC2", "ADC3"].map(|name| converter(chip, name)));
    lines.extend(serial_line(chip));
    lines.extend(can_node(chip));
    lines.extend(guards(chip));
    lines
}

/// A field and the register's word that was written last.
fn written(
    chip: &Peripherals,
    block: &str,
    register: &str,
    name: &str,
) -> Option<(RegisterField, u32)> {
    let block = Facts::chip().block(block)?;
    let register = block.register(register)?;
    let word = chip.checks.last_written((block, register));
    Some((register.field(name)?.clone(), word))
}

/// A field's value.
fn value(chip: &Peripherals, [block, register, name]: [&str; 3]) -> u32 {
    written(chip, block, register, name).map_or(0, |(field, word)| field.value(word))
}

/// A field's value by the name that the makers give it.
fn word(chip: &Peripherals, [block, register, name]: [&str; 3]) -> String {
    written(chip, block, register, name)
        .map_or_else(String::new, |(field, word)| field.name_of(word))
}

/// The same in plain words: `PULL_UP` is "pull up".
fn plain(chip: &Peripherals, place: [&str; 3]) -> String {
    word(chip, place).replace('_', " ").to_lowercase()
}

/// A field of one bit: "on" or "off".
fn switch(chip: &Peripherals, place: [&str; 3]) -> &'static str {
    switch_word(value(chip, place) != 0)
}

fn switch_word(on: bool) -> &'static str {
    if on { "on" } else { "off" }
}

/// Names of the fields of a register that are set, of some.
fn set<'a>(chip: &Peripherals, place: [&str; 2], names: &[&'a str]) -> Vec<&'a str> {
    let [block, register] = place;
    let names = names.iter().copied();
    names
        .filter(|name| value(chip, [block, register, name]) != 0)
        .collect()
}

/// Names of all fields of a register that are set.
fn all_set(chip: &Peripherals, [block, register]: [&str; 2]) -> String {
    let register = Facts::chip()
        .block(block)
        .and_then(|block| Some((block, block.register(register)?)));
    let Some((block, register)) = register else {
        return String::new();
    };
    let word = chip.checks.last_written((block, register));
    let fields = register.fields.iter();
    let names = fields.filter(|field| field.value(word) != 0);
    listed(&names.map(|field| field.name.as_str()).collect::<Vec<_>>())
}

fn mhz(hz: u32) -> String {
    format!("{} MHz", f64::from(hz) / 1e6)
}

fn milliseconds(chip: &Peripherals, cycles: u64) -> String {
    let per_ms = u64::from(chip.clocks.hclk / 1_000);
    format!(
        "{}.{:03} ms",
        cycles / per_ms,
        cycles % per_ms * 1_000 / per_ms
    )
}

fn processor(chip: &Peripherals) -> String {
    let (clocks, devices) = (&chip.clocks, &chip.devices);
    format!(
        "processor: {}, {}, flash with {} wait states; buses {} and {}, their timers {} and {}",
        mhz(clocks.hclk),
        devices.pwr.voltage(),
        devices.flash.latency(),
        mhz(clocks.pclk1),
        mhz(clocks.pclk2),
        mhz(clocks.timers1),
        mhz(clocks.timers2),
    )
}

/// A pin that is no longer as after a reset.
fn pin(chip: &Peripherals, port: &Gpio, number: u8) -> Option<String> {
    let (block, pin) = (port.block().name, port.pin(number));
    let open_drain = port.is_open_drain(number);
    let kind = if open_drain {
        "open drain"
    } else {
        "push-pull"
    };
    let pull = plain(chip, [block, "PUPDR", &format!("PUPDR{number}")]);
    let role = match port.mode(number) {
        PinMode::Analogue => return None,
        // The debugger's, as after a reset.
        PinMode::Alternate(0) => return None,
        PinMode::Input => format!("input, {pull}"),
        PinMode::Output => format!("output, {kind}, {pull}"),
        PinMode::Alternate(function) => format!("{}, {kind}, {pull}", signals(pin, function)),
    };
    Some(format!("{pin}: {role}"))
}

fn signals(pin: Pin, function: u8) -> String {
    let signals = Facts::chip().alternate_function(pin, function).iter();
    let names: Vec<String> = signals
        .map(|(block, name)| format!("{block}_{name}"))
        .collect();
    names.join("/")
}

fn power_timer(chip: &Peripherals) -> Vec<String> {
    let tim1 = |register: &'static str, name: &'static str| ["TIM1", register, name];
    let top = value(chip, tim1("ARR", "ARR"));
    // Up and down again.
    let pulses_khz = f64::from(chip.clocks.timers2) / f64::from(2 * top.max(1)) / 1e3;
    let mut lines = vec![format!(
        "TIM1: {}, {pulses_khz} kHz, an update every {} cycles, trigger of the converters by {}",
        plain(chip, tim1("CR1", "CMS")),
        chip.devices.tim1.update_period_cycles(),
        plain(chip, tim1("CR2", "MMS2")),
    )];
    lines.extend((0..3).map(|channel| pulse_channel(chip, channel)));
    lines.extend((0..2).map(|input| break_input(chip, input)));
    lines.push(format!(
        "TIM1 outputs: when off, {} and {}; automatic output enable {}; lock level {}; off by {}",
        plain(chip, tim1("BDTR", "OSSI")),
        plain(chip, tim1("BDTR", "OSSR")),
        switch(chip, tim1("BDTR", "AOE")),
        chip.devices.tim1.lock_level(),
        listed(&set(
            chip,
            ["SYSCFG", "CFGR2"],
            &["CLL", "SPL", "PVDL", "ECCL"]
        )),
    ));
    lines
}

fn pulse_channel(chip: &Peripherals, channel: u32) -> String {
    let mode = if channel < 2 { "CCMR1" } else { "CCMR2" };
    let half = channel % 2;
    format!(
        "TIM1 channel {}: {}, preload {}, inverted {}, output {}",
        channel + 1,
        plain(chip, ["TIM1", mode, &format!("OCM{half}")]),
        switch(chip, ["TIM1", mode, &format!("OCPE{half}")]),
        switch(chip, ["TIM1", "CCER", &format!("CCP{channel}")]),
        switch(chip, ["TIM1", "CCER", &format!("CCE{channel}")]),
    )
}

fn break_input(chip: &Peripherals, input: u32) -> String {
    let (routing, pin) = if input == 0 {
        ("AF1", "BKINE")
    } else {
        ("AF2", "BK2INE")
    };
    format!(
        "TIM1 break {}: {}, {}, filter {}, its pin {}",
        input + 1,
        switch(chip, ["TIM1", "BDTR", &format!("BKE{input}")]),
        plain(chip, ["TIM1", "BDTR", &format!("BKP{input}")]),
        word(chip, ["TIM1", "BDTR", &format!("BKF{input}")]),
        switch(chip, ["TIM1", routing, pin]),
    )
}

fn encoder(chip: &Peripherals, name: &str) -> String {
    let field = |register, field| word(chip, [name, register, field]);
    // The makers' names of CCS are those of another channel.
    let input = |name_of_input| value(chip, [name, "CCMR1", name_of_input]);
    format!(
        "{name}: {}, CCS {} and {}, filters {} and {}, counter {}",
        plain(chip, [name, "SMCR", "SMS"]),
        input("CCS0"),
        input("CCS1"),
        field("CCMR1", "ICF0"),
        field("CCMR1", "ICF1"),
        switch(chip, [name, "CR1", "CEN"]),
    )
}

fn clock_timer(chip: &Peripherals) -> String {
    format!(
        "TIM15: counts at {}, interrupts {}",
        mhz(chip.devices.tim15.counts_hz(&chip.clocks)),
        all_set(chip, ["TIM15", "DIER"]),
    )
}

fn converter(chip: &Peripherals, name: &str) -> String {
    let number = |register, field: &str| value(chip, [name, register, field]);
    let codes: Vec<String> = (0..=number("JSQR", "JL"))
        .map(|rank| input(chip, name, number("JSQR", &format!("JSQ{rank}"))))
        .collect();
    let hz = chip.devices.converters.hz(name, &chip.clocks);
    format!(
        "{name}: {}, {} conversions added up to a code; {}; at a {} of jext{}; interrupts {}",
        mhz(hz),
        2 << number("CFGR2", "OVSR"),
        codes.join(", "),
        plain(chip, [name, "JSQR", "JEXTEN"]),
        number("JSQR", "JEXTSEL"),
        all_set(chip, [name, "IER"]),
    )
}

/// An input of a converter: its pin, where it has one, and how long it is sampled.
fn input(chip: &Peripherals, converter: &str, input: u32) -> String {
    let register = if input < INPUTS_OF_FIRST {
        "SMPR"
    } else {
        "SMPR2"
    };
    let sampling = format!("SMP{}", input % INPUTS_OF_FIRST);
    let sampling = word(chip, [converter, register, &sampling]);
    let number = u8::try_from(input).unwrap_or(u8::MAX);
    let pin = Facts::chip().converter_pin(converter, number);
    let pin = pin.map_or_else(|| "internal".to_owned(), |pin| pin.to_string());
    format!("input {input} ({pin}) for {sampling}")
}

/// LPUART1, once it is on.
fn serial_line(chip: &Peripherals) -> Option<String> {
    let baud = chip.devices.lpuart.baud(&chip.clocks)?;
    let on = value(chip, ["LPUART1", "CR1", "UE"]) != 0;
    let line = || {
        format!(
            "LPUART1: {baud:.0} baud, {}, parity {}, {}; {} are on",
            plain(chip, ["LPUART1", "CR1", "M0"]),
            switch(chip, ["LPUART1", "CR1", "PCE"]),
            plain(chip, ["LPUART1", "CR2", "STOP"]),
            listed(&set(
                chip,
                ["LPUART1", "CR1"],
                &["UE", "RE", "TE", "RXNEIE", "IDLEIE"]
            )),
        )
    };
    on.then(line)
}

/// FDCAN2, once it takes part in the bus.
fn can_node(chip: &Peripherals) -> Option<String> {
    let node = &chip.devices.fdcan;
    let phase = |timing: BitTiming| {
        let percent = f64::from(timing.sample_permille) / 10.0;
        format!("{} bit/s sampled at {percent} %", timing.hz)
    };
    let nominal = node.nominal_timing(&chip.clocks).map(phase)?;
    let data = node.data_timing(&chip.clocks).map(phase)?;
    node.takes_part().then(|| {
        format!(
            "FDCAN2: {nominal}, data {data}; {} are on; delay compensated {}; {} filters, other frames: {}; interrupts {}",
            listed(&set(chip, ["FDCAN2", "CCCR"], &["FDOE", "BRSE", "DAR", "TXP"])),
            switch(chip, ["FDCAN2", "DBTP", "TDC"]),
            value(chip, ["FDCAN2", "RXGFC", "LSS"]),
            plain(chip, ["FDCAN2", "RXGFC", "ANFS"]),
            all_set(chip, ["FDCAN2", "IE"]),
        )
    })
}

fn listed(names: &[&str]) -> String {
    if names.is_empty() {
        "none".to_owned()
    } else {
        names.join(", ")
    }
}

fn guards(chip: &Peripherals) -> Vec<String> {
    let devices = &chip.devices;
    let independent = devices.iwdg.timeout_cycles(LSI_HZ, &chip.clocks);
    let window = devices.wwdg.timeout_cycles(&chip.clocks);
    let halted = [
        set(chip, ["DBGMCU", "APB2FZR"], &["TIM1"]),
        set(chip, ["DBGMCU", "APB1LFZR"], &["IWDG", "WWDG"]),
    ];
    vec![
        format!(
            "IWDG: {}, resets the chip after {}",
            switch_word(devices.iwdg.expires_at().is_some()),
            milliseconds(chip, independent)
        ),
        format!(
            "WWDG: {}, resets the chip after {}, refreshed from a count of {} on",
            switch_word(devices.wwdg.expires_at().is_some()),
            milliseconds(chip, window),
            value(chip, ["WWDG", "CFR", "W"])
        ),
        format!(
            "supply: detector {}, level {}; watch of the crystal {}",
            switch(chip, ["PWR", "CR2", "PVDE"]),
            value(chip, ["PWR", "CR2", "PLS"]),
            switch(chip, ["RCC", "CR", "CSSON"]),
        ),
        format!("a debugger's halt: stops {}", listed(&halted.concat())),
    ]
}
