//! What takes the flash its time, and what a loss of power leaves of it.

use super::array::{Array, DOUBLE_WORD, START};
use crate::clocks::Clocks;
use crate::memory_map::BANK_SIZE;
use fastrand::Rng;
use std::ops::Range;

/// Time to program a double word, µs. STM32G474 datasheet (DS12288), table "Flash memory characteristics": 81.7 typical.
/// By memory of the datasheet.
const PROGRAM_US: u64 = 82;

/// Time to erase a page or a bank, µs. The same table: 22.0 ms typical for both. By memory of the datasheet.
const ERASE_US: u64 = 22_000;

/// An operation in progress; offsets are from the start of the flash.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Operation {
    /// A double word is programmed.
    Program {
        /// Its first byte.
        offset: u32,
        /// What it will hold.
        value: u64,
    },
    /// A page, a bank or both are erased.
    Erase(Range<u32>),
}

impl Operation {
    /// Cycles that it takes.
    #[must_use]
    pub fn cycles(&self, clocks: &Clocks) -> u64 {
        let microseconds = match self {
            Self::Program { .. } => PROGRAM_US,
            Self::Erase(_) => ERASE_US,
        };
        clocks.cycles(microseconds, 1_000_000).unwrap_or_default()
    }

    /// What it changes.
    #[must_use]
    pub fn range(&self) -> Range<u32> {
        match self {
            Self::Program { offset, .. } => *offset..*offset + DOUBLE_WORD,
            Self::Erase(range) => range.clone(),
        }
    }

    /// Whether it keeps the bank of an offset busy.
    #[must_use]
    pub fn occupies(&self, offset: u32, dual_bank: bool) -> bool {
        let range = self.range();
        let of_bank = |offset: u32| offset / BANK_SIZE;
        let whole = of_bank(range.start) != of_bank(range.end.saturating_sub(1));
        !dual_bank || whole || of_bank(range.start) == of_bank(offset)
    }

    /// Does it.
    pub fn complete(self, array: &mut Array) {
        match self {
            Self::Program { offset, value } => array.program(offset, value),
            Self::Erase(range) => array.erase(range),
        }
    }

    /// Leaves what a loss of power in its midst may leave.
    pub fn interrupt(self, array: &mut Array, chance: &mut Rng) {
        match self {
            Self::Program { offset, value } => half_program(array, offset, value, chance),
            Self::Erase(range) => half_erase(array, range, chance),
        }
    }

    /// What it does, for a finding.
    #[must_use]
    pub fn describe(&self) -> String {
        let address = START + self.range().start;
        match self {
            Self::Program { .. } => format!("the programming of {address:#010x}"),
            Self::Erase(range) => {
                let kib = (range.end - range.start) / 1024;
                format!("the erase of {kib} KiB from {address:#010x} on")
            }
        }
    }
}

/// Nothing, all of it, or some of its bits and an ECC that does not agree.
fn half_program(array: &mut Array, offset: u32, value: u64, chance: &mut Rng) {
    match chance.u8(..3) {
        0 => {}
        1 => array.program(offset, value),
        _ => {
            array.program(offset, value | chance.u64(..));
            array.damage(offset);
        }
    }
}

/// Each double word is as it was, erased, or anything between with an ECC that does not agree; in some pages one of
/// them prevails.
fn half_erase(array: &mut Array, range: Range<u32>, chance: &mut Rng) {
    let progress = chance.u8(..5);
    for offset in range.step_by(DOUBLE_WORD as usize) {
        match chance.u8(..4) {
            turn if turn < progress => array.erase(offset..offset + DOUBLE_WORD),
            turn if turn == progress => {
                array.set(offset, array.double_word(offset) | chance.u64(..));
                array.damage(offset);
            }
            _ => {}
        }
    }
}
