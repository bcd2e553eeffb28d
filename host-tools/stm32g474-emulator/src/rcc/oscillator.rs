//! An oscillator, or the PLL.

use crate::device::Context;

/// What is switched on, and since when it is ready.
#[derive(Clone, Copy, Debug, Default)]
pub struct Oscillator {
    /// The cycle from which on it can be used; none while it is off.
    pub ready_at: Option<u64>,
}

impl Oscillator {
    /// Switches it on, to be ready after a time, or off.
    pub fn switch(&mut self, on: bool, start_us: u64, context: &Context<'_>) {
        if on && self.ready_at.is_none() {
            let cycles = start_us * u64::from(context.clocks.hclk) / 1_000_000;
            self.ready_at = Some(context.cycle + cycles);
        } else if !on {
            self.ready_at = None;
        }
    }

    /// Whether it is switched on, ready or not.
    pub fn is_on(self) -> bool {
        self.ready_at.is_some()
    }

    /// Whether it can be used.
    pub fn ready(self, cycle: u64) -> bool {
        self.ready_at.is_some_and(|at| cycle >= at)
    }
}
