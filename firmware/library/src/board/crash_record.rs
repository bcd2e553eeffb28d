//! The crash report: why the firmware stopped by itself, kept in RAM that a reset leaves alone.

use super::ShortText;
use crate::host_link::CRASH_REPORT_MAX;
use crc::{CRC_32_ISO_HDLC, Crc};
use heapless::String;

/// Distinguishes a record from what RAM holds at power-up.
const MAGIC: u32 = 0x4c65_6721;

const CRC: Crc<u32> = Crc::<u32>::new(&CRC_32_ISO_HDLC);

/// The record. Every pattern of bits is one, whole or not, so it may lie in memory that nothing has initialised.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CrashRecord {
    magic: u32,
    failures: u32,
    length: u32,
    text: [u8; CRASH_REPORT_MAX],
    checksum: u32,
}

/// What a whole record holds.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CrashReport {
    /// The report; empty if the firmware did not stop by itself.
    pub text: String<CRASH_REPORT_MAX>,
    /// How often the firmware has stopped by itself without having run well in between.
    pub failures: u32,
}

impl CrashRecord {
    /// A record of nothing. To keep one of these makes the next start know that the RAM remembers.
    #[must_use]
    pub fn empty(failures: u32) -> Self {
        Self::new(&ShortText::new(""), failures)
    }

    /// A record of a report.
    #[must_use]
    pub fn new(report: &ShortText, failures: u32) -> Self {
        let mut text = [0; CRASH_REPORT_MAX];
        for (place, byte) in text.iter_mut().zip(report.as_str().bytes()) {
            *place = byte;
        }
        let mut record = Self {
            magic: MAGIC,
            failures,
            length: report.as_str().len() as u32,
            text,
            checksum: 0,
        };
        record.checksum = record.sum();
        record
    }

    /// What it holds; `None` if it is not whole.
    #[must_use]
    pub fn read(&self) -> Option<CrashReport> {
        if self.magic != MAGIC || self.checksum != self.sum() {
            return None;
        }
        let text = self.text.get(..self.length as usize)?;
        let report = core::str::from_utf8(text).ok()?;
        Some(CrashReport {
            text: String::try_from(report).ok()?,
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
    use super::{CRASH_REPORT_MAX, CrashRecord, CrashReport, ShortText};
    use heapless::String;

    fn kept(report: &str, failures: u32) -> Option<CrashReport> {
        let report = String::try_from(report).ok()?;
        Some(CrashReport {
            text: report,
            failures,
        })
    }

    #[test]
    fn a_report_is_kept() {
        let report = ShortText::new("panicked at ").number(12);
        assert_eq!(
            CrashRecord::new(&report, 3).read(),
            kept("panicked at 12", 3)
        );
        let longest = "x".repeat(CRASH_REPORT_MAX);
        let record = CrashRecord::new(&ShortText::new(&longest), 1);
        assert_eq!(record.read(), kept(&longest, 1));
        assert_eq!(CrashRecord::empty(0).read(), kept("", 0));
    }

    #[test]
    fn a_flipped_bit_is_noticed() {
        let whole = CrashRecord::new(&ShortText::new("text"), 1);
        for bit in 0..32 {
            for damaged in [
                CrashRecord {
                    magic: whole.magic ^ 1 << bit,
                    ..whole
                },
                CrashRecord {
                    failures: whole.failures ^ 1 << bit,
                    ..whole
                },
                CrashRecord {
                    length: whole.length ^ 1 << bit,
                    ..whole
                },
                CrashRecord {
                    checksum: whole.checksum ^ 1 << bit,
                    ..whole
                },
            ] {
                assert_eq!(damaged.read(), None);
            }
        }
        for place in 0..CRASH_REPORT_MAX {
            let mut damaged = whole;
            damaged.text[place] ^= 4;
            assert_eq!(damaged.read(), None);
        }
    }

    #[test]
    fn ram_that_holds_nothing_is_no_record() {
        for pattern in [0, u32::MAX, 0xaaaa_aaaa] {
            let record = CrashRecord {
                magic: pattern,
                failures: pattern,
                length: pattern,
                text: [pattern as u8; CRASH_REPORT_MAX],
                checksum: pattern,
            };
            assert_eq!(record.read(), None);
        }
    }
}
