//! Settings that outlast a loss of power, in flash.
//!
//! A record is the hash of the type [`Settings`], the settings in postcard's format and a CRC-32. Records
//! are appended, page by page in turn, by `sequential-storage`, which has a CRC of its own and goes back to the newest
//! whole record; under it a seal on every page makes erasing whole or not at all. If power fails during a
//! [`save`](Store::save), the next [`load`](Store::load) gives the old settings or the new ones.
//!
//! Assumed of the flash, as the mock flash of the tests behaves:
//! - An interrupted write leaves its double word with some of its bits written; one that still reads as erased may be
//!   written again. An interrupted erase leaves anything in its page. What was read once is read again.
//! - Zeros may be written over any double word, as the STM32G4 allows; otherwise each is written once.
//!
//! Not shown: how the STM32G4 itself behaves. Its flash has an ECC for each double word. One that was half written or
//! half erased may not agree with its ECC, and to read it raises the NMI; it may also read differently from one time to
//! the next, or read as erased and refuse a write ([`StoreError::Flash`]; [`Store::clear`] ends that). So the board has
//! to survive the NMI, and should save only at rest and with the supply in its range.
//!
//! A flipped bit that the ECC does not correct costs the record it is in: an older one is loaded, if there is any, and
//! nothing shows that it is older.

mod error;
mod max_size;
mod record;
mod region;
mod sealed;

#[cfg(test)]
mod tests;

pub use error::{CorruptReason, Loaded, StoreError};
pub use record::{RECORD_MAX, SETTINGS_MAX, SETTINGS_SCHEMA};
pub use region::{BANK_2, FLASH_SIZE, FLASH_START, PAGE_SIZE, REGION, WORD_SIZE};

use crate::settings::Settings;
use core::ops::Range;
use embedded_storage_async::nor_flash::NorFlash;
use record::Packed;
use region::PAGES_MIN;
use sealed::Sealed;
use sequential_storage::Error;
use sequential_storage::cache::{Cache, Uncached};
use sequential_storage::map::{MapConfig, MapStorage};

/// One value needs no key.
const KEY: () = ();

/// Stored by [`Store::clear`]: newer than the settings before it, and none.
const CLEARED: &[u8] = &[];

/// The settings kept in flash.
///
/// To drop a future of its methods before it is done is like a loss of power.
pub struct Store<F: NorFlash> {
    map: MapStorage<(), Sealed<F>, Cache<Uncached, Uncached, Uncached>>,
    /// As long as a page, so that whatever length a damaged header claims can be read.
    buffer: [u8; PAGE_SIZE],
}

impl<F: NorFlash> Store<F> {
    /// A store in part of a flash with words of [`WORD_SIZE`] and pages of at most [`PAGE_SIZE`] bytes; the range is in
    /// bytes from the start of the flash, as [`REGION`]. Nothing is read yet.
    ///
    /// # Errors
    /// [`StoreError::Region`] unless the range is at least three whole pages inside the flash.
    pub fn new(flash: F, range: Range<u32>) -> Result<Self, StoreError<F::Error>> {
        if range.len() < PAGES_MIN * F::ERASE_SIZE {
            return Err(StoreError::Region);
        }
        let sealed = Sealed::new(flash, range).ok_or(StoreError::Region)?;
        let config = MapConfig::try_new(sealed.range()).map_err(|_| StoreError::Region)?;
        Ok(Self {
            map: MapStorage::new(sealed, config, Cache::new_uncached()),
            buffer: [0; PAGE_SIZE],
        })
    }

    /// Reads the newest settings. Finishes what a loss of power left undone, so it may write.
    ///
    /// # Errors
    /// [`StoreError::Flash`].
    pub async fn load(&mut self) -> Result<Loaded, StoreError<F::Error>> {
        // Asked first: what is repaired while reading may end up erased.
        if self.is_blank().await? {
            return Ok(Loaded::Empty);
        }
        match self.map.fetch_item(&mut self.buffer, &KEY).await {
            Ok(Some(record)) => Ok(loaded(record)),
            Err(Error::Storage { value, .. }) => Err(StoreError::Flash(value)),
            Ok(None) | Err(_) => Ok(Loaded::Corrupt(CorruptReason::Storage)),
        }
    }

    /// Writes the settings; they are the newest once this returns.
    ///
    /// The mechanism in them is not checked here but where it is built.
    ///
    /// # Errors
    /// [`StoreError::Settings`] if [`Settings::check`] refuses them, [`StoreError::Flash`], [`StoreError::Storage`].
    pub async fn save(&mut self, settings: &Settings) -> Result<(), StoreError<F::Error>> {
        settings.check().map_err(StoreError::Settings)?;
        let packed = Packed(settings);
        let stored = self.map.store_item(&mut self.buffer, &KEY, &packed).await;
        stored.map_err(StoreError::from)
    }

    /// Leaves nothing to load: afterwards [`load`](Self::load) gives [`Loaded::Empty`].
    ///
    /// Old records stay in the flash until their pages are used again. Only where nothing can be stored any more, all
    /// pages are erased; a loss of power meanwhile may leave older settings.
    ///
    /// # Errors
    /// [`StoreError::Flash`].
    pub async fn clear(&mut self) -> Result<(), StoreError<F::Error>> {
        let stored = self.map.store_item(&mut self.buffer, &KEY, &CLEARED).await;
        match stored {
            Ok(()) => Ok(()),
            Err(_) => self.map.erase_all().await.map_err(StoreError::from),
        }
    }

    async fn is_blank(&mut self) -> Result<bool, StoreError<F::Error>> {
        let blank = self.map.flash().is_blank().await;
        blank.map_err(StoreError::Flash)
    }
}

fn loaded(record: &[u8]) -> Loaded {
    match record {
        CLEARED => Loaded::Empty,
        _ => record::unpack(record).map_or_else(Loaded::Corrupt, Loaded::Settings),
    }
}
