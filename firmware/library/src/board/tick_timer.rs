//! Whether ticks keep to their time.

use super::timing::{START_SLACK_CYCLES, TICK_BUDGET_CYCLES, TICK_CYCLES};

/// Watches the control interrupt by a counter of cycles that wraps.
#[derive(Clone, Copy, Debug, Default)]
pub struct TickTimer {
    started: Option<u32>,
    overran: bool,
    longest: u32,
}

impl TickTimer {
    /// No tick has started yet.
    #[must_use]
    pub const fn new() -> Self {
        Self {
            started: None,
            overran: false,
            longest: 0,
        }
    }

    /// A tick starts. True if it is late: the last one took too long, or this one starts too long after it.
    #[inline(always)]
    pub fn start(&mut self, now: u32) -> bool {
        let delayed = self
            .started
            .is_some_and(|before| now.wrapping_sub(before) > TICK_CYCLES + START_SLACK_CYCLES);
        self.started = Some(now);
        core::mem::take(&mut self.overran) || delayed
    }

    /// The tick is done.
    #[inline(always)]
    pub fn end(&mut self, now: u32) {
        let Some(started) = self.started else { return };
        let took = now.wrapping_sub(started);
        self.overran = took > TICK_BUDGET_CYCLES;
        self.longest = self.longest.max(took);
    }

    /// The longest tick so far, cycles.
    #[must_use]
    pub const fn longest(&self) -> u32 {
        self.longest
    }
}

#[cfg(test)]
mod tests {
    use super::{START_SLACK_CYCLES, TICK_BUDGET_CYCLES, TICK_CYCLES, TickTimer};

    /// Whether each tick is late; given when it starts and how long it takes.
    fn late<const N: usize>(ticks: [(u32, u32); N]) -> [bool; N] {
        let mut timer = TickTimer::new();
        ticks.map(|(start, took)| {
            let late = timer.start(start);
            timer.end(start.wrapping_add(took));
            late
        })
    }

    #[test]
    fn ticks_in_time_are_not_late() {
        let near_the_wrap = u32::MAX - TICK_CYCLES / 2;
        let next = near_the_wrap.wrapping_add(TICK_CYCLES);
        let ticks = [(near_the_wrap, TICK_BUDGET_CYCLES), (next, 1)];
        assert_eq!(late(ticks), [false; 2]);
    }

    #[test]
    fn a_tick_that_took_too_long_is_told_with_the_next_and_once() {
        let long = TICK_BUDGET_CYCLES + 1;
        let ticks = [(0, long), (TICK_CYCLES, 1), (2 * TICK_CYCLES, 1)];
        assert_eq!(late(ticks), [false, true, false]);
    }

    #[test]
    fn a_tick_that_starts_late_is_told_at_once() {
        let slack = TICK_CYCLES + START_SLACK_CYCLES;
        assert_eq!(late([(0, 1), (slack, 1)]), [false; 2]);
        assert_eq!(late([(0, 1), (slack + 1, 1)]), [false, true]);
        assert_eq!(
            late([(0, 1), (2 * TICK_CYCLES, 1)]),
            [false, true],
            "one is left out"
        );
    }

    #[test]
    fn the_longest_is_kept() {
        let mut timer = TickTimer::new();
        timer.end(5);
        assert_eq!(timer.longest(), 0, "an end without a start");
        for took in [10, 30, 20] {
            timer.start(0);
            timer.end(took);
        }
        assert_eq!(timer.longest(), 30);
    }
}
