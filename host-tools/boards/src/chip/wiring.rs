//! The wires between the chip and the simulated leg: `firmware/BOARD.md`.

use leg_firmware::drive::Drive;
use leg_firmware::sensors::Sensors;
use stm32g474_emulator::adc::sum_of;
use stm32g474_emulator::facts::{Facts, Pin};
use stm32g474_emulator::gpio::Outside;
use stm32g474_emulator::peripherals::Peripherals;

const fn pin(port: char, number: u8) -> Pin {
    Pin { port, number }
}

const CELLS: [Pin; 3] = [pin('C', 0), pin('C', 1), pin('C', 2)];
const CURRENTS: [Pin; 3] = [pin('A', 4), pin('A', 6), pin('A', 7)];
const SUPPLY: Pin = pin('B', 1);
const TEMPERATURE: Pin = pin('B', 0);
/// What each converter takes in a tick: its pins in the order of its injected sequence, and how many conversions make a code.
/// ADC3 takes the chip's own voltage after these.
const CONVERTED: [(&str, &[Pin], u32); 3] = [
    ("ADC1", &CELLS, 16),
    ("ADC2", &CURRENTS, 16),
    ("ADC3", &[SUPPLY, TEMPERATURE], SLOW_CONVERSIONS),
];
const SLOW_CONVERSIONS: u32 = 8;
const PULSES: [Pin; 3] = [pin('A', 8), pin('A', 9), pin('A', 10)];
const DIRECTIONS: [Pin; 3] = [pin('C', 6), pin('C', 7), pin('C', 8)];
const ENABLE: Pin = pin('C', 9);
const FAULTS: [Pin; 3] = [pin('B', 2), pin('B', 11), pin('B', 15)];
/// The drivers' common fault line, low when raised.
pub const ANY_FAULT: Pin = pin('B', 10);
/// The emergency stop, high when pressed.
pub const STOP: Pin = pin('C', 3);
/// Tracks of each encoder.
const TRACKS: [[Pin; 2]; 3] = [
    [pin('A', 0), pin('A', 1)],
    [pin('B', 4), pin('B', 5)],
    [pin('B', 6), pin('B', 7)],
];
const TRANSMIT: Pin = pin('A', 2);
const RECEIVE: Pin = pin('A', 3);
const CAN_RECEIVE: Pin = pin('B', 12);
const CAN_TRANSMIT: Pin = pin('B', 13);

/// The timers of the encoders.
const TIMERS: [&str; 3] = ["TIM2", "TIM3", "TIM4"];

/// A pin and the signal that has to be on it.
#[derive(Clone, Copy, Debug)]
pub struct Route {
    /// The pin.
    pub pin: Pin,
    /// Its peripheral.
    pub peripheral: &'static str,
    /// The signal.
    pub signal: &'static str,
}

/// What the host's line has to be routed to: the serial one, or CAN.
pub const LINES: [[Route; 2]; 2] = [
    [
        route(TRANSMIT, "LPUART1", "TX"),
        route(RECEIVE, "LPUART1", "RX"),
    ],
    [
        route(CAN_TRANSMIT, "FDCAN2", "TX"),
        route(CAN_RECEIVE, "FDCAN2", "RX"),
    ],
];

const fn route(pin: Pin, peripheral: &'static str, signal: &'static str) -> Route {
    Route {
        pin,
        peripheral,
        signal,
    }
}

/// What the pins of the timers have to be routed to.
pub fn routes() -> Vec<Route> {
    let pulses = PULSES.into_iter().zip(CHANNELS);
    let pulses = pulses.map(|(pin, signal)| route(pin, "TIM1", signal));
    let tracks = TRACKS.into_iter().zip(TIMERS).flat_map(|(tracks, timer)| {
        let tracks = tracks.into_iter().zip(CHANNELS);
        tracks.map(move |(pin, signal)| route(pin, timer, signal))
    });
    let others = [
        route(ANY_FAULT, "TIM1", "BKIN"),
        route(STOP, "TIM1", "BKIN2"),
    ];
    pulses.chain(tracks).chain(others).collect()
}

/// A pin that has to be driven high as well as low, and is an open drain, as a sentence.
pub fn open_drain(chip: &Peripherals) -> Option<String> {
    let lines = LINES.iter().map(|[transmit, _]| *transmit);
    let lines = lines.filter(|line| {
        let Route { pin, .. } = *line;
        chip.devices.is_routed(pin, line.peripheral, line.signal)
    });
    let mut driven = PULSES.into_iter().chain(lines.map(|line| line.pin));
    let pin = driven.find(|pin| chip.devices.is_open_drain(*pin))?;
    Some(format!(
        "{} is an open drain: nothing makes it high",
        name(pin)
    ))
}

/// An input that a converter takes in the place of another, as a sentence.
pub fn wrong_input(chip: &Peripherals) -> Option<String> {
    for (converter, pins, _) in CONVERTED {
        for (rank, &pin) in pins.iter().enumerate() {
            let input = chip.devices.converters.injected_input(converter, rank);
            let found = input.and_then(|input| Facts::chip().converter_pin(converter, input));
            if found != Some(pin) {
                let found = found.map_or_else(|| "no pin".into(), name);
                return Some(format!(
                    "{converter}'s code {} is of {found}, and has to be of {}",
                    rank + 1,
                    name(pin)
                ));
            }
        }
    }
    None
}

/// A code that a converter has, by its inputs' pins, which differs from what its pin is at: the difference in words. ADC2 is
/// left out where it was not triggered.
pub fn wrong_code(chip: &Peripherals, untriggered: bool) -> Option<String> {
    for (converter, pins, conversions) in CONVERTED {
        if untriggered && converter == "ADC2" {
            continue;
        }
        for (rank, &pin) in pins.iter().enumerate() {
            let found = chip.devices.converters.injected_code(converter, rank);
            let sum = chip.devices.analogue.get(&pin).copied().unwrap_or_default();
            let expected = sum_of(sum, conversions, 0);
            if found != Some(expected) {
                return Some(format!(
                    "{converter}'s code {} is {}, and {} is at {expected}",
                    rank + 1,
                    found.unwrap_or_default(),
                    name(pin)
                ));
            }
        }
    }
    None
}

/// A pin's name.
pub fn name(pin: Pin) -> String {
    format!("P{}{}", pin.port, pin.number)
}

/// The rate of the host's line, baud.
const BAUD: u32 = 921_600;

/// What the sensors read, with the encoders counted from a first reading: a chip's counters start at zero.
pub fn count_from(first: &Sensors, sensors: &Sensors) -> Sensors {
    let mut counts = sensors.encoder_counts;
    for (count, start) in counts.iter_mut().zip(first.encoder_counts) {
        *count = count.wrapping_sub(start);
    }
    Sensors {
        encoder_counts: counts,
        ..*sensors
    }
}

/// Puts what the sensors read on the chip's pins.
pub fn apply(chip: &mut Peripherals, sensors: &Sensors) {
    let cells = CELLS.into_iter().zip(sensors.cell_codes);
    let currents = CURRENTS.into_iter().zip(sensors.current_codes);
    let slow = [
        (SUPPLY, sensors.supply_code),
        (TEMPERATURE, sensors.temperature_code),
    ];
    chip.devices
        .analogue
        .extend(cells.chain(currents).chain(slow));
    for (timer, (tracks, count)) in TRACKS.iter().zip(sensors.encoder_counts).enumerate() {
        let mut signals = tracks.iter().zip(CHANNELS);
        let routed =
            signals.all(|(track, signal)| chip.devices.encoder_routed(timer, *track, signal));
        chip.devices.set_encoder(timer, u32::from(count), routed);
    }
    let level = |high| if high { Outside::High } else { Outside::Low };
    for (fault, raised) in FAULTS.into_iter().zip(sensors.driver_fault) {
        chip.devices.set_outside(fault, level(!raised));
    }
    let any = sensors.driver_fault.contains(&true);
    chip.devices.set_outside(ANY_FAULT, level(!any));
    chip.devices
        .set_outside(STOP, level(sensors.emergency_stop));
    // The adapter's line rests high.
    chip.devices.set_outside(RECEIVE, Outside::High);
}

/// The codes of supply and temperature as they were converted last; zero before. The image doubles them.
pub fn slow_codes(chip: &Peripherals) -> [u16; 2] {
    let level = |pin| chip.devices.sampled(pin).unwrap_or_default();
    [SUPPLY, TEMPERATURE].map(|pin| {
        let code = 2 * sum_of(level(pin), SLOW_CONVERSIONS, 0);
        u16::try_from(code).unwrap_or(u16::MAX)
    })
}

/// The codes of the currents as they were converted last; zero before.
pub fn current_codes(chip: &Peripherals) -> [u16; 3] {
    CURRENTS.map(|pin| chip.devices.sampled(pin).unwrap_or_default())
}

/// What the motors get from the pins: for which part of the pulses' period they are high.
///
/// # Errors
/// A pin that floats while the timer's outputs are on, or drivers that are enabled while these are off or the other way
/// round, as a sentence.
pub fn motors(chip: &Peripherals) -> Result<Drive<f32>, String> {
    let outputs = chip.devices.tim1.outputs();
    let driven = |pin, value: Option<f32>| {
        let floats = || format!("{} floats while TIM1's outputs are on", name(pin));
        match value {
            None if outputs.on => Err(floats()),
            value => Ok(value.unwrap_or_default()),
        }
    };
    let level = |pin| {
        chip.devices
            .level(pin)
            .map(|high| f32::from(u8::from(high)))
    };
    let mut duty = [0.0; 3];
    let pins = PULSES.into_iter().zip(DIRECTIONS).zip(CHANNELS);
    for ((share, counts), ((pulse, direction), channel)) in
        duty.iter_mut().zip(outputs.high).zip(pins)
    {
        let top = f32::from(outputs.top.max(1));
        let carried = if chip.devices.is_routed(pulse, "TIM1", channel) {
            counts.map(|counts| f32::from(counts) / top)
        } else {
            level(pulse)
        };
        let width = driven(pulse, carried)?;
        let forward = driven(direction, level(direction))? > 0.0;
        *share = if forward { width } else { -width };
    }
    let enabled = chip.devices.level(ENABLE) == Some(true);
    match (outputs.on, enabled) {
        (true, false) => {
            return Err("TIM1's outputs are on while the drivers are not enabled".into());
        }
        (false, true) => {
            return Err("the drivers are enabled while TIM1's outputs are off".into());
        }
        _ => {}
    }
    Ok(Drive {
        duty,
        enabled: outputs.on,
    })
}

/// The signals of the pulses, and of tracks.
const CHANNELS: [&str; 3] = ["CH1", "CH2", "CH3"];

/// Whether the chip listens to the host's line.
pub fn listens(chip: &Peripherals) -> bool {
    chip.devices.lpuart.listens(chip.cycle)
}

/// Sends a byte on the host's line.
pub fn send(chip: &mut Peripherals, byte: u8) {
    chip.send(byte, BAUD);
}
