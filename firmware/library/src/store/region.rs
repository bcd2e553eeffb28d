//! Where the settings lie in the STM32G474RE's flash, which is in two banks of 2 KiB pages (dual-bank mode).

use core::ops::Range;

/// Address of the flash.
pub const FLASH_START: u32 = 0x0800_0000;

/// Its size, bytes.
pub const FLASH_SIZE: u32 = 0x8_0000;

/// Where its second bank starts, bytes from [`FLASH_START`]. It can be written while code runs from the first.
pub const BANK_2: u32 = FLASH_SIZE / 2;

/// What is erased at once, bytes.
pub const PAGE_SIZE: usize = 2048;

/// The fewest pages: one that holds the newest record, one that takes the next, and an erased one after it.
pub(super) const PAGES_MIN: usize = 3;

/// What is written at once, bytes.
pub const WORD_SIZE: usize = 8;

/// The last 16 KiB of the second bank, 0x0807_C000 to 0x0808_0000, in bytes from [`FLASH_START`].
///
/// Eight pages of at least one record each: one page is erased for a save, each page for eight, so that 10 000 erases a
/// page last for 80 000 saves. `memory.x` keeps programs out of it.
pub const REGION: Range<u32> = FLASH_SIZE - 0x4000..FLASH_SIZE;
