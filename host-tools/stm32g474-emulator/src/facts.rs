//! What the chip's makers say of its registers, pins and interrupts.
//!
//! Two sources, made apart from each other, say it: the metadata of `stm32-metapac` (`metadata`) and ST's own description,
//! as the crate `stm32g4` has it (`description`, which alone has the values after a reset). `settle` makes one of them,
//! and where they contradict each other, `rulings` says what holds.

mod description;
mod metadata;
mod rulings;
mod settle;

use std::collections::BTreeMap;
use std::fmt;
use std::sync::LazyLock;

use stm32_metapac::metadata::METADATA;

static FACTS: LazyLock<Facts> = LazyLock::new(|| {
    let mut blocks = metadata::blocks();
    for block in &mut blocks {
        // What is not settled is a test's to find for the blocks of the image, and a finding where it is accessed.
        settle::settle(block);
    }
    Facts {
        blocks,
        functions: functions(),
    }
});

type Functions = BTreeMap<(Pin, u8), Vec<(&'static str, &'static str)>>;

fn functions() -> Functions {
    let mut functions = Functions::new();
    for block in METADATA.peripherals {
        for one in block.pins {
            if let (Some(pin), Some(function)) = (Pin::named(one.pin), one.af) {
                let signals = functions.entry((pin, function)).or_default();
                signals.push((block.name, one.signal));
            }
        }
    }
    functions
}

/// What is known of the chip.
#[derive(Debug)]
pub struct Facts {
    /// The blocks, by rising address.
    pub blocks: Vec<Block>,
    /// The signals of each alternate function of a pin.
    functions: Functions,
}

/// A peripheral's registers.
#[derive(Clone, Debug)]
pub struct Block {
    /// As in the reference manual: `TIM1`, `ADC12_COMMON`.
    pub name: &'static str,
    /// Address of its first register.
    pub base: u32,
    /// Bytes from the first register to the end of the last.
    pub size: u32,
    /// By rising offset.
    pub registers: Vec<Register>,
    /// What switches its clock on; none where it always runs.
    pub enable: Option<Switch>,
    /// What holds it in reset while it is set.
    pub reset: Option<Switch>,
}

/// A bit of RCC.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Switch {
    /// Offset of the register in RCC.
    pub offset: u32,
    /// The bit.
    pub bit: u32,
}

/// A register.
#[derive(Clone, Debug)]
pub struct Register {
    /// Upper case, without the block's, by `stm32-metapac`; one of an array by ST: `CR1`, `JDR2`, `RXF0S`.
    pub name: String,
    /// From the block's first register, bytes.
    pub offset: u32,
    /// 8, 16 or 32.
    pub bits: u32,
    /// What the processor may do with it.
    pub access: Access,
    /// Its fields; an array of fields is given one by one.
    pub fields: Vec<RegisterField>,
    /// The bits that belong to a field; the others are reserved. All, where the register has no fields.
    pub known: u32,
    /// What it is after a reset.
    pub reset: u32,
    /// Whether the sources contradict each other about it, and no ruling says what holds.
    pub contradicted: bool,
}

/// What the processor may do with a register.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Access {
    /// Both.
    ReadWrite,
    /// Read only.
    Read,
    /// Write only.
    Write,
}

/// A field of a register.
#[derive(Clone, Debug)]
pub struct RegisterField {
    /// Upper case, by `stm32-metapac` (and so by the board's code): `CEN`, `SMP6`, `CCIE0`.
    pub name: String,
    /// By ST, as in the reference manual: `CC1IE`.
    pub name_by_st: String,
    /// Its bits in the register.
    pub mask: u32,
    /// The values that have a meaning, as [`gather`] gives them; none where all have. That after a reset has one.
    pub values: Option<Vec<u32>>,
    /// What the makers call its values.
    pub names: Vec<(u32, &'static str)>,
}

/// A pin, by its port and number.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Pin {
    /// `'A'` to `'G'`.
    pub port: char,
    /// 0 to 15.
    pub number: u8,
}

impl Facts {
    /// What is known of the STM32G474RE.
    #[must_use]
    pub fn chip() -> &'static Self {
        &FACTS
    }

    /// A block by its name.
    #[must_use]
    pub fn block(&self, name: &str) -> Option<&Block> {
        self.blocks.iter().find(|block| block.name == name)
    }

    /// The block that an address is in.
    #[must_use]
    pub fn block_at(&self, address: u32) -> Option<&Block> {
        let end = self.blocks.partition_point(|block| block.base <= address);
        let blocks = self.blocks.get(..end)?.iter().rev();
        let mut around = blocks.filter(|block| address - block.base < block.size);
        // Where blocks are interleaved, as the amplifiers are, it is the one that has a register there.
        let nearest = around.clone().next();
        around
            .find(|block| block.register_at(address - block.base).is_some())
            .or(nearest)
    }

    /// The number of an interrupt, from 0 for `WWDG`: `ADC1_2`, `TIM1_BRK_TIM15`.
    #[must_use]
    pub fn interrupt(&self, name: &str) -> Option<u16> {
        let known = METADATA
            .interrupts
            .iter()
            .find(|known| known.name == name)?;
        u16::try_from(known.number).ok()
    }

    /// The name of an interrupt, by its number.
    #[must_use]
    pub fn interrupt_name(&self, number: u16) -> Option<&'static str> {
        let mut known = METADATA.interrupts.iter();
        let known = known.find(|known| known.number == u32::from(number))?;
        Some(known.name)
    }

    /// The peripheral and signal that an alternate function of a pin is: `("TIM1", "CH1")`; several where the makers name
    /// several, none where the pin has no such function.
    #[must_use]
    pub fn alternate_function(&self, pin: Pin, function: u8) -> &[(&'static str, &'static str)] {
        self.functions
            .get(&(pin, function))
            .map_or(&[], Vec::as_slice)
    }

    /// The pin of an input of a converter: `("ADC1", 6)` is on PC0; none where the input is internal or has no pin.
    #[must_use]
    pub fn converter_pin(&self, converter: &str, input: u8) -> Option<Pin> {
        let mut all = METADATA.peripherals.iter();
        let pins = all.find(|block| block.name == converter)?.pins;
        let signal = format!("IN{input}");
        Pin::named(pins.iter().find(|pin| pin.signal == signal)?.pin)
    }
}

impl Pin {
    /// The pin of a name as in the reference manual: `PC0`.
    fn named(name: &str) -> Option<Self> {
        let mut rest = name.strip_prefix('P')?.chars();
        let port = rest.next()?;
        let number = rest.as_str().parse().ok()?;
        Some(Self { port, number })
    }
}

impl fmt::Display for Pin {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "P{}{}", self.port, self.number)
    }
}

impl Block {
    /// The register at an offset.
    #[must_use]
    pub fn register_at(&self, offset: u32) -> Option<&Register> {
        let place = self
            .registers
            .binary_search_by_key(&offset, |register| register.offset);
        self.registers.get(place.ok()?)
    }

    /// The register of a name.
    #[must_use]
    pub fn register(&self, name: &str) -> Option<&Register> {
        self.registers.iter().find(|register| register.name == name)
    }
}

impl Register {
    /// The field of a name.
    #[must_use]
    pub fn field(&self, name: &str) -> Option<&RegisterField> {
        self.fields.iter().find(|field| field.name == name)
    }
}

impl RegisterField {
    /// The field's value in a word of its register.
    #[must_use]
    pub const fn value(&self, word: u32) -> u32 {
        gather(self.mask, word)
    }

    /// What the makers call the field's value in a word of its register; the number where they do not name it.
    #[must_use]
    pub fn name_of(&self, word: u32) -> String {
        let value = self.value(word);
        let known = self.names.iter().find(|(known, _)| *known == value);
        known.map_or_else(|| value.to_string(), |(_, name)| (*name).to_owned())
    }
}

/// The bits of a mask in a word, close together from bit 0: a timer's `OCM0` is at bits 4 to 6 and 16.
#[must_use]
pub const fn gather(mask: u32, word: u32) -> u32 {
    let (mut value, mut rest, mut place) = (0, mask, 0);
    while rest != 0 {
        let run = run_of(rest);
        value |= (word & run) >> run.trailing_zeros() << place;
        place += run.count_ones();
        rest &= !run;
    }
    value
}

/// The inverse of [`gather`].
#[must_use]
pub const fn scatter(mask: u32, value: u32) -> u32 {
    let (mut word, mut rest, mut value) = (0, mask, value as u64);
    while rest != 0 {
        let run = run_of(rest);
        word |= (value << run.trailing_zeros()) as u32 & run;
        value >>= run.count_ones();
        rest &= !run;
    }
    word
}

/// The lowest bits of a mask that have no gap.
const fn run_of(mask: u32) -> u32 {
    mask & !mask.wrapping_add(1 << mask.trailing_zeros())
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test may panic")]
mod tests {
    use super::*;

    #[test]
    fn a_field_in_two_parts_is_one_value() {
        for (mask, word, value) in [
            (0x0001_0070, 0xFFFE_FFDF, 0b0101),
            (0x0001_0070, 0x0001_0020, 0b1010),
            (0x0000_00F0, 0x1230, 0x3),
            (0xF000_0000, 0xA000_0000, 0xA),
            (0xFFFF_FFFF, 0x1234_5678, 0x1234_5678),
            (0, 0xFFFF_FFFF, 0),
        ] {
            assert_eq!(gather(mask, word), value, "{mask:#x}");
            assert_eq!(scatter(mask, value), word & mask, "{mask:#x}");
        }
    }

    #[test]
    fn what_the_manual_says_is_known() {
        let facts = Facts::chip();
        let pin = |port, number| Pin { port, number };
        for (pin, function, signal) in [
            (pin('A', 8), 6, ("TIM1", "CH1")),
            (pin('B', 10), 12, ("TIM1", "BKIN")),
            (pin('C', 3), 6, ("TIM1", "BKIN2")),
        ] {
            let known = facts.alternate_function(pin, function);
            assert!(known.contains(&signal), "{pin}: {known:?}");
        }
        assert_eq!(facts.alternate_function(pin('C', 0), 15), []);
        assert_eq!(facts.converter_pin("ADC1", 6), Some(pin('C', 0)));
        assert_eq!(facts.converter_pin("ADC1", 16), None);
        for (name, number) in [
            ("WWDG", 0),
            ("ADC1_2", 18),
            ("TIM1_BRK_TIM15", 24),
            ("LPUART1", 91),
        ] {
            assert_eq!(facts.interrupt(name), Some(number), "{name}");
            assert_eq!(facts.interrupt_name(number), Some(name));
        }
        assert_eq!(facts.interrupt("NONE"), None);
        let timer = facts.block("TIM1").unwrap();
        assert_eq!(
            timer.enable,
            Some(Switch {
                offset: 0x60,
                bit: 11
            })
        );
        assert_eq!(
            timer.reset,
            Some(Switch {
                offset: 0x40,
                bit: 11
            })
        );
        assert_eq!(
            facts.block_at(0x4001_2C44).map(|block| block.name),
            Some("TIM1")
        );
        assert!(facts.block_at(0x4001_2FFF).is_none());
        assert_eq!(
            timer
                .register_at(0x44)
                .map(|register| register.name.as_str()),
            Some("BDTR")
        );
        assert!(timer.register_at(0x45).is_none());
        for (block, register, reset) in [
            ("RCC", "CR", 0x500),
            ("FLASH", "ACR", 0x0004_0600),
            ("GPIOA", "MODER", 0xABFF_FFFF),
            ("GPIOG", "MODER", 0xFFFF_FFFF),
            ("PWR", "CR5", 0x100),
            ("ADC3", "CR", 0x2000_0000),
            ("TIM2", "ARR", 0xFFFF_FFFF),
            ("TIM4", "ARR", 0xFFFF),
            ("IWDG", "RLR", 0xFFF),
        ] {
            let register = facts
                .block(block)
                .and_then(|block| block.register(register));
            assert_eq!(
                register.map(|register| register.reset),
                Some(reset),
                "{block}"
            );
        }
        let values = |block, register, field| {
            let register = facts
                .block(block)
                .and_then(|block| block.register(register));
            let field = register.and_then(|register| register.field(field));
            field.unwrap().values.clone()
        };
        assert_eq!(values("RCC", "PLLCFGR", "PLLSRC"), Some(vec![0, 2, 3]));
        assert_eq!(values("RCC", "CR", "HSION"), None);
        // Its enumeration has 1 alone.
        assert_eq!(values("ADC1", "CR", "JADSTP"), None);
        assert_eq!(values("IWDG", "KR", "KEY").map(|keys| keys.len()), Some(3));
    }
}
