//! The memory itself: what it holds, and which double words do not agree with their ECC.

use crate::memory_map::FLASH;
use std::collections::BTreeSet;
use std::ops::Range;

/// Address of the memory.
pub const START: u32 = FLASH.start;

/// Its size, bytes.
pub const SIZE: u32 = FLASH.end - FLASH.start;

/// What is programmed at once, bytes.
pub const DOUBLE_WORD: u32 = 8;

/// What every byte is after an erase.
const ERASED: u8 = 0xff;

/// 512 KiB of flash; offsets are from its start.
#[derive(Clone, Debug)]
pub struct Array {
    bytes: Vec<u8>,
    /// The double words with more than one wrong bit, by the offset of their first byte.
    damaged: BTreeSet<u32>,
    /// Those with one wrong bit, which the chip corrects as it reads them.
    weak: BTreeSet<u32>,
}

impl Default for Array {
    fn default() -> Self {
        Self {
            bytes: vec![ERASED; SIZE as usize],
            damaged: BTreeSet::new(),
            weak: BTreeSet::new(),
        }
    }
}

/// The start of the double word that an offset is in.
pub const fn double_word_of(offset: u32) -> u32 {
    offset & !(DOUBLE_WORD - 1)
}

impl Array {
    /// The bytes of a range; none if it leaves the memory.
    #[must_use]
    pub fn bytes(&self, range: Range<u32>) -> Option<&[u8]> {
        self.bytes.get(range.start as usize..range.end as usize)
    }

    fn bytes_mut(&mut self, range: Range<u32>) -> Option<&mut [u8]> {
        self.bytes.get_mut(range.start as usize..range.end as usize)
    }

    /// Up to four bytes, the lowest address in the lowest byte; what is outside reads as zero.
    #[must_use]
    pub fn value(&self, offset: u32, width: u32) -> u32 {
        let range = offset..offset.saturating_add(width);
        let bytes = self.bytes(range).unwrap_or_default();
        bytes
            .iter()
            .rev()
            .fold(0, |value, byte| value << 8 | u32::from(*byte))
    }

    /// A double word, as it is stored.
    #[must_use]
    pub fn double_word(&self, offset: u32) -> u64 {
        let low = self.value(offset, 4);
        let high = self.value(offset + 4, 4);
        u64::from(high) << 32 | u64::from(low)
    }

    /// Whether a double word does not agree with its ECC.
    #[must_use]
    pub fn is_damaged(&self, offset: u32) -> bool {
        !self.damaged.is_empty() && self.damaged.contains(&double_word_of(offset))
    }

    /// Whether a double word has one wrong bit.
    #[must_use]
    pub fn is_weak(&self, offset: u32) -> bool {
        !self.weak.is_empty() && self.weak.contains(&double_word_of(offset))
    }

    /// Lets a bit of a double word be wrong: it is read as it was.
    pub fn weaken(&mut self, offset: u32) {
        if offset < SIZE {
            self.weak.insert(double_word_of(offset));
        }
    }

    /// Lets a double word disagree with its ECC.
    pub fn damage(&mut self, offset: u32) {
        if offset < SIZE {
            self.damaged.insert(double_word_of(offset));
        }
    }

    /// Sets bytes, whatever was there; false, and nothing is set, if they leave the memory.
    pub fn load(&mut self, offset: u32, bytes: &[u8]) -> bool {
        let Some(end) = u32::try_from(bytes.len())
            .ok()
            .and_then(|length| offset.checked_add(length))
        else {
            return false;
        };
        let Some(place) = self.bytes_mut(offset..end) else {
            return false;
        };
        place.copy_from_slice(bytes);
        for words in [&mut self.damaged, &mut self.weak] {
            words.retain(|word| *word + DOUBLE_WORD <= offset || *word >= end);
        }
        true
    }

    /// Whether the chip programs `value` there: over ones, or all zeros over anything.
    #[must_use]
    pub fn takes(&self, offset: u32, value: u64) -> bool {
        value == 0 || self.double_word(offset) == u64::MAX
    }

    /// Programs a double word: bits can only become zero. All zeros agree with an ECC of zeros, whatever was there: ST's
    /// X-CUBE-EEPROM mends damaged double words so.
    pub fn program(&mut self, offset: u32, value: u64) {
        let stored = self.double_word(offset) & value;
        self.set(offset, stored);
        if value == 0 {
            self.damaged.remove(&offset);
            self.weak.remove(&offset);
        }
    }

    /// Sets a double word, and leaves what its ECC says.
    pub fn set(&mut self, offset: u32, value: u64) {
        if let Some(place) = self.bytes_mut(offset..offset + DOUBLE_WORD) {
            place.copy_from_slice(&value.to_le_bytes());
        }
    }

    /// Erases a range of whole double words.
    pub fn erase(&mut self, range: Range<u32>) {
        for words in [&mut self.damaged, &mut self.weak] {
            words.retain(|word| !range.contains(word));
        }
        if let Some(place) = self.bytes_mut(range) {
            place.fill(ERASED);
        }
    }
}
