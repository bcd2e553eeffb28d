//! What the processor writes: keys, commands, and the halves of double words.

use super::array::{DOUBLE_WORD, SIZE, START, double_word_of};
use super::operation::Operation;
use super::{Flash, Keys};
use crate::device::{Context, FieldPlace};
use crate::memory_map::BANK_SIZE;

/// What opens CR, in this order: RM0440, FLASH_KEYR.
const KEYS: [u32; 2] = [0x4567_0123, 0xcdef_89ab];

/// Pages with two banks and with one: RM0440, organisation of the flash of category 3.
const PAGE: u32 = 2048;
const SINGLE_BANK_PAGE: u32 = 4096;

impl Flash {
    pub(super) fn write_register(&mut self, offset: u32, value: u32, context: &mut Context<'_>) {
        match offset {
            _ if offset == self.offsets.acr => self.write_access(value, context),
            _ if offset == self.offsets.keyr => self.write_key(value, context),
            _ if offset == self.offsets.sr => self.clear_status(value),
            _ if offset == self.offsets.cr => self.write_command(value, context),
            _ if offset == self.offsets.eccr => self.write_ecc(value),
            _ if offset == self.offsets.pdkeyr || offset == self.offsets.optkeyr => context
                .findings
                .add("FLASH_PDKEYR or FLASH_OPTKEYR is written: power-down and option bytes are not for this image"),
            _ => context.findings.add(format!(
                "FLASH: the register at {offset:#04x} is written while the option bytes are locked"
            )),
        }
    }

    fn write_access(&mut self, value: u32, context: &mut Context<'_>) {
        let s = &self.settings;
        for (cache, reset, name) in [
            (s.data_cache, s.data_cache_reset, "DCRST"),
            (s.instruction_cache, s.instruction_cache_reset, "ICRST"),
        ] {
            if value & reset.mask != 0 && self.registers.is_set(cache) {
                context.findings.add(format!(
                    "FLASH_ACR: {name} is set while that cache is on, and has no effect"
                ));
            }
        }
        self.registers.set(self.offsets.acr, value);
    }

    fn write_key(&mut self, key: u32, context: &mut Context<'_>) {
        let locked = self.registers.is_set(self.settings.lock);
        self.keys = match (self.keys, key) {
            (Keys::First, key) if locked && key == KEYS[0] => Keys::Second,
            (Keys::Second, key) if key == KEYS[1] => {
                self.registers.set_value(self.settings.lock, 0);
                Keys::First
            }
            _ => {
                let why = match (self.keys, locked) {
                    (Keys::Refused, _) => "a key is written after a wrong one",
                    (_, false) => "a key is written while FLASH_CR is open",
                    _ => "a wrong key is written",
                };
                context.findings.add(format!(
                    "FLASH_KEYR: {why}; FLASH_CR is locked until the next reset"
                ));
                self.registers.set_value(self.settings.lock, 1);
                Keys::Refused
            }
        };
    }

    fn clear_status(&mut self, value: u32) {
        let status = self.registers.get(self.offsets.sr);
        let cleared = value & self.flags.clearable;
        self.registers.set(self.offsets.sr, status & !cleared);
    }

    fn write_ecc(&mut self, value: u32) {
        let enable = self.flags.ecc_interrupt.mask;
        let cleared = value & self.flags.ecc_clearable;
        let kept = self.registers.get(self.offsets.eccr) & !cleared & !enable;
        self.registers.set(self.offsets.eccr, kept | value & enable);
    }

    fn write_command(&mut self, value: u32, context: &mut Context<'_>) {
        let old = self.registers.get(self.offsets.cr);
        if self.registers.is_set(self.settings.lock) {
            if value != old {
                context
                    .findings
                    .add("FLASH_CR is written while it is locked");
            }
            return;
        }
        if self.running.is_some() {
            context
                .findings
                .add("FLASH_CR is written while FLASH_SR says busy");
            return;
        }
        // Only a reset or the option keys clear OPTLOCK.
        let value = value | old & self.settings.option_lock.mask;
        self.registers.set(self.offsets.cr, value);
        if value & self.settings.program.mask == 0 {
            self.first_half = None;
        }
        let s = &self.settings;
        if value & (s.option_start.mask | s.fast.mask | s.option_load.mask) != 0 {
            context.findings.add(
                "FLASH_CR: fast programming or a change of the option bytes is asked for, which this image must not",
            );
        }
        if value & s.start.mask != 0 {
            self.start_erase(value, context);
        }
    }

    fn start_erase(&mut self, command: u32, context: &mut Context<'_>) {
        let s = &self.settings;
        let asked = |field: FieldPlace| command & field.mask != 0;
        let banks = (asked(s.erase_bank_1), asked(s.erase_bank_2));
        let pages = asked(s.page_erase);
        let range = match (pages, banks) {
            (true, (false, false)) if self.dual_bank => {
                let start = s.bank.extract(command) * BANK_SIZE + s.page.extract(command) * PAGE;
                Some(start..start + PAGE)
            }
            (true, (false, false)) => {
                let start = s.page.extract(command) * SINGLE_BANK_PAGE;
                Some(start..start + SINGLE_BANK_PAGE)
            }
            (false, (true, true)) => Some(0..SIZE),
            (false, (true, false)) if self.dual_bank => Some(0..BANK_SIZE),
            (false, (false, true)) if self.dual_bank => Some(BANK_SIZE..SIZE),
            _ => None,
        };
        match range {
            Some(range) if !asked(s.program) => self.start(Operation::Erase(range), context),
            _ => {
                context
                    .findings
                    .add("FLASH_CR: STRT is set without just one of PG, PER and MER");
                self.refuse(self.flags.sequence);
            }
        }
    }

    /// Half of a double word is written.
    pub(super) fn write_half(
        &mut self,
        address: u32,
        width: u32,
        value: u32,
        context: &mut Context<'_>,
    ) {
        let offset = address.wrapping_sub(START);
        let enabled = self.registers.is_set(self.settings.program);
        let first = self.first_half.take();
        let wrong = if self.running.is_some() {
            Some(("while FLASH_SR says busy", self.flags.sequence))
        } else if self.registers.is_set(self.settings.lock) {
            Some(("while FLASH_CR is locked", self.flags.sequence))
        } else if !enabled {
            Some(("without PG in FLASH_CR", self.flags.sequence))
        } else if width != 4 {
            Some(("by less than a word", self.flags.size))
        } else if !offset.is_multiple_of(4) || offset >= SIZE {
            Some(("outside of a double word", self.flags.alignment))
        } else {
            None
        };
        if let Some((how, flag)) = wrong {
            context
                .findings
                .add(format!("FLASH: {address:#010x} is written {how}"));
            self.refuse(flag);
            return;
        }
        match first {
            None if offset.is_multiple_of(DOUBLE_WORD) => self.first_half = Some((offset, value)),
            Some((start, low)) if offset == start + 4 => {
                let value = u64::from(value) << 32 | u64::from(low);
                let offset = start;
                self.start(Operation::Program { offset, value }, context);
            }
            _ => {
                context.findings.add(format!(
                    "FLASH: the write to {address:#010x} is not a double word with the one before"
                ));
                self.refuse(self.flags.alignment);
            }
        }
    }

    /// Starts an operation, unless something forbids it.
    fn start(&mut self, operation: Operation, context: &mut Context<'_>) {
        let what = operation.describe();
        if self.registers.get(self.offsets.sr) & self.flags.errors != 0 {
            context.findings.add(format!(
                "FLASH_SR: errors were not cleared before {what}, which does not start"
            ));
            self.refuse(self.flags.sequence);
            return;
        }
        if let Operation::Program { offset, value } = operation
            && !self.array.takes(offset, value)
        {
            context
                .findings
                .add(format!("FLASH: {what} finds it not erased"));
            self.refuse(self.flags.not_erased);
            return;
        }
        self.check(&operation, &what, context);
        let end = context.cycle + operation.cycles(context.clocks);
        self.registers.set_value(self.flags.busy, 1);
        self.running = Some((operation, end));
        self.operations += 1;
    }

    /// What is allowed, and yet wrong.
    fn check(&self, operation: &Operation, what: &str, context: &mut Context<'_>) {
        if self.touches_program(operation) {
            context
                .findings
                .add(format!("FLASH: {what} touches a page of the program"));
        } else if self.stalls_program(operation) {
            context.findings.add(format!(
                "FLASH: {what} stalls the program, which runs from the same bank"
            ));
        }
        // ST's own driver (HAL_FLASH_Program, HAL_FLASHEx_Erase) switches it off "to avoid data misbehavior".
        if self.registers.is_set(self.settings.data_cache) {
            context.findings.add(
                "FLASH_ACR: the data cache is on during programming or an erase, which may corrupt what it holds",
            );
        }
    }

    fn stalls_program(&self, operation: &Operation) -> bool {
        let start = self.program.start.saturating_sub(START);
        !self.program.is_empty() && operation.occupies(start, self.dual_bank)
    }

    fn touches_program(&self, operation: &Operation) -> bool {
        let page = if self.dual_bank {
            PAGE
        } else {
            SINGLE_BANK_PAGE
        };
        let start = double_word_of(self.program.start.saturating_sub(START));
        let end = self.program.end.saturating_sub(START);
        let range = operation.range();
        let first_page = start / page * page;
        range.start < end.next_multiple_of(page) && range.end > first_page && start < end
    }

    /// An operation fails.
    fn refuse(&mut self, flag: FieldPlace) {
        self.registers.set_value(flag, 1);
        self.registers.set_value(self.settings.start, 0);
        // RM0440, FLASH_SR: the flag is set only if its interrupt is enabled.
        if self.registers.is_set(self.settings.error_interrupt) {
            self.registers.set_value(self.flags.operation_error, 1);
        }
    }
}
