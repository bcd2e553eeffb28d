//! A clock of the chip, counted by the processor's cycles.

/// Ticks of a clock from the cycles of the processor. Exact for any ratio; a change of the ratio keeps what was counted.
#[derive(Clone, Copy, Debug)]
pub struct Timebase {
    /// From here the ratio holds.
    cycle: u64,
    /// What was counted up to there.
    ticks: u64,
    hz: u32,
    hclk: u32,
}

impl Default for Timebase {
    fn default() -> Self {
        Self {
            cycle: 0,
            ticks: 0,
            hz: 1,
            hclk: 1,
        }
    }
}

impl Timebase {
    /// Says how fast the clock and the processor run from a cycle on, Hz. A processor that stands still counts nothing.
    pub fn set(&mut self, cycle: u64, hz: u32, hclk: u32) {
        if (self.hz, self.hclk) != (hz, hclk.max(1)) {
            self.ticks = self.ticks(cycle);
            self.cycle = cycle;
            (self.hz, self.hclk) = (hz, hclk.max(1));
        }
    }

    /// Ticks up to a cycle.
    #[must_use]
    pub fn ticks(&self, cycle: u64) -> u64 {
        let cycles = cycle.saturating_sub(self.cycle);
        self.ticks + scaled(cycles, self.hz, self.hclk, false)
    }

    /// The first cycle in which that many ticks have passed; none if the clock stands still.
    #[must_use]
    pub fn cycle(&self, ticks: u64) -> Option<u64> {
        (self.hz > 0).then(|| self.cycle + self.cycles(ticks.saturating_sub(self.ticks)))
    }

    /// Cycles in a number of ticks, rounded up.
    #[must_use]
    pub fn cycles(&self, ticks: u64) -> u64 {
        scaled(ticks, self.hclk, self.hz, true)
    }
}

/// `count * by / of`, rounded down or up.
fn scaled(count: u64, by: u32, of: u32, up: bool) -> u64 {
    if by == of {
        return count;
    }
    let (product, of) = (u128::from(count) * u128::from(by), u128::from(of.max(1)));
    let quotient = if up {
        product.div_ceil(of)
    } else {
        product / of
    };
    u64::try_from(quotient).unwrap_or(u64::MAX)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;

    #[test]
    fn ticks_and_cycles_fit_each_other_at_every_ratio() {
        for (hz, hclk) in [(170, 170), (85, 170), (16, 24), (24, 16), (1, 3)] {
            let mut time = Timebase::default();
            time.set(0, hz, hclk);
            for tick in 1..50 {
                let cycle = time.cycle(tick).unwrap();
                assert!(time.ticks(cycle) >= tick && time.ticks(cycle - 1) < tick);
            }
        }
    }

    #[test]
    fn a_change_of_the_ratio_keeps_what_was_counted() {
        let mut time = Timebase::default();
        time.set(0, 16, 16);
        time.set(100, 85, 170);
        assert_eq!((time.ticks(100), time.ticks(300)), (100, 200));
        assert_eq!(time.cycle(200), Some(300));
        time.set(300, 0, 170);
        assert_eq!((time.ticks(9_000), time.cycle(201)), (200, None));
    }
}
