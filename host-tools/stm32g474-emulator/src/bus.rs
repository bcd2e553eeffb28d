//! What answers to the processor beside its RAM and the bank that it runs from.

use crate::peripherals::Peripherals;
use rsemu::core::error::BusError;
use rsemu::core::space::{MemAttrs, MemOps, MemResult};
use std::fmt;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// What processor and bus share: the time, and whether a peripheral was accessed.
#[derive(Debug, Default)]
pub struct BusShared {
    /// Cycles since the power-up.
    pub cycle: AtomicU64,
    /// Whether a peripheral was accessed since the last question.
    pub accessed: AtomicBool,
}

/// What answers in a range of addresses.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Answers {
    /// Registers of peripherals.
    Registers,
    /// The second bank of the flash, which can be programmed while the first is run.
    Flash,
}

/// A range of addresses as the processor's memory has it.
pub struct Bus {
    /// The first address.
    pub start: u32,
    /// What answers there.
    pub answers: Answers,
    /// The peripherals.
    pub peripherals: Arc<Mutex<Peripherals>>,
    /// What is shared with the processor.
    pub shared: Arc<BusShared>,
}

/// The peripherals, whatever happened to who had them before.
pub fn lock(peripherals: &Mutex<Peripherals>) -> MutexGuard<'_, Peripherals> {
    peripherals.lock().unwrap_or_else(PoisonError::into_inner)
}

impl fmt::Debug for Bus {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:?} from {:#010x}", self.answers, self.start)
    }
}

impl Bus {
    fn access(&self) -> MutexGuard<'_, Peripherals> {
        let mut peripherals = lock(&self.peripherals);
        peripherals.set_cycle(self.shared.cycle.load(Ordering::Relaxed));
        self.shared.accessed.store(true, Ordering::Relaxed);
        peripherals
    }

    /// An address and a width that a bus of 32 bits can have.
    fn checked(&self, offset: u64, width: usize) -> MemResult<(u32, u32)> {
        let offset = u32::try_from(offset).map_err(|_| BusError::Unassigned)?;
        match width {
            1 | 2 | 4 if (offset as usize).is_multiple_of(width) => {
                Ok((self.start + offset, width as u32))
            }
            _ => Err(BusError::BadAccess),
        }
    }
}

impl MemOps for Bus {
    fn read(&self, offset: u64, bytes: &mut [u8], attributes: MemAttrs) -> MemResult {
        if attributes.debug {
            bytes.fill(0);
            return Ok(());
        }
        let (address, width) = self.checked(offset, bytes.len())?;
        let mut peripherals = self.access();
        let word = match self.answers {
            Answers::Registers => peripherals.read(address, width),
            Answers::Flash => peripherals.read_flash(address, width),
        };
        for (byte, value) in bytes.iter_mut().zip(word.to_le_bytes()) {
            *byte = value;
        }
        Ok(())
    }

    fn write(&self, offset: u64, bytes: &[u8], attributes: MemAttrs) -> MemResult {
        if attributes.debug {
            return Err(BusError::Protected);
        }
        let (address, width) = self.checked(offset, bytes.len())?;
        let mut word = [0; 4];
        for (byte, value) in word.iter_mut().zip(bytes) {
            *byte = *value;
        }
        let value = u32::from_le_bytes(word);
        let mut peripherals = self.access();
        match self.answers {
            Answers::Registers => peripherals.write(address, width, value),
            Answers::Flash => peripherals.write_flash(address, width, value),
        }
        Ok(())
    }
}
