//! The filter of a timer's inputs: a level counts once it has been the same for a number of samples.

/// Samples and the division of the sampling clock, by the value of `ICxF`, `BKF`, `BK2F`; the first four sample at the
/// timer's clock, the others at the divided one. As in `stm32-metapac`'s `FilterValue`.
const FILTERS: [(u32, u32); 16] = [
    (0, 1),
    (2, 1),
    (4, 1),
    (8, 1),
    (6, 2),
    (8, 2),
    (6, 4),
    (8, 4),
    (6, 8),
    (8, 8),
    (5, 16),
    (6, 16),
    (8, 16),
    (5, 32),
    (6, 32),
    (8, 32),
];

/// Ticks of the timer's clock that a level has to last, by the filter's value and by `CKD`.
#[must_use]
pub fn ticks(filter: u32, clock_division: u32) -> u64 {
    let place = usize::try_from(filter).unwrap_or_default();
    let (samples, divisor) = FILTERS.get(place).copied().unwrap_or_default();
    let division = if filter < 4 { 0 } else { clock_division.min(2) };
    u64::from(samples * divisor) << division
}

/// A level behind a filter.
#[derive(Clone, Copy, Debug, Default)]
pub struct Filtered {
    /// What has come through.
    level: bool,
    /// The cycle in which the opposite comes through.
    change: Option<u64>,
}

impl Filtered {
    /// The level before the filter is this one, from this cycle on; it comes through after `delay` cycles.
    pub fn set(&mut self, level: bool, cycle: u64, delay: u64) {
        self.settle(cycle);
        if level == self.level {
            self.change = None;
        } else if delay == 0 {
            self.force(level);
        } else if self.change.is_none() {
            self.change = Some(cycle + delay);
        }
    }

    /// Puts a level through at once.
    pub fn force(&mut self, level: bool) {
        *self = Self {
            level,
            change: None,
        };
    }

    /// Lets through what is due.
    pub fn settle(&mut self, cycle: u64) {
        if self.change.is_some_and(|at| at <= cycle) {
            self.force(!self.level);
        }
    }

    /// What has come through.
    #[must_use]
    pub fn level(&self) -> bool {
        self.level
    }

    /// The cycle in which the opposite comes through.
    #[must_use]
    pub fn next_event(&self) -> Option<u64> {
        self.change
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_level_has_to_last() {
        assert_eq!(
            [ticks(0, 2), ticks(3, 2), ticks(9, 0), ticks(9, 1)],
            [0, 8, 64, 128]
        );
        let mut line = Filtered::default();
        for (cycle, level, through) in [
            (100, true, false),
            (163, false, false),
            (170, true, false),
            (233, true, false),
            (234, true, true),
            (235, false, true),
            (299, false, false),
        ] {
            line.set(level, cycle, 64);
            assert_eq!(line.level(), through, "{cycle}");
        }
    }
}
