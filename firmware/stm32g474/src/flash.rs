//! The chip's flash, each write and erase read back.
//!
//! Nothing is written where the option byte DBANK is not as the chip comes from the factory: the pages would be others.
//!
//! The driver's interrupt clears the flash's error flags before the task that waits can look at them; so what was meant
//! to be there is compared with what is.

use embassy_stm32::flash::{Async, Error, Flash, InterruptHandler};
use embassy_stm32::peripherals::FLASH;
use embassy_stm32::{Peri, bind_interrupts, pac};
use embedded_storage_async::nor_flash::{ErrorType, NorFlash, ReadNorFlash};
use leg_firmware::store::{PAGE_SIZE, WORD_SIZE};

bind_interrupts!(struct Interrupts {
    FLASH => InterruptHandler;
});

const ERASED: u8 = 0xff;

/// The flash; offsets are from its start.
pub struct CheckedFlash(Flash<'static, Async>);

impl CheckedFlash {
    /// The flash of the chip.
    pub fn new(flash: Peri<'static, FLASH>) -> Self {
        Self(Flash::new(flash, Interrupts))
    }

    /// Whether the pages are those of two banks.
    fn require_two_banks() -> Result<(), Error> {
        if pac::FLASH.optr().read().dbank() {
            Ok(())
        } else {
            Err(Error::Protected)
        }
    }

    /// Reads with a register of ECC errors that has forgotten what was before, and forgets what it finds: RM0440, FLASH_ECCR keeps the place of the first
    /// error, a corrected one, too, until its flags are cleared, and the NMI tells by that place what was read. A word
    /// of the program that is corrected in this very moment is taken for what is read here, or the other way round: that takes two errors at once.
    fn read_anew(&mut self, offset: u32, bytes: &mut [u8]) -> Result<(), Error> {
        forget_ecc_errors();
        let read = self.0.blocking_read(offset, bytes);
        forget_ecc_errors();
        read
    }

    /// Compares the flash from `offset` on with `expected`.
    fn compare<'a>(
        &mut self,
        offset: u32,
        expected: impl Iterator<Item = &'a [u8]>,
    ) -> Result<(), Error> {
        let mut found = [0; WORD_SIZE];
        for (at, word) in (offset..).step_by(WORD_SIZE).zip(expected) {
            self.read_anew(at, &mut found)?;
            if found.get(..word.len()) != Some(word) {
                return Err(Error::Prog);
            }
        }
        Ok(())
    }
}

/// Clears the flags of ECC errors: ones clear them.
pub fn forget_ecc_errors() {
    pac::FLASH.eccr().modify(|w| {
        w.set_eccc(true);
        w.set_eccd(true);
        w.set_eccc2(true);
        w.set_eccd2(true);
    });
}

impl ErrorType for CheckedFlash {
    type Error = Error;
}

impl ReadNorFlash for CheckedFlash {
    const READ_SIZE: usize = <Flash<'static, Async> as ReadNorFlash>::READ_SIZE;

    async fn read(&mut self, offset: u32, bytes: &mut [u8]) -> Result<(), Error> {
        self.read_anew(offset, bytes)
    }

    fn capacity(&self) -> usize {
        self.0.capacity()
    }
}

impl NorFlash for CheckedFlash {
    const WRITE_SIZE: usize = <Flash<'static, Async> as NorFlash>::WRITE_SIZE;
    const ERASE_SIZE: usize = <Flash<'static, Async> as NorFlash>::ERASE_SIZE;

    async fn erase(&mut self, from: u32, to: u32) -> Result<(), Error> {
        Self::require_two_banks()?;
        self.0.erase(from, to).await?;
        let words = to.saturating_sub(from) as usize / WORD_SIZE;
        let erased: &[u8] = &[ERASED; WORD_SIZE];
        self.compare(from, core::iter::repeat_n(erased, words))
    }

    async fn write(&mut self, offset: u32, bytes: &[u8]) -> Result<(), Error> {
        Self::require_two_banks()?;
        self.0.write(offset, bytes).await?;
        self.compare(offset, bytes.chunks(WORD_SIZE))
    }
}

const _: () = assert!(<CheckedFlash as NorFlash>::ERASE_SIZE == PAGE_SIZE);
