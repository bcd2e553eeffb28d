//! The window watchdog WWDG.
//!
//! It counts the clock of its bus, divided: RM0440, "System window watchdog"; the formula of its time is the same in the
//! manuals of its sisters with a prescaler of three bits (RM0444, RM0453). The divider runs on over a write of CR, so that
//! the first step after it may be a short one.
//!
//! Not modelled: low-power modes, the option byte that starts it at a reset.

#[cfg(test)]
mod tests;

use crate::clocks::Clocks;
use crate::device::{Context, Device, RegisterFile, places};
use crate::facts::Block;

/// Periods of the bus's clock that the prescaler divides.
const DIVIDER: u64 = 4_096;

/// The bit of the counter that holds the reset off.
const HOLDS: u32 = 0x40;

/// The watchdog.
#[derive(Clone, Debug)]
pub struct Wwdg {
    registers: RegisterFile,
    places: Places,
    /// The counter at a cycle, from which it counts down.
    from: (u64, u32),
    /// Cycles of the processor in a step.
    step: u64,
    /// It was refreshed outside of its window, or with a count that resets.
    resets: Option<u64>,
    /// It was refreshed since the last question.
    refreshed: bool,
    /// The most steps that it had counted when it was refreshed.
    longest: u32,
}

places! {
    /// Registers and fields.
    #[derive(Clone, Copy, Debug)]
    struct Places {
        counter: CR.T,
        active: CR.WDGA,
        window: CFR.W,
        prescaler: CFR.WDGTB,
        interrupt: CFR.EWI,
        early: SR.EWIF,
    }
}

impl Wwdg {
    /// Not started.
    ///
    /// # Panics
    /// If the block is no window watchdog.
    #[must_use]
    pub fn new(block: &'static Block) -> Self {
        let registers = RegisterFile::new(block);
        let places = Places::new(&registers);
        let from = (0, registers.value(places.counter));
        Self {
            registers,
            places,
            from,
            step: DIVIDER,
            resets: None,
            refreshed: false,
            longest: 0,
        }
    }

    /// The cycle in which it resets the chip; none if it was not started.
    #[must_use]
    pub fn expires_at(&self) -> Option<u64> {
        let active = self.registers.is_set(self.places.active);
        let end = || self.reaches(HOLDS - 1);
        active.then(|| self.resets.unwrap_or_else(end))
    }

    /// The longest from a refresh to the reset, cycles, with the count that was written last.
    #[must_use]
    pub fn timeout_cycles(&self, clocks: &Clocks) -> u64 {
        let written = self.registers.value(self.places.counter);
        u64::from(written.saturating_sub(HOLDS - 1)) * self.step_cycles(clocks)
    }

    /// Whether it was refreshed since the last question; its start is no refresh.
    pub fn take_refreshed(&mut self) -> bool {
        std::mem::take(&mut self.refreshed)
    }

    /// The most steps from a count that was written to its refresh, since the last question.
    pub fn take_longest_steps(&mut self) -> u32 {
        std::mem::take(&mut self.longest)
    }

    /// A debugger halts it for some cycles.
    pub fn halt(&mut self, cycles: u64) {
        self.from.0 += cycles;
    }

    /// Its interrupt.
    #[must_use]
    pub fn interrupt(&self) -> bool {
        self.registers.is_set(self.places.early) && self.registers.is_set(self.places.interrupt)
    }

    fn step_cycles(&self, clocks: &Clocks) -> u64 {
        let periods = DIVIDER << self.registers.value(self.places.prescaler);
        clocks
            .cycles(periods, clocks.pclk1)
            .unwrap_or(u64::MAX / 256)
    }

    /// The cycle in which the counter comes to a value below the one that it counts from.
    fn reaches(&self, value: u32) -> u64 {
        let (cycle, count) = self.from;
        let steps = u64::from(count.saturating_sub(value));
        (cycle / self.step + steps) * self.step
    }

    fn count(&self, cycle: u64) -> u32 {
        let (since, count) = self.from;
        let steps = (cycle / self.step).saturating_sub(since / self.step);
        count.saturating_sub(u32::try_from(steps).unwrap_or(u32::MAX))
    }

    /// Counts up to now, and goes on with the clock of the moment.
    fn settle(&mut self, context: &Context<'_>) {
        let count = self.count(context.cycle);
        if count <= HOLDS && self.from.1 > HOLDS {
            self.registers.set_value(self.places.early, 1);
        }
        let step = self.step_cycles(context.clocks);
        if step != self.step || count != self.from.1 {
            self.from = (context.cycle, count);
            self.step = step;
        }
    }

    fn write_control(&mut self, value: u32, context: &mut Context<'_>) {
        let places = self.places;
        let active = self.registers.is_set(places.active);
        let (count, window) = (self.from.1, self.registers.value(places.window));
        let written = places.counter.extract(value);
        let starts = places.active.extract(value) != 0;
        if active && count > window {
            context
                .findings
                .add("WWDG_CR: the watchdog is refreshed before its window opens");
            self.resets.get_or_insert(context.cycle);
        }
        if (active || starts) && written & HOLDS == 0 {
            context
                .findings
                .add("WWDG_CR: T is written without its bit 6, which resets the chip at once");
            self.resets.get_or_insert(context.cycle);
        }
        self.refreshed |= active;
        if active {
            let before = self.registers.value(places.counter);
            self.longest = self.longest.max(before.saturating_sub(count));
        }
        self.registers.set(places.counter.offset, value);
        // Nothing but a reset stops it.
        self.registers
            .set_value(places.active, u32::from(active || starts));
        self.from = (context.cycle, written);
    }
}

impl Device for Wwdg {
    fn reset(&mut self) {
        *self = Self::new(self.registers.block());
    }

    fn read(&mut self, offset: u32, context: &mut Context<'_>) -> u32 {
        self.settle(context);
        let word = self.registers.get(offset);
        if offset == self.places.counter.offset {
            return self.places.counter.insert(word, self.from.1);
        }
        word
    }

    fn write(&mut self, offset: u32, value: u32, context: &mut Context<'_>) {
        self.settle(context);
        let places = self.places;
        if offset == places.counter.offset {
            self.write_control(value, context);
        } else if offset == places.window.offset {
            // Nothing but a reset clears EWI.
            let kept = self.registers.get(offset) & places.interrupt.mask;
            self.registers.set(offset, value | kept);
            self.settle(context);
        } else {
            // A zero clears the flag, a one leaves it.
            let flag = self.registers.get(offset) & value;
            self.registers.set(offset, flag);
        }
    }

    fn next_event(&self) -> Option<u64> {
        let end = self.expires_at()?;
        let early = self.reaches(HOLDS);
        Some(if self.from.1 > HOLDS {
            end.min(early)
        } else {
            end
        })
    }

    fn advance(&mut self, context: &mut Context<'_>) {
        self.settle(context);
    }
}
