//! What the firmware said before it stopped, kept in RAM that a reset leaves alone.

use super::Words;
use crate::host_link::LAST_WORDS_MAX;
use crc::{CRC_32_ISO_HDLC, Crc};
use heapless::String;

/// Tells a record from whatever RAM holds when the power comes.
const MAGIC: u32 = 0x4c65_6721;

const CRC: Crc<u32> = Crc::<u32>::new(&CRC_32_ISO_HDLC);

/// The record. Every pattern of bits is one, whole or not, so it may lie in memory that nothing has initialised.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LastWords {
    magic: u32,
    failures: u32,
    length: u32,
    text: [u8; LAST_WORDS_MAX],
    checksum: u32,
}

/// What a whole record holds.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Kept {
    /// What was said; empty if the firmware did not stop by itself.
    pub words: String<LAST_WORDS_MAX>,
    /// How often the firmware has stopped by itself without having run well in between.
    pub failures: u32,
}

impl LastWords {
    /// A record of nothing. To keep one of these makes the next start know that the RAM remembers.
    #[must_use]
    pub fn silent(failures: u32) -> Self {
        Self::new(&Words::new(""), failures)
    }

    /// A record of words.
    #[must_use]
    pub fn new(words: &Words, failures: u32) -> Self {
        let mut text = [0; LAST_WORDS_MAX];
        for (place, byte) in text.iter_mut().zip(words.as_str().bytes()) {
            *place = byte;
        }
        let mut record = Self {
            magic: MAGIC,
            failures,
            length: words.as_str().len() as u32,
            text,
            checksum: 0,
        };
        record.checksum = record.sum();
        record
    }

    /// What it holds; `None` if it is not whole.
    #[must_use]
    pub fn read(&self) -> Option<Kept> {
        if self.magic != MAGIC || self.checksum != self.sum() {
            return None;
        }
        let text = self.text.get(..self.length as usize)?;
        let words = core::str::from_utf8(text).ok()?;
        Some(Kept {
            words: String::try_from(words).ok()?,
            failures: self.failures,
        })
    }

    fn sum(&self) -> u32 {
        let mut digest = CRC.digest();
        for word in [self.magic, self.failures, self.length] {
            digest.update(&word.to_le_bytes());
        }
        digest.update(&self.text);
        digest.finalize()
    }
}

#[cfg(test)]
mod tests {
    use super::{Kept, LAST_WORDS_MAX, LastWords, Words};
    use heapless::String;

    fn kept(words: &str, failures: u32) -> Option<Kept> {
        let words = String::try_from(words).ok()?;
        Some(Kept { words, failures })
    }

    #[test]
    fn words_are_kept() {
        let words = Words::new("panicked at ").number(12);
        assert_eq!(LastWords::new(&words, 3).read(), kept("panicked at 12", 3));
        let longest = "x".repeat(LAST_WORDS_MAX);
        let record = LastWords::new(&Words::new(&longest), 1);
        assert_eq!(record.read(), kept(&longest, 1));
        assert_eq!(LastWords::silent(0).read(), kept("", 0));
    }

    #[test]
    fn a_flipped_bit_is_noticed() {
        let whole = LastWords::new(&Words::new("words"), 1);
        for bit in 0..32 {
            for damaged in [
                LastWords {
                    magic: whole.magic ^ 1 << bit,
                    ..whole
                },
                LastWords {
                    failures: whole.failures ^ 1 << bit,
                    ..whole
                },
                LastWords {
                    length: whole.length ^ 1 << bit,
                    ..whole
                },
                LastWords {
                    checksum: whole.checksum ^ 1 << bit,
                    ..whole
                },
            ] {
                assert_eq!(damaged.read(), None);
            }
        }
        for place in 0..LAST_WORDS_MAX {
            let mut damaged = whole;
            damaged.text[place] ^= 4;
            assert_eq!(damaged.read(), None);
        }
    }

    #[test]
    fn ram_that_holds_nothing_is_no_record() {
        for pattern in [0, u32::MAX, 0xaaaa_aaaa] {
            let record = LastWords {
                magic: pattern,
                failures: pattern,
                length: pattern,
                text: [pattern as u8; LAST_WORDS_MAX],
                checksum: pattern,
            };
            assert_eq!(record.read(), None);
        }
    }
}
