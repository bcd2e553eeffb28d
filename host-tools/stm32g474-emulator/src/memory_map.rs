//! Where the chip has what: RM0440, memory map of a chip with 512 KiB of flash.

use std::ops::Range;

/// The flash.
pub const FLASH: Range<u32> = 0x0800_0000..0x0808_0000;

/// Half of the flash: its banks, bytes.
pub const BANK_SIZE: u32 = (FLASH.end - FLASH.start) / 2;

/// Where the second bank of the flash is.
pub const SECOND_BANK: u32 = FLASH.start + BANK_SIZE;

/// The CCM.
pub const CCM: Range<u32> = 0x1000_0000..0x1000_8000;

/// SRAM1 and SRAM2, and behind them the other address of the CCM.
pub const RAM: Range<u32> = 0x2000_0000..0x2002_0000;

/// The peripherals.
pub const PERIPHERALS: Range<u32> = 0x4000_0000..0x6000_0000;

/// DBGMCU, among the processor's own.
pub const DEBUG: Range<u32> = 0xe004_2000..0xe004_2400;
