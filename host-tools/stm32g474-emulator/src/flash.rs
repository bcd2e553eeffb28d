//! The flash and its controller: 512 KiB in two banks.
//!
//! | module | what is in it |
//! |---|---|
//! | [`mod@array`] | the memory |
//! | [`operation`] | programming and erasing, and what a loss of power leaves of it |
//!
//! Not modelled: fast programming, option bytes that change, write and read protection, caches that
//! hold old data.

pub mod array;
mod control;
pub mod operation;
mod places;
#[cfg(test)]
mod tests;

use crate::device::{Context, Device, FieldPlace, RegisterFile};
use crate::facts::Facts;
use crate::memory_map::BANK_SIZE;
use array::{Array, DOUBLE_WORD, SIZE, START, double_word_of};
use fastrand::Rng;
use operation::Operation;
use places::{FlashFlags, FlashOffsets, FlashSettings};
use std::ops::Range;

/// The flash with its registers.
#[derive(Clone, Debug)]
pub struct Flash {
    registers: RegisterFile,
    offsets: FlashOffsets,
    settings: FlashSettings,
    flags: FlashFlags,
    array: Array,
    dual_bank: bool,
    keys: Keys,
    /// The first half of a double word: its offset and value.
    first_half: Option<(u32, u32)>,
    /// What is in progress, and the cycle in which it ends.
    running: Option<(Operation, u64)>,
    /// How many there were.
    operations: u64,
    /// Where the program lies, addresses.
    program: Range<u32>,
    /// The cycle until which an access of the processor waits.
    stall: Option<u64>,
    brown_out_level: u8,
    chance: Rng,
}

/// The supply below which the chip is reset, by the option bytes' BOR_LEV, mV: STM32G474 datasheet (DS12288), falling, typical
/// (by memory of the datasheet).
const BROWN_OUT_MV: [u32; 5] = [1_640, 2_000, 2_200, 2_520, 2_810];

/// How far the lock of CR is open.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Keys {
    /// The first key is awaited.
    First,
    /// The second key is awaited.
    Second,
    /// A wrong key was written: locked until a reset.
    Refused,
}

impl Flash {
    /// An erased flash; `dual_bank` and `brown_out_level` are the option bytes DBANK and BOR_LEV, and `seed` chooses what a loss
    /// of power leaves.
    ///
    /// # Panics
    /// If the facts do not know the controller's registers.
    #[must_use]
    pub fn new(dual_bank: bool, brown_out_level: u8, seed: u64) -> Self {
        let Some(block) = Facts::chip().block("FLASH") else {
            panic!("the facts have no block FLASH");
        };
        let registers = RegisterFile::new(block);
        let mut flash = Self {
            offsets: FlashOffsets::new(&registers),
            settings: FlashSettings::new(&registers),
            flags: FlashFlags::new(&registers),
            registers,
            array: Array::default(),
            dual_bank,
            keys: Keys::First,
            first_half: None,
            running: None,
            operations: 0,
            program: 0..0,
            stall: None,
            brown_out_level,
            chance: Rng::with_seed(seed),
        };
        flash.reset();
        flash
    }

    /// Says where the program lies that runs, addresses: whatever touches a page of it is a finding.
    pub fn set_program(&mut self, addresses: Range<u32>) {
        self.program = addresses;
    }

    /// Sets bytes from an address on, as a programmer does; false, and nothing is set, if they leave the flash.
    pub fn load(&mut self, address: u32, bytes: &[u8]) -> bool {
        match address.checked_sub(START) {
            Some(offset) => self.array.load(offset, bytes),
            None => false,
        }
    }

    /// What the flash holds in a range of addresses; none if that leaves the flash.
    #[must_use]
    pub fn bytes(&self, addresses: Range<u32>) -> Option<&[u8]> {
        let start = addresses.start.checked_sub(START)?;
        self.array.bytes(start..addresses.end.checked_sub(START)?)
    }

    /// The memory.
    #[must_use]
    pub fn array(&self) -> &Array {
        &self.array
    }

    /// How many double words and pages were begun to be programmed or erased.
    #[must_use]
    pub fn operations(&self) -> u64 {
        self.operations
    }

    /// Lets the double word of an address disagree with its ECC.
    pub fn damage(&mut self, address: u32) {
        self.array.damage(address.wrapping_sub(START));
    }

    /// Lets the double word of an address have one wrong bit, which the chip corrects.
    pub fn weaken(&mut self, address: u32) {
        self.array.weaken(address.wrapping_sub(START));
    }

    /// The processor reads one, two or four bytes of the memory.
    pub fn read_array(&mut self, address: u32, width: u32, context: &mut Context<'_>) -> u32 {
        let offset = address.wrapping_sub(START);
        if self.running.is_some() {
            self.settle(context.cycle);
            self.stall = self.stall_until(address);
            // The access ends with the operation, and gives what there is then.
            self.settle(self.stall.unwrap_or_default());
        }
        let flags = &self.flags;
        if self.array.is_damaged(offset) {
            self.note_error(offset, [flags.ecc_detected, flags.ecc_detected_above]);
        } else if self.array.is_weak(offset) {
            self.note_error(offset, [flags.ecc_corrected, flags.ecc_corrected_above]);
        }
        self.array.value(offset, width)
    }

    /// The processor writes to the memory.
    pub fn write_array(&mut self, address: u32, width: u32, value: u32, context: &mut Context<'_>) {
        self.settle(context.cycle);
        self.write_half(address, width, value, context);
    }

    /// The wait states that ACR asks for.
    #[must_use]
    pub fn latency(&self) -> u32 {
        self.registers.value(self.settings.latency)
    }

    /// The cycle until which an access to an address waits, because its bank is being programmed or erased.
    #[must_use]
    pub fn stall_until(&self, address: u32) -> Option<u64> {
        let offset = address.checked_sub(START).filter(|at| *at < SIZE)?;
        let (operation, end) = self.running.as_ref()?;
        operation.occupies(offset, self.dual_bank).then_some(*end)
    }

    /// The cycle until which an access since the last question waits.
    pub fn take_stall(&mut self) -> Option<u64> {
        self.stall.take()
    }

    /// The supply below which the chip is reset, mV.
    #[must_use]
    pub fn brown_out_mv(&self) -> u32 {
        let level = BROWN_OUT_MV.get(usize::from(self.brown_out_level));
        level.copied().unwrap_or_default()
    }

    /// Whether a double word with two wrong bits was read, and the program has not cleared its flag: an NMI is asked for.
    #[must_use]
    pub fn nmi(&self) -> bool {
        let mut flags = [self.flags.ecc_detected, self.flags.ecc_detected_above].into_iter();
        flags.any(|flag| self.registers.is_set(flag))
    }

    /// Whether the interrupt line `FLASH` is active.
    #[must_use]
    pub fn interrupt(&self) -> bool {
        let both = |flag, enable| self.registers.is_set(flag) && self.registers.is_set(enable);
        both(self.flags.end, self.settings.end_interrupt)
            || both(self.flags.operation_error, self.settings.error_interrupt)
            || both(self.flags.ecc_corrected, self.flags.ecc_interrupt)
    }

    /// The supply fails: what is in progress stays half done. A reset does the same.
    pub fn cut_power(&mut self) {
        if let Some((operation, _)) = self.running.take() {
            operation.interrupt(&mut self.array, &mut self.chance);
        }
    }

    /// A double word with wrong bits was read: sets the flag of its half of four words. The place is that of the first error since the flags were
    /// cleared, a corrected one, too: RM0440, FLASH_ECCR.
    fn note_error(&mut self, offset: u32, [below, above]: [FieldPlace; 2]) {
        let offset = double_word_of(offset);
        let in_lower_half = self.dual_bank || offset.is_multiple_of(2 * DOUBLE_WORD);
        let flag = if in_lower_half { below } else { above };
        let before = self.registers.get(self.offsets.eccr) & self.flags.ecc_clearable;
        self.registers.set_value(flag, 1);
        if before != 0 {
            return;
        }
        let bank_2 = self.dual_bank && offset >= BANK_SIZE;
        // Bytes from the start of the bank. By memory of the manual; drivers for the STM32U5, whose field is alike, read it so.
        let address = if bank_2 { offset - BANK_SIZE } else { offset };
        self.registers.set_value(self.flags.ecc_address, address);
        let bank = u32::from(bank_2);
        self.registers.set_value(self.flags.ecc_bank, bank);
        self.registers.set_value(self.flags.ecc_system, 0);
    }

    /// Ends what is due.
    fn settle(&mut self, cycle: u64) {
        if self.running.as_ref().is_none_or(|(_, end)| cycle < *end) {
            return;
        }
        if let Some((operation, _)) = self.running.take() {
            operation.complete(&mut self.array);
        }
        self.registers.set_value(self.flags.busy, 0);
        self.registers.set_value(self.settings.start, 0);
        // RM0440, FLASH_SR: the flag is set only if its interrupt is enabled.
        if self.registers.is_set(self.settings.end_interrupt) {
            self.registers.set_value(self.flags.end, 1);
        }
    }
}

impl Device for Flash {
    fn reset(&mut self) {
        self.cut_power();
        self.registers.reset();
        let dual_bank = u32::from(self.dual_bank);
        self.registers.set_value(self.flags.dual_bank, dual_bank);
        let level = u32::from(self.brown_out_level);
        self.registers.set_value(self.flags.brown_out_level, level);
        self.keys = Keys::First;
        self.first_half = None;
        self.stall = None;
    }

    fn read(&mut self, offset: u32, context: &mut Context<'_>) -> u32 {
        self.settle(context.cycle);
        self.registers.get(offset)
    }

    fn write(&mut self, offset: u32, value: u32, context: &mut Context<'_>) {
        self.settle(context.cycle);
        self.write_register(offset, value, context);
    }

    fn next_event(&self) -> Option<u64> {
        self.running.as_ref().map(|(_, end)| *end)
    }

    fn advance(&mut self, context: &mut Context<'_>) {
        self.settle(context.cycle);
    }
}
