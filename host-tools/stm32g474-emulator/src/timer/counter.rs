//! A timer's counter, computed from the tick of the moment.

/// Counts up, down, or up and down in turn. What it does between two turns is a half; where it counts in one direction
/// only, each round is one.
#[derive(Clone, Copy, Debug, Default)]
pub struct TimerCounter {
    /// `CEN`.
    running: bool,
    /// It counts up and down in turn.
    pub centre: bool,
    /// It counts down now.
    pub down: bool,
    /// The prescaler in use: a count is one more than this many ticks.
    pub prescaler: u32,
    /// The top in use.
    top: u32,
    /// While it runs: the tick in which its half began, which may lie before the first.
    start: i64,
    /// While it stands: ticks of its half that are over.
    held: i64,
}

impl TimerCounter {
    /// Ticks of a half; 0 if the top keeps it from counting.
    #[must_use]
    pub fn half(&self) -> u64 {
        let counts = u64::from(self.top) + u64::from(!self.centre && self.top > 0);
        counts * self.step()
    }

    /// Whether it counts.
    #[must_use]
    pub fn runs(&self) -> bool {
        self.running
    }

    /// The top in use.
    #[must_use]
    pub fn top(&self) -> u32 {
        self.top
    }

    /// What it shows.
    #[must_use]
    pub fn count(&self, now: u64) -> u32 {
        let steps = u64::try_from(self.elapsed(now)).unwrap_or_default() / self.step();
        let steps = u32::try_from(steps).unwrap_or(u32::MAX);
        if self.down {
            self.top.saturating_sub(steps)
        } else {
            steps
        }
    }

    /// Sets what it shows.
    pub fn set_count(&mut self, count: u32, now: u64) {
        let steps = if self.down {
            self.top.saturating_sub(count)
        } else {
            count
        };
        self.place(u64::from(steps) * self.step(), now);
    }

    /// Sets the top; what it shows stays.
    pub fn set_top(&mut self, top: u32, now: u64) {
        if self.top != top {
            let count = self.count(now);
            self.top = top;
            self.set_count(count, now);
        }
    }

    /// Takes prescaler and top at the beginning of a half.
    pub fn reload(&mut self, prescaler: u32, top: u32) {
        (self.prescaler, self.top) = (prescaler, top);
    }

    /// Starts or stops it where it is.
    pub fn run(&mut self, running: bool, now: u64) {
        self.held = self.elapsed(now);
        self.start = signed(now) - self.held;
        self.running = running;
    }

    /// Back to the beginning, by an update that was asked for.
    pub fn restart(&mut self, now: u64) {
        self.down &= !self.centre;
        self.place(0, now);
    }

    /// The tick in which the half ends, if it ever does.
    #[must_use]
    pub fn end(&self) -> Option<u64> {
        let half = self.half();
        let end = self.start + signed(half);
        (self.running && half > 0).then(|| u64::try_from(end).unwrap_or_default())
    }

    /// Goes on with the next half.
    pub fn turn(&mut self) {
        self.start += signed(self.half());
        self.down ^= self.centre;
    }

    /// The first tick after `after` in which it comes to a value, counting in one of the directions `(up, down)`, with the
    /// top in use.
    #[must_use]
    pub fn next_match(&self, value: u32, after: u64, (up, down): (bool, bool)) -> Option<u64> {
        self.end()?;
        let mut half = *self;
        // This half, the next, and one more where only every other one counts.
        for _ in 0..3 {
            let wanted = if half.down { down } else { up };
            if let Some(steps) = half.steps_to(value).filter(|_| wanted) {
                let tick = half.start + signed(steps * half.step());
                if tick > signed(after) {
                    return u64::try_from(tick).ok();
                }
            }
            half.turn();
        }
        None
    }

    /// Steps from the beginning of the half to a value, if it comes by.
    fn steps_to(&self, value: u32) -> Option<u64> {
        let comes_by = match (self.centre, self.down) {
            (true, true) => (1..=self.top).contains(&value),
            (true, false) => value < self.top,
            (false, _) => value <= self.top,
        };
        let steps = if self.down {
            self.top.saturating_sub(value)
        } else {
            value
        };
        comes_by.then_some(u64::from(steps))
    }

    fn step(&self) -> u64 {
        u64::from(self.prescaler) + 1
    }

    fn elapsed(&self, now: u64) -> i64 {
        if self.running {
            signed(now) - self.start
        } else {
            self.held
        }
    }

    fn place(&mut self, elapsed: u64, now: u64) {
        self.held = signed(elapsed);
        self.start = signed(now) - self.held;
    }
}

fn signed(ticks: u64) -> i64 {
    i64::try_from(ticks).unwrap_or(i64::MAX)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn counter(centre: bool, prescaler: u32, top: u32) -> TimerCounter {
        let mut counter = TimerCounter {
            centre,
            prescaler,
            ..TimerCounter::default()
        };
        counter.set_top(top, 0);
        counter.run(true, 0);
        counter
    }

    /// What it shows in a tick, by turning as often as it has to.
    fn shown_count(mut counter: TimerCounter, tick: u64) -> u32 {
        while counter.end().is_some_and(|end| end <= tick) {
            counter.turn();
        }
        counter.count(tick)
    }

    #[test]
    fn it_counts() {
        let up = [0, 1, 2, 3, 0, 1, 2, 3, 0];
        let both = [0, 1, 2, 3, 2, 1, 0, 1, 2];
        for (centre, expected) in [(false, up), (true, both)] {
            for prescaler in [0, 4] {
                let counter = counter(centre, prescaler, 3);
                let shown =
                    (0..9).map(|step| shown_count(counter, step * (u64::from(prescaler) + 1)));
                assert_eq!(shown.collect::<Vec<_>>(), expected);
            }
        }
    }

    #[test]
    fn a_match_is_where_the_count_is_the_value() {
        for (centre, directions, value, expected) in [
            (false, (true, true), 2, vec![2, 6, 10]),
            (false, (true, true), 4, vec![]),
            (true, (true, false), 1, vec![1, 7, 13]),
            (true, (false, true), 1, vec![5, 11, 17]),
            (true, (true, true), 0, vec![6, 12, 18]),
        ] {
            let counter = counter(centre, 0, 3);
            let mut found = Vec::new();
            let (mut now, mut moved) = (0, counter);
            while found.len() < 3 {
                let Some(tick) = moved.next_match(value, now, directions) else {
                    break;
                };
                found.push(tick);
                now = tick;
                while moved.end().is_some_and(|end| end <= now) {
                    moved.turn();
                }
            }
            assert_eq!(found, expected, "{centre} {directions:?} {value}");
        }
    }

    #[test]
    fn it_goes_on_where_it_stood() {
        let mut counter = counter(false, 0, 100);
        counter.run(false, 7);
        assert_eq!(counter.count(50), 7);
        counter.run(true, 60);
        assert_eq!(counter.count(63), 10);
        counter.set_count(90, 63);
        assert_eq!((counter.count(64), counter.end()), (91, Some(74)));
    }
}
