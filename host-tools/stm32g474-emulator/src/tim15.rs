//! TIM15: the time of the tasks. It counts up; its compare channels and its update wake the processor.

use crate::clocks::Clocks;
use crate::device::{Context, Device};
use crate::facts::Block;
use crate::timer::registers::Timer;

/// Its compare channels.
const CHANNELS: u32 = 2;

/// The timer of the tasks.
#[derive(Clone, Debug)]
pub struct Tim15 {
    timer: Timer,
}

impl Tim15 {
    /// As after a reset.
    ///
    /// # Panics
    /// If the block is none of a timer.
    #[must_use]
    pub fn new(block: &'static Block) -> Self {
        Self {
            timer: Timer::new(block, CHANNELS, |clocks| clocks.timers2),
        }
    }

    /// Counts a second, with the prescaler in use.
    #[must_use]
    pub fn counts_hz(&self, clocks: &Clocks) -> u32 {
        clocks.timers2 / (self.timer.counter.prescaler + 1)
    }

    /// Its interrupts and their levels. The line is shared with the breaks of TIM1.
    #[must_use]
    pub fn interrupts(&self) -> [(&'static str, bool); 1] {
        let level = self.timer.update_interrupt() || self.timer.compare_interrupt();
        [("TIM1_BRK_TIM15", level)]
    }
}

impl Device for Tim15 {
    fn reset(&mut self) {
        self.timer.reset();
    }

    fn read(&mut self, offset: u32, context: &mut Context<'_>) -> u32 {
        self.timer.advance(context);
        self.timer.read(offset)
    }

    fn write(&mut self, offset: u32, value: u32, context: &mut Context<'_>) {
        self.timer.advance(context);
        self.timer.write(offset, value, context);
    }

    fn next_event(&self) -> Option<u64> {
        self.timer.next_event()
    }

    fn advance(&mut self, context: &mut Context<'_>) {
        self.timer.advance(context);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bench::DeviceBench;

    /// As the time driver sets it up, at 1 MHz.
    fn bench() -> DeviceBench<Tim15> {
        let mut bench = DeviceBench::new("TIM15", Tim15::new);
        bench.write("PSC", 169);
        bench.write("ARR", 0xffff);
        bench.set("CR1", &[("URS", 1)]);
        bench.write("EGR", 1);
        bench.set("CR1", &[("URS", 0)]);
        bench.write("CCR1", 0x8000);
        bench.write("DIER", 0b11);
        bench.set("CR1", &[("CEN", 1)]);
        assert_eq!(bench.read("SR"), 0);
        bench
    }

    fn level(bench: &DeviceBench<Tim15>) -> bool {
        bench.device.interrupts()[0].1
    }

    #[test]
    fn half_and_whole_periods_interrupt() {
        let mut bench = bench();
        let start = bench.cycle;
        for (half, flag) in [(1, 0b10), (2, 0b1), (3, 0b10), (4, 0b1)] {
            let due = start + half * 0x8000 * 170;
            assert_eq!(bench.device.next_event(), Some(due));
            bench.run_to(due - 1);
            assert!(!level(&bench));
            bench.run_to(due);
            assert!(level(&bench));
            // A value of 0 of the second channel compares too, without an interrupt.
            let flags = bench.read("SR");
            assert_eq!(flags & 0b11, flag);
            bench.write("SR", !flags);
            assert!(!level(&bench));
        }
    }

    #[test]
    fn an_alarm_comes_in_its_tick() {
        let mut bench = bench();
        let start = bench.cycle;
        bench.run(170 * 1_000 + 17);
        assert_eq!(bench.read("CNT"), 1_000);
        bench.write("CCR2", 1_500);
        bench.write("DIER", 0b111);
        assert_eq!(bench.device.next_event(), Some(start + 1_500 * 170));
        bench.run_to(start + 1_500 * 170);
        assert_eq!((bench.read("SR"), level(&bench)), (0b100, true));
        bench.write("DIER", 0b011);
        assert!(!level(&bench));
    }

    #[test]
    fn a_slower_clock_slows_it_from_then_on() {
        let mut bench = bench();
        bench.run(170 * 100);
        bench.clocks.timers2 /= 2;
        bench.run(0);
        bench.run(170 * 100);
        assert_eq!(bench.read("CNT"), 150);
    }
}
