//! What the breaks have to do without the program: end the pulses at once when a line is raised, and let noise pass.

use super::wiring::{self, ANY_FAULT, STOP};
use leg_firmware::sensors::Sensors;
use stm32g474_emulator::chip::Chip;
use stm32g474_emulator::facts::Pin;
use stm32g474_emulator::gpio::Outside;

/// From a line that is raised to the end of the pulses, cycles: 64 of the filter, and some for it to begin.
const BREAK_CYCLES: u64 = 80;

/// Noise on a line, cycles: 0.2 µs, half of what the filter lets pass.
const NOISE_CYCLES: u64 = 34;

/// Ticks after which a line at rest has left no trace.
const QUIET_TICKS: u32 = 2;

/// The break inputs, in TIM1's order: what is on the line, its pin, its level when raised, and at rest.
const LINES: [(&str, Pin, Outside, Outside); 2] = [
    ("driver fault", ANY_FAULT, Outside::Low, Outside::High),
    ("emergency stop", STOP, Outside::High, Outside::Low),
];

/// What is known of the lines.
#[derive(Clone, Debug)]
pub struct Breaks {
    /// Ticks since a line was raised.
    quiet: u32,
    /// Noise was tried.
    tried: bool,
}

impl Default for Breaks {
    fn default() -> Self {
        Self {
            quiet: QUIET_TICKS,
            tried: false,
        }
    }
}

impl Breaks {
    /// At the beginning of a tick, with its levels on the pins: what TIM1 does wrong, as a sentence.
    ///
    /// `pass` lets some cycles pass, early in the tick.
    pub fn begin(
        &mut self,
        chip: &mut Chip,
        sensors: &Sensors,
        pass: &mut dyn FnMut(&mut Chip, u64),
    ) -> Option<String> {
        let raised = [sensors.driver_fault.contains(&true), sensors.emergency_stop];
        let on = chip.peripherals().devices.tim1.outputs().on;
        if !raised.contains(&true) {
            self.quiet = self.quiet.saturating_add(1);
            if self.tried || !on {
                return None;
            }
            self.tried = true;
            return noise(chip, pass);
        }
        self.quiet = 0;
        if !on {
            return None;
        }
        pass(chip, BREAK_CYCLES);
        let lines = LINES.iter().zip(raised).filter(|(_, raised)| *raised);
        let names: Vec<_> = lines.map(|((name, ..), _)| *name).collect();
        chip.peripherals().devices.tim1.outputs().on.then(|| {
            format!(
                "{}: TIM1's pulses go on after {BREAK_CYCLES} cycles; no break ends them",
                names.join(", ")
            )
        })
    }

    /// When the sensors have been converted, before the program looks at the flags of the breaks.
    pub fn converted(&self, chip: &Chip) -> Option<String> {
        if self.quiet < QUIET_TICKS {
            return None;
        }
        let flags = chip.peripherals().devices.tim1.break_flags();
        let (number, line) = (1..).zip(LINES).zip(flags).find(|(_, flag)| *flag)?.0;
        let (name, pin, ..) = line;
        Some(format!(
            "TIM1's break {number} is raised, and {name} at {} rests",
            wiring::name(pin)
        ))
    }
}

/// Noise on either line.
fn noise(chip: &mut Chip, pass: &mut dyn FnMut(&mut Chip, u64)) -> Option<String> {
    for (name, pin, raised, rest) in LINES {
        for (level, cycles) in [(raised, NOISE_CYCLES), (rest, BREAK_CYCLES)] {
            chip.peripherals().devices.set_outside(pin, level);
            pass(chip, cycles);
        }
        if !chip.peripherals().devices.tim1.outputs().on {
            return Some(format!(
                "{name}: noise of {NOISE_CYCLES} cycles at {} ends TIM1's pulses; its filter lets it pass",
                wiring::name(pin)
            ));
        }
    }
    None
}
