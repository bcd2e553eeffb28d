//! A port: pins as the image sets them, and the levels that the board gives them.

use crate::device::{Context, Device, RegisterFile};
use crate::facts::{Block, Facts, Pin};

/// What drives a pin from outside.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Outside {
    /// Nothing.
    #[default]
    Nothing,
    /// A low level.
    Low,
    /// A high level.
    High,
}

/// What the image has made of a pin.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PinMode {
    /// Read by the program.
    Input,
    /// Driven by the program.
    Output,
    /// Belongs to a peripheral, by the number of its alternate function.
    Alternate(u8),
    /// Belongs to a converter, or to nobody.
    Analogue,
}

/// Offsets, by the makers' names.
#[derive(Clone, Copy, Debug)]
struct Offsets {
    mode: u32,
    open_drain: u32,
    pull: u32,
    input: u32,
    output: u32,
    set_reset: u32,
    reset: u32,
    functions: [u32; 2],
}

/// A port.
#[derive(Clone, Debug)]
pub struct Gpio {
    registers: RegisterFile,
    offsets: Offsets,
    port: char,
    outside: [Outside; 16],
    /// Whether the image may have changed what a pin is since the last question.
    changed: bool,
    facts: &'static Facts,
}

impl Gpio {
    /// A port by its block, whose name ends with its letter.
    #[must_use]
    pub fn new(block: &'static Block, facts: &'static Facts) -> Self {
        let registers = RegisterFile::new(block);
        let offset = |name| registers.offset(name);
        Self {
            offsets: Offsets {
                mode: offset("MODER"),
                open_drain: offset("OTYPER"),
                pull: offset("PUPDR"),
                input: offset("IDR"),
                output: offset("ODR"),
                set_reset: offset("BSRR"),
                reset: offset("BRR"),
                functions: [offset("AFRL"), offset("AFRH")],
            },
            port: block.name.chars().next_back().unwrap_or('?'),
            registers,
            outside: [Outside::Nothing; 16],
            changed: true,
            facts,
        }
    }

    /// Its block.
    #[must_use]
    pub fn block(&self) -> &'static Block {
        self.registers.block()
    }

    /// Whether the image may have changed what a pin is since the last question.
    pub fn take_changed(&mut self) -> bool {
        std::mem::take(&mut self.changed)
    }

    /// Says what drives a pin from outside.
    pub fn set_outside(&mut self, pin: u8, outside: Outside) {
        if let Some(place) = self.outside.get_mut(usize::from(pin)) {
            *place = outside;
        }
    }

    /// What the image has made of a pin.
    #[must_use]
    pub fn mode(&self, pin: u8) -> PinMode {
        match self.registers.get(self.offsets.mode) >> (2 * pin) & 3 {
            0 => PinMode::Input,
            1 => PinMode::Output,
            2 => PinMode::Alternate(self.function(pin)),
            _ => PinMode::Analogue,
        }
    }

    fn function(&self, pin: u8) -> u8 {
        let [low, high] = self.offsets.functions;
        let offset = if pin < 8 { low } else { high };
        (self.registers.get(offset) >> (4 * (pin % 8)) & 0xf) as u8
    }

    /// Whether a pin is an open drain, if it is an output.
    #[must_use]
    pub fn is_open_drain(&self, pin: u8) -> bool {
        self.registers.get(self.offsets.open_drain) >> pin & 1 == 1
    }

    /// The level of a pin; none where nothing gives it one.
    #[must_use]
    pub fn level(&self, pin: u8) -> Option<bool> {
        let outside = self.outside.get(usize::from(pin)).copied();
        let bit = |offset| self.registers.get(offset) >> pin & 1 == 1;
        let (output, open_drain) = (bit(self.offsets.output), self.is_open_drain(pin));
        match (self.mode(pin), outside.unwrap_or_default()) {
            // An open drain lets go of a high pin.
            (PinMode::Output, _) if !(open_drain && output) => Some(output),
            (_, Outside::Low) => Some(false),
            (_, Outside::High) => Some(true),
            // RM0440, "Analog configuration": the pulls are off.
            (PinMode::Analogue, Outside::Nothing) => None,
            (_, Outside::Nothing) => match self.registers.get(self.offsets.pull) >> (2 * pin) & 3 {
                1 => Some(true),
                2 => Some(false),
                _ => None,
            },
        }
    }

    /// A pin of this port.
    #[must_use]
    pub fn pin(&self, number: u8) -> Pin {
        Pin {
            port: self.port,
            number,
        }
    }

    fn read_input(&self, context: &mut Context<'_>) -> u32 {
        let mut word = 0;
        for pin in 0..16 {
            match self.level(pin) {
                // RM0440, "Analog configuration": reads as zero.
                _ if self.mode(pin) == PinMode::Analogue => {}
                Some(level) => word |= u32::from(level) << pin,
                None if self.mode(pin) == PinMode::Input => context.findings.add(format!(
                    "P{}{pin} is read while nothing gives it a level: no pull, nothing outside",
                    self.port
                )),
                None => {}
            }
        }
        word
    }

    fn modes(&self) -> [PinMode; 16] {
        std::array::from_fn(|pin| self.mode(pin as u8))
    }

    /// Reports pins that are given a function that they do not have.
    fn check_functions(&self, before: &[PinMode; 16], context: &mut Context<'_>) {
        for (number, (before, mode)) in (0..).zip(before.iter().zip(self.modes())) {
            if let PinMode::Alternate(function) = mode
                && *before != mode
                && self
                    .facts
                    .alternate_function(self.pin(number), function)
                    .is_empty()
            {
                context.findings.add(format!(
                    "P{}{number} is given alternate function {function}, which it does not have",
                    self.port
                ));
            }
        }
    }
}

impl Device for Gpio {
    fn reset(&mut self) {
        self.changed = true;
        self.registers.reset();
    }

    fn read(&mut self, offset: u32, context: &mut Context<'_>) -> u32 {
        if offset == self.offsets.input {
            self.read_input(context)
        } else {
            self.registers.get(offset)
        }
    }

    fn write(&mut self, offset: u32, value: u32, context: &mut Context<'_>) {
        let output = self.registers.get(self.offsets.output);
        if offset == self.offsets.set_reset {
            let (set, reset) = (value & 0xffff, value >> 16);
            self.registers
                .set(self.offsets.output, (output & !reset) | set);
        } else if offset == self.offsets.reset {
            self.registers.set(self.offsets.output, output & !value);
        } else {
            let before = self.modes();
            self.registers.set(offset, value);
            self.changed = true;
            self.check_functions(&before, context);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bench::DeviceBench;

    fn bench() -> DeviceBench<Gpio> {
        let mut bench = DeviceBench::new("GPIOC", |block| Gpio::new(block, Facts::chip()));
        bench.write("MODER", 0b01);
        bench
    }

    #[test]
    fn outputs_are_set_and_reset() {
        let mut bench = bench();
        for (register, value, level) in [
            ("BSRR", 1, true),
            ("BRR", 1, false),
            ("ODR", 1, true),
            ("BSRR", 1 << 16, false),
            ("BSRR", 1 << 16 | 1, true),
        ] {
            bench.write(register, value);
            assert_eq!(bench.device.level(0), Some(level), "{register} {value:#x}");
        }
        assert_eq!(bench.findings(), [""; 0]);
    }

    #[test]
    fn an_analogue_pin_floats_and_reads_as_zero() {
        let mut bench = bench();
        bench.write("MODER", 0b11);
        bench.write("PUPDR", 1);
        assert_eq!(bench.device.level(0), None);
        bench.device.set_outside(0, Outside::High);
        assert_eq!(bench.device.level(0), Some(true));
        assert_eq!(bench.read("IDR") & 1, 0);
    }

    #[test]
    fn an_open_drain_lets_go_of_a_high_pin() {
        let mut bench = bench();
        bench.write("OTYPER", 1);
        bench.write("BSRR", 1);
        assert_eq!(bench.device.level(0), None);
        bench.device.set_outside(0, Outside::Low);
        assert_eq!(bench.device.level(0), Some(false));
        bench.write("PUPDR", 1);
        bench.device.set_outside(0, Outside::Nothing);
        assert_eq!(bench.device.level(0), Some(true));
        bench.write("BRR", 1);
        assert_eq!(bench.device.level(0), Some(false));
    }
}
