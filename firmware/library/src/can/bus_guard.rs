//! What the board does when the bus fails.

use postcard_schema::Schema;
use serde::{Deserialize, Serialize};

#[cfg(test)]
mod tests;

/// Recessive bits that a controller has to see before it may take part again: 128 times 11.
const RECOVERY_BITS: u32 = 128 * 11;

const US_PER_S: u32 = 1_000_000;

/// First delay before a restart, µs.
const FIRST_DELAY_US: u32 = 10_000;

/// Longest delay before a restart, µs.
const MAX_DELAY_US: u32 = 1_000_000;

/// After so long without an error the next delay is the first one again, µs.
const CALM_US: u32 = 1_000_000;

/// The error state of a CAN controller.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, Schema)]
pub enum BusState {
    /// It takes part in all that happens on the bus.
    ErrorActive,
    /// An error counter is above 127: it still sends and receives, but lets others go first.
    ErrorPassive,
    /// Its transmit error counter is above 255: it neither sends nor receives.
    BusOff,
}

/// What the board has to do to its controller.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BusAction {
    /// Nothing.
    None,
    /// The bus has just been lost: drop the segments that wait to be sent, those in the controller's buffers, too.
    GiveUp,
    /// Let the controller come back (FDCAN: clear `CCCR.INIT`). It then waits itself for 128 times 11 recessive bits.
    Restart,
}

/// Watches a CAN controller, and brings it back after a bus-off, each time later than the time before.
///
/// A node whose own fault drove it off the bus would otherwise come back every few milliseconds only to destroy the
/// others' frames. The wait is that of 128 × 11 bits and a delay that doubles from 10 ms to 1 s, and is 10 ms again after
/// 1 s in the error-active state. The controller must not come back by itself.
///
/// It commands the leg nothing. While the bus is off no command arrives, and so the leg holds still by its own
/// command timeout, [`crate::supervisor::Fault::CommandTimeout`], as with every other link that falls silent.
#[derive(Debug)]
pub struct BusGuard {
    state: BusState,
    bus_offs: u16,
    recovery_us: u32,
    delay_us: u32,
    /// Until the restart while the bus is off; else how long there has been no error.
    elapsed_us: u32,
}

impl BusGuard {
    /// A guard of a controller that has just been started, at a nominal bit rate in bit/s (not that of the data phase).
    #[must_use]
    pub const fn new(bit_rate: u32) -> Self {
        // A rate of zero is none; the longest wait is the harmless reading of it.
        let bit_rate = if bit_rate == 0 { 1 } else { bit_rate };
        Self {
            state: BusState::ErrorActive,
            bus_offs: 0,
            recovery_us: (RECOVERY_BITS * US_PER_S).div_ceil(bit_rate),
            delay_us: FIRST_DELAY_US,
            elapsed_us: 0,
        }
    }

    /// The state that was read last; the board reports it.
    #[must_use]
    pub const fn state(&self) -> BusState {
        self.state
    }

    /// How many times the bus went off; it stays at its largest value.
    #[must_use]
    pub const fn bus_offs(&self) -> u16 {
        self.bus_offs
    }

    /// Takes the controller's state and the time since the last call, µs; gives what to do.
    pub fn watch(&mut self, read: BusState, since_us: u32) -> BusAction {
        let before = core::mem::replace(&mut self.state, read);
        self.elapsed_us = self.elapsed_us.saturating_add(since_us);
        match (before, read) {
            (BusState::BusOff, BusState::BusOff) => self.wait(),
            (_, BusState::BusOff) => self.lose(),
            (BusState::ErrorActive, BusState::ErrorActive) => self.calm(),
            _ => {
                self.elapsed_us = 0;
                BusAction::None
            }
        }
    }

    fn lose(&mut self) -> BusAction {
        self.bus_offs = self.bus_offs.saturating_add(1);
        self.elapsed_us = 0;
        BusAction::GiveUp
    }

    fn wait(&mut self) -> BusAction {
        if self.elapsed_us < self.recovery_us.saturating_add(self.delay_us) {
            return BusAction::None;
        }
        self.elapsed_us = 0;
        self.delay_us = self.delay_us.saturating_mul(2).min(MAX_DELAY_US);
        BusAction::Restart
    }

    fn calm(&mut self) -> BusAction {
        if self.elapsed_us >= CALM_US {
            self.delay_us = FIRST_DELAY_US;
        }
        BusAction::None
    }
}
