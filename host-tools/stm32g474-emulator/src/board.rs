//! The board that the chip is on.

use crate::clocks::LSI_HZ;
use crate::fdcan::CanBus;

/// What is around the chip, and what of it differs from one chip to the next.
#[derive(Clone, Copy, Debug)]
pub struct Board {
    /// The crystal, Hz.
    pub crystal_hz: u32,
    /// What the oscillator of the watchdog really does, Hz.
    pub lsi_hz: u32,
    /// The option byte DBANK; it is set as the chip leaves the factory.
    pub dual_bank: bool,
    /// The option byte BOR_LEV, 0 to 4: below which supply the chip is reset. It is 0 as the chip leaves the factory.
    pub brown_out_level: u8,
    /// The bit rates of the CAN bus.
    pub can: CanBus,
    /// For what is left to chance: RAM after a power-up, flash after a cut.
    pub seed: u64,
    /// Whether what the image writes is recorded, from the power-up on: a list that grows with every tick.
    pub records_writes: bool,
}

impl Default for Board {
    /// A NUCLEO-G474RE.
    fn default() -> Self {
        Self {
            crystal_hz: 24_000_000,
            lsi_hz: LSI_HZ,
            dual_bank: true,
            brown_out_level: 0,
            can: CanBus {
                nominal_hz: 1_000_000,
                data_hz: 5_000_000,
                sample_permille: 750,
            },
            seed: 0,
            records_writes: false,
        }
    }
}
