//! What a peripheral is to the rest of the chip.
//!
//! Before an access reaches a device, the bus has checked what holds for every register: that it exists, that the block's
//! clock is on and its reset is off, width and access rights, bits that are reserved, and values that no enumeration has.
//! A device checks what is its own: an order of writes, a lock, a rate.
//!
//! A device takes the places of its registers and fields from the makers' facts, by their names, when it is made:
//! [`RegisterFile::field`]. It holds no offset or bit number of its own.
//!
//! A device computes what it shows when it is asked, from the cycle of the moment. Where something happens without being
//! asked, it names the cycle in [`Device::next_event`], and [`Device::advance`] is called then.

use crate::clocks::Clocks;
use crate::facts::{Block, gather, scatter};
use crate::findings::Findings;

/// What a device sees of the chip.
pub struct Context<'a> {
    /// The moment: cycles of the processor's clock since the power-up. Its rate is [`Clocks::hclk`], and changes with it.
    pub cycle: u64,
    /// The frequencies of the moment.
    pub clocks: &'a Clocks,
    /// Where to report what the image does wrong.
    pub findings: &'a mut Findings,
}

/// A peripheral.
pub trait Device {
    /// Back to what it is after a reset of the chip or of the block.
    fn reset(&mut self);

    /// The processor reads the register at an offset: the value, with the side effects of the read.
    fn read(&mut self, offset: u32, context: &mut Context<'_>) -> u32;

    /// The processor writes a register: the whole word, as the bus has merged it.
    fn write(&mut self, offset: u32, value: u32, context: &mut Context<'_>);

    /// The next cycle in which something happens by itself.
    fn next_event(&self) -> Option<u64> {
        None
    }

    /// Does what is due at the moment: called at or after [`Self::next_event`].
    fn advance(&mut self, _context: &mut Context<'_>) {}
}

/// The words that a block's registers keep.
#[derive(Clone, Debug)]
pub struct RegisterFile {
    block: &'static Block,
    words: Vec<u32>,
}

impl RegisterFile {
    /// With what a reset gives.
    #[must_use]
    pub fn new(block: &'static Block) -> Self {
        let mut file = Self {
            block,
            words: vec![0; (block.size / 4) as usize],
        };
        file.reset();
        file
    }

    /// Back to what a reset gives.
    pub fn reset(&mut self) {
        self.words.fill(0);
        for register in &self.block.registers {
            self.set(register.offset, register.reset);
        }
    }

    /// The block that they belong to.
    #[must_use]
    pub fn block(&self) -> &'static Block {
        self.block
    }

    /// A word; 0 where there is none.
    #[must_use]
    pub fn get(&self, offset: u32) -> u32 {
        let word = self.words.get((offset / 4) as usize);
        word.copied().unwrap_or_default()
    }

    /// Sets a word, whoever may write it.
    pub fn set(&mut self, offset: u32, value: u32) {
        if let Some(word) = self.words.get_mut((offset / 4) as usize) {
            *word = value;
        }
    }
}

/// A field's place in its block.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FieldPlace {
    /// Its register's offset.
    pub offset: u32,
    /// Its bits.
    pub mask: u32,
}

impl FieldPlace {
    /// The field's value in a word of its register.
    #[must_use]
    pub const fn extract(self, word: u32) -> u32 {
        gather(self.mask, word)
    }

    /// The word with the field set to a value.
    #[must_use]
    pub const fn insert(self, word: u32, value: u32) -> u32 {
        (word & !self.mask) | scatter(self.mask, value)
    }
}

impl RegisterFile {
    /// The offset of a register by its name.
    ///
    /// # Panics
    /// Without such a register: the device then names something that its block has not.
    #[must_use]
    pub fn offset(&self, register: &str) -> u32 {
        match self.block.register(register) {
            Some(register) => register.offset,
            None => panic!("{} has no register {register}", self.block.name),
        }
    }

    /// The place of a field by the names of its register and itself.
    ///
    /// # Panics
    /// Without such a field: the device then names something that its block has not.
    #[must_use]
    pub fn field(&self, register: &str, field: &str) -> FieldPlace {
        let known = self.block.register(register);
        let found = known.and_then(|r| r.fields.iter().find(|f| f.name == field).map(|f| (r, f)));
        match found {
            Some((register, field)) => FieldPlace {
                offset: register.offset,
                mask: field.mask,
            },
            None => panic!("{}_{register} has no field {field}", self.block.name),
        }
    }

    /// The bits of several fields of a register.
    ///
    /// # Panics
    /// Without one of them.
    #[must_use]
    pub fn mask(&self, register: &str, fields: &[&str]) -> u32 {
        let masks = fields.iter().map(|field| self.field(register, field).mask);
        masks.fold(0, |all, mask| all | mask)
    }

    /// The value that a field has.
    #[must_use]
    pub fn value(&self, field: FieldPlace) -> u32 {
        field.extract(self.get(field.offset))
    }

    /// Whether a field is not zero.
    #[must_use]
    pub fn is_set(&self, field: FieldPlace) -> bool {
        self.get(field.offset) & field.mask != 0
    }

    /// Sets a field's value.
    pub fn set_value(&mut self, field: FieldPlace, value: u32) {
        self.set(field.offset, field.insert(self.get(field.offset), value));
    }
}

/// A struct with the places of registers and fields by the makers' names, `CR1` or `CR1.CEN`, and with what is made of them.
macro_rules! places {
    (@kind) => { u32 };
    (@kind $field:ident) => { $crate::device::FieldPlace };
    (@find $file:ident $register:ident) => { $file.offset(stringify!($register)) };
    (@find $file:ident $register:ident $field:ident) => {
        $file.field(stringify!($register), stringify!($field))
    };
    ($(#[$about:meta])* $seen:vis struct $name:ident { $($places:tt)* }) => {
        $crate::device::places! {
            $(#[$about])* $seen struct $name { $($places)* } |file| {}
        }
    };
    (
        $(#[$about:meta])* $seen:vis struct $name:ident {
            $($(#[$note:meta])* $place:ident: $register:ident $(. $field:ident)?,)*
        }
        |$file:ident| {
            $($(#[$remark:meta])* $other:ident: $kind:ty = $value:expr,)*
        }
    ) => {
        $(#[$about])*
        $seen struct $name {
            $($(#[$note])* pub $place: $crate::device::places!(@kind $($field)?),)*
            $($(#[$remark])* pub $other: $kind,)*
        }

        impl $name {
            /// Finds them.
            pub fn new($file: &$crate::device::RegisterFile) -> Self {
                Self {
                    $($place: $crate::device::places!(@find $file $register $($field)?),)*
                    $($other: $value,)*
                }
            }
        }
    };
}
pub(crate) use places;
