//! The counter of the processor's cycles, by which ticks are timed.

use cortex_m::peripheral::{DCB, DWT};

/// The counter, running.
pub struct CycleCounter {
    debug: DCB,
    counter: DWT,
}

impl CycleCounter {
    /// Starts it; `None` if it was started before.
    pub fn start() -> Option<Self> {
        let core = cortex_m::Peripherals::take()?;
        let mut counter = Self {
            debug: core.DCB,
            counter: core.DWT,
        };
        counter.keep_running();
        Some(counter)
    }

    /// Starts it again if a debugger has stopped it on leaving, as some do.
    pub fn keep_running(&mut self) {
        self.debug.enable_trace();
        self.counter.enable_cycle_counter();
    }
}
