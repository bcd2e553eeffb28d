//! Settings in the flash of a chip that has kept them before.

use embassy_futures::block_on;
use embedded_storage_async::nor_flash::{
    ErrorType, NorFlash, NorFlashError, NorFlashErrorKind, ReadNorFlash,
};
use leg_firmware::settings::Settings;
use leg_firmware::store::{FLASH_SIZE, FLASH_START, Loaded, PAGE_SIZE, REGION, Store, WORD_SIZE};
use std::ops::Range;

/// Where a board keeps its settings, addresses.
pub const PLACE: Range<u32> = FLASH_START + REGION.start..FLASH_START + REGION.end;

/// Bytes of the flash from an address on.
#[derive(Clone)]
pub struct Page {
    /// Of the first.
    pub address: u32,
    /// From there on.
    pub bytes: Vec<u8>,
}

impl Page {
    /// Lets a bit of what was written be wrong.
    pub fn corrupt(&mut self) {
        let written = self.bytes.iter().filter(|byte| **byte != 0xff).count();
        let mut bytes = self.bytes.iter_mut().filter(|byte| **byte != 0xff);
        if let Some(byte) = bytes.nth(written / 2) {
            *byte ^= 1;
        }
    }
}

/// What the flash holds after these settings have been kept; none if they are refused.
pub fn page(settings: &Settings) -> Option<Page> {
    let mut flash = Memory(vec![0xff; FLASH_SIZE as usize]);
    block_on(Store::new(&mut flash, REGION).ok()?.save(settings)).ok()?;
    let bytes = flash.0.get(REGION.start as usize..REGION.end as usize)?;
    Some(Page {
        address: PLACE.start,
        bytes: bytes.to_vec(),
    })
}

/// The settings that a board finds in these bytes; none where nothing whole is kept.
pub fn kept(bytes: &[u8]) -> Option<Settings> {
    let mut flash = Memory(vec![0xff; FLASH_SIZE as usize]);
    let place = flash.0.iter_mut().skip(REGION.start as usize);
    place.zip(bytes).for_each(|(to, from)| *to = *from);
    match block_on(Store::new(&mut flash, REGION).ok()?.load()).ok()? {
        Loaded::Settings(settings) => Some(settings),
        Loaded::Empty | Loaded::Corrupt(_) => None,
    }
}

/// A flash in this process's memory.
struct Memory(Vec<u8>);

/// An access outside of it.
#[derive(Debug)]
struct Outside;

impl NorFlashError for Outside {
    fn kind(&self) -> NorFlashErrorKind {
        NorFlashErrorKind::OutOfBounds
    }
}

impl Memory {
    fn place(&mut self, offset: u32, length: usize) -> Result<&mut [u8], Outside> {
        let start = offset as usize;
        self.0.get_mut(start..start + length).ok_or(Outside)
    }
}

impl ErrorType for Memory {
    type Error = Outside;
}

impl ReadNorFlash for Memory {
    const READ_SIZE: usize = 1;

    async fn read(&mut self, offset: u32, bytes: &mut [u8]) -> Result<(), Outside> {
        let place = self.place(offset, bytes.len())?;
        bytes.copy_from_slice(place);
        Ok(())
    }

    fn capacity(&self) -> usize {
        self.0.len()
    }
}

impl NorFlash for Memory {
    const WRITE_SIZE: usize = WORD_SIZE;
    const ERASE_SIZE: usize = PAGE_SIZE;

    async fn erase(&mut self, from: u32, to: u32) -> Result<(), Outside> {
        self.place(from, to.saturating_sub(from) as usize)?
            .fill(0xff);
        Ok(())
    }

    async fn write(&mut self, offset: u32, bytes: &[u8]) -> Result<(), Outside> {
        self.place(offset, bytes.len())?.copy_from_slice(bytes);
        Ok(())
    }
}
