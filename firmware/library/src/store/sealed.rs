//! A flash whose pages are erased whole or not at all, however power fails.
//!
//! A half-erased page can look like anything: like an erased page that refuses writes, or like one in use with records
//! that were outdated long ago. So the first word of every page is a seal. It is written once the page has been erased,
//! and overwritten with zeros before the page is erased again. A page without its seal counts as erased; it is erased
//! in fact when it is next written to. That a half-erased page shows the seal is possible only if, of 64 zero bits,
//! just those of the seal have flipped.

use super::region::{PAGE_SIZE, WORD_SIZE};
use core::ops::Range;
use embedded_storage_async::nor_flash::{ErrorType, NorFlash, ReadNorFlash};

/// About half of its bits are ones, so that it is far from erased and from zero.
pub const SEAL: [u8; WORD_SIZE] = *b"leg page";

const ZEROS: [u8; WORD_SIZE] = [0; WORD_SIZE];
const ERASED: u8 = 0xFF;

/// Pages without their first words, numbered from 0 and one after the other.
pub struct Sealed<F> {
    flash: F,
    /// Of the flash, in bytes; whole pages.
    range: Range<u32>,
}

/// Where an offset lies in the flash, in bytes from its start.
struct Place {
    /// Start of the page: its seal.
    page: u32,
    address: u32,
    /// How many bytes the page has from there.
    left: usize,
}

impl<F: NorFlash> Sealed<F> {
    const FLASH_PAGE: u32 = {
        assert!(F::WRITE_SIZE == WORD_SIZE && WORD_SIZE.is_multiple_of(F::READ_SIZE));
        assert!(F::ERASE_SIZE <= PAGE_SIZE && F::ERASE_SIZE.is_multiple_of(WORD_SIZE));
        assert!(F::ERASE_SIZE > WORD_SIZE);
        F::ERASE_SIZE as u32
    };

    const PAGE: u32 = Self::FLASH_PAGE - WORD_SIZE as u32;

    /// `None` unless the range is whole pages inside the flash.
    pub fn new(flash: F, range: Range<u32>) -> Option<Self> {
        let whole = |address: u32| address.is_multiple_of(Self::FLASH_PAGE);
        let inside = range.start <= range.end && range.end as usize <= flash.capacity();
        (inside && whole(range.start) && whole(range.end)).then_some(Self { flash, range })
    }

    /// Every offset there is.
    pub fn range(&self) -> Range<u32> {
        let pages = (self.range.end - self.range.start) / Self::FLASH_PAGE;
        0..pages * Self::PAGE
    }

    /// Whether nothing has been written since all pages were erased, sealed or not.
    ///
    /// # Errors
    /// Those of the flash.
    pub async fn is_blank(&mut self) -> Result<bool, F::Error> {
        for address in self.range.clone().step_by(WORD_SIZE) {
            let word = self.word(address).await?;
            let seal = address.is_multiple_of(Self::FLASH_PAGE) && word == SEAL;
            if word != [ERASED; WORD_SIZE] && !seal {
                return Ok(false);
            }
        }
        Ok(true)
    }

    fn place(&self, offset: u32) -> Place {
        let page = self.range.start + offset / Self::PAGE * Self::FLASH_PAGE;
        let within = offset % Self::PAGE;
        Place {
            page,
            address: page + WORD_SIZE as u32 + within,
            left: (Self::PAGE - within) as usize,
        }
    }

    async fn word(&mut self, address: u32) -> Result<[u8; WORD_SIZE], F::Error> {
        let mut word = ZEROS;
        self.flash.read(address, &mut word).await?;
        Ok(word)
    }

    async fn is_sealed(&mut self, page: u32) -> Result<bool, F::Error> {
        Ok(self.word(page).await? == SEAL)
    }

    /// Erases a page. The first write decides: from then on the page counts as erased.
    async fn renew(&mut self, page: u32) -> Result<(), F::Error> {
        if self.is_sealed(page).await? {
            self.flash.write(page, &ZEROS).await?;
        }
        self.flash.erase(page, page + Self::FLASH_PAGE).await?;
        self.flash.write(page, &SEAL).await
    }
}

impl<F: NorFlash> ErrorType for Sealed<F> {
    type Error = F::Error;
}

impl<F: NorFlash> ReadNorFlash for Sealed<F> {
    /// As it is written, so that whole words show a page's state.
    const READ_SIZE: usize = WORD_SIZE;

    async fn read(&mut self, offset: u32, bytes: &mut [u8]) -> Result<(), F::Error> {
        let (mut offset, mut rest) = (offset, bytes);
        while !rest.is_empty() {
            let place = self.place(offset);
            let here;
            (here, rest) = rest.split_at_mut(place.left.min(rest.len()));
            if self.is_sealed(place.page).await? {
                self.flash.read(place.address, here).await?;
            } else {
                here.fill(ERASED);
            }
            offset += here.len() as u32;
        }
        Ok(())
    }

    fn capacity(&self) -> usize {
        self.range().end as usize
    }
}

impl<F: NorFlash> NorFlash for Sealed<F> {
    const WRITE_SIZE: usize = WORD_SIZE;
    const ERASE_SIZE: usize = Self::PAGE as usize;

    async fn erase(&mut self, from: u32, to: u32) -> Result<(), F::Error> {
        for offset in (from..to).step_by(Self::ERASE_SIZE) {
            let place = self.place(offset);
            self.renew(place.page).await?;
        }
        Ok(())
    }

    async fn write(&mut self, offset: u32, bytes: &[u8]) -> Result<(), F::Error> {
        let (mut offset, mut rest) = (offset, bytes);
        while !rest.is_empty() {
            let place = self.place(offset);
            let here;
            (here, rest) = rest.split_at(place.left.min(rest.len()));
            if !self.is_sealed(place.page).await? {
                self.renew(place.page).await?;
            }
            self.flash.write(place.address, here).await?;
            offset += here.len() as u32;
        }
        Ok(())
    }
}
