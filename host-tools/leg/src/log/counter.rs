//! Counts the telemetry that arrives, and what is lost.

use leg_base::failure::Failure;
use leg_base::tick_time::seconds;
use serde::Serialize;

/// How much later than requested a board reports, ticks: it checks about every millisecond, which is 8 ticks.
const LATE_TICKS: u32 = 24;

/// So many late ones in a row mean that another host has asked for another rate.
const LATE_MAX: u32 = 3;

/// What was recorded.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub(super) struct Recorded {
    /// Telemetry in the file.
    pub count: u64,
    /// Telemetry that the leg sent and that did not arrive.
    pub lost: u64,
    /// Frames that could not be read.
    pub damaged_frames: u64,
    /// From the first to the last, s.
    pub length_s: f64,
    /// From one that the leg sent to the next, on the average, s.
    pub every_s: f64,
    /// From one in the file to the next at most, s.
    pub longest_s: f64,
}

/// Why telemetry does not belong to the recording.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Foreign {
    /// The leg has started anew: its time begins again.
    Restarted,
    /// It comes as often as another host has asked, s.
    Every(f64),
}

impl Foreign {
    pub(super) fn failure(self) -> Failure {
        match self {
            Self::Restarted => Failure::failed(
                "the leg started anew, and its time begins again",
                "the file ends there; log again for what follows",
            ),
            Self::Every(s) => Failure::failed(
                format!(
                    "another host has asked the leg to report every {} ms",
                    s * 1000.0
                ),
                "the file ends there; end the other `leg log`, or give both the same --rate",
            ),
        }
    }
}

/// Counts what comes.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Counter {
    every_ticks: u32,
    /// Number and tick of the last.
    last: Option<(u32, u32)>,
    /// How many came late, one after the other.
    late: u32,
    ticks: u64,
    longest_ticks: u32,
    count: u64,
    lost: u64,
}

impl Counter {
    pub(super) fn new(every_ticks: u16) -> Self {
        Self {
            every_ticks: every_ticks.into(),
            ..Self::default()
        }
    }

    /// Counts telemetry by its number and tick, unless it is not of this recording.
    pub(super) fn take(&mut self, number: u32, tick: u32) -> Result<(), Foreign> {
        if let Some((last_number, last_tick)) = self.last {
            let ticks = tick.wrapping_sub(last_tick);
            // The leg's count of ticks runs over after six days: it went back only if it seems to have gone far ahead.
            if ticks > u32::MAX / 2 {
                return Err(Foreign::Restarted);
            }
            let steps = number.wrapping_sub(last_number);
            if steps == 1 {
                self.check_rate(ticks)?;
            }
            self.lost += u64::from(steps.saturating_sub(1));
            self.ticks += u64::from(ticks);
            self.longest_ticks = self.longest_ticks.max(ticks);
        }
        self.last = Some((number, tick));
        self.count += 1;
        Ok(())
    }

    /// Checks that this is the rate for which this host has asked.
    fn check_rate(&mut self, ticks: u32) -> Result<(), Foreign> {
        let late = ticks > self.every_ticks + LATE_TICKS;
        self.late = if late { self.late + 1 } else { 0 };
        if ticks < self.every_ticks || self.late >= LATE_MAX {
            return Err(Foreign::Every(seconds(u64::from(ticks))));
        }
        Ok(())
    }

    /// From the first to the last, ticks.
    pub(super) const fn ticks(&self) -> u64 {
        self.ticks
    }

    pub(super) fn recorded(&self, damaged_frames: u64) -> Recorded {
        let sent = self.count + self.lost;
        let every_s = match sent {
            0 | 1 => seconds(u64::from(self.every_ticks)),
            sent => seconds(self.ticks) / (sent - 1) as f64,
        };
        Recorded {
            count: self.count,
            lost: self.lost,
            damaged_frames,
            length_s: seconds(self.ticks),
            every_s,
            longest_s: seconds(u64::from(self.longest_ticks)),
        }
    }
}

impl Recorded {
    pub(super) fn text(&self) -> String {
        let damaged = match self.damaged_frames {
            0 => String::new(),
            count => format!(", {count} frames damaged"),
        };
        format!(
            "{} times in {:.3} s, every {:.3} ms, at most {:.3} ms apart; {} lost on the way{damaged}\n",
            self.count,
            self.length_s,
            self.every_s * 1000.0,
            self.longest_s * 1000.0,
            self.lost
        )
    }
}

#[cfg(test)]
mod tests {
    use super::{Counter, Foreign};

    /// Requested ticks, number and tick of each telemetry, the end, and how much is counted and lost until then.
    type Case = (u16, &'static [(u32, u32)], Result<(), Foreign>, [u64; 2]);

    const MAX: u32 = u32::MAX;

    const CASES: [Case; 6] = [
        // A board that checks every millisecond reports every 32 ticks when it is asked for 27; the numbers show a loss.
        (
            27,
            &[(5, 100), (6, 132), (7, 164), (9, 228), (10, 260)],
            Ok(()),
            [5, 1],
        ),
        // A leg that restarts ends the recording.
        (
            80,
            &[(5, 8000), (6, 8080), (7, 40)],
            Err(Foreign::Restarted),
            [2, 0],
        ),
        // Ticks and numbers may wrap.
        (80, &[(MAX, MAX - 39), (0, 40), (1, 120)], Ok(()), [3, 0]),
        // A second log with another rate is noticed by the one that loses.
        (
            80,
            &[(5, 100), (6, 180), (7, 220)],
            Err(Foreign::Every(0.005)),
            [2, 0],
        ),
        (
            40,
            &[(5, 100), (6, 180), (7, 260), (8, 340)],
            Err(Foreign::Every(0.01)),
            [3, 0],
        ),
        // A pause, as while another host introduces itself, is none.
        (
            40,
            &[(5, 100), (6, 140), (7, 900), (8, 940)],
            Ok(()),
            [4, 0],
        ),
    ];

    #[test]
    fn telemetry_is_counted_until_it_is_not_of_this_recording() {
        for (every_ticks, replies, expected, [count, lost]) in CASES {
            let mut counter = Counter::new(every_ticks);
            let ended = replies
                .iter()
                .try_for_each(|&(number, tick)| counter.take(number, tick));
            assert_eq!(ended, expected);
            let recorded = counter.recorded(0);
            assert_eq!([recorded.count, recorded.lost], [count, lost]);
            if every_ticks == 27 {
                let times = [recorded.every_s, recorded.longest_s, recorded.length_s];
                assert_eq!(times, [32.0 / 8000.0, 64.0 / 8000.0, 160.0 / 8000.0]);
            }
        }
    }
}
