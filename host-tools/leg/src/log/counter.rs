//! Counts the telemetry that arrives, and what is lost.

use leg_base::failure::Failure;
use leg_base::tick_time::seconds;
use serde::Serialize;

/// How much later than requested a board reports, ticks: it checks about every millisecond, which is 8 ticks.
const LATE_TICKS: u32 = 24;

/// How many late ones after the first in a row are left alone, where the leg was asked again for its rate.
const LATE_ASKED: u32 = 3;

/// What was recorded.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub(super) struct RecordedCounts {
    /// Telemetry in the file.
    pub count: u64,
    /// Telemetry that the leg sent and that did not arrive.
    pub lost: u64,
    /// Frames that could not be read.
    pub damaged_frames: u64,
    /// From the first to the last, s.
    pub length_s: f64,
    /// From one in the file to the next, on the average, s.
    pub every_s: f64,
    /// From one in the file to the next at most, s.
    pub longest_s: f64,
}

/// The leg has started anew: its time begins again.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Restarted;

impl From<Restarted> for Failure {
    fn from(_: Restarted) -> Self {
        Self::failed(
            "the leg started anew, and its time begins again",
            "the file ends there; log again for what follows",
        )
    }
}

/// What is to be done with telemetry.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Taken {
    /// It belongs into the file.
    pub due: bool,
    /// It came late, as where another host has asked for a lower rate: the leg has to be asked again.
    pub ask_again: bool,
}

/// Counts what comes, and chooses what is recorded: another host may have asked for a higher rate.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct SampleCounter {
    every_ticks: u32,
    /// Number and tick of the last that came.
    last: Option<(u32, u32)>,
    /// Ticks since the one in the file before it was due; none before the first.
    since_due: Option<u32>,
    /// How many came late, one after the other.
    late: u32,
    /// From the first in the file to the last that came.
    ticks: u64,
    /// From the first in the file to the last there.
    recorded_ticks: u64,
    longest_ticks: u64,
    count: u64,
    lost: u64,
}

impl SampleCounter {
    pub(super) fn new(every_ticks: u16) -> Self {
        Self {
            every_ticks: every_ticks.into(),
            ..Self::default()
        }
    }

    /// Counts telemetry by its number and tick.
    pub(super) fn take(&mut self, number: u32, tick: u32) -> Result<Taken, Restarted> {
        let mut ask_again = false;
        if let Some((last_number, last_tick)) = self.last {
            let ticks = tick.wrapping_sub(last_tick);
            // The leg's count of ticks runs over after six days: it went back only if it seems to have gone far ahead.
            if ticks > u32::MAX / 2 {
                return Err(Restarted);
            }
            let steps = number.wrapping_sub(last_number);
            self.lost += u64::from(steps.saturating_sub(1));
            let late = steps == 1 && ticks > self.every_ticks + LATE_TICKS;
            ask_again = late && self.late.is_multiple_of(LATE_ASKED);
            self.late = if late { self.late + 1 } else { 0 };
            self.ticks += u64::from(ticks);
            self.since_due = self.since_due.map(|since| since.saturating_add(ticks));
        }
        self.last = Some((number, tick));
        let due = self.is_due();
        if due {
            let apart = self.ticks - self.recorded_ticks;
            self.longest_ticks = self.longest_ticks.max(apart);
            self.recorded_ticks = self.ticks;
            self.count += 1;
        }
        Ok(Taken { due, ask_again })
    }

    /// Whether the last belongs into the file. The rate is kept on the average: what came late makes the next one due earlier.
    fn is_due(&mut self) -> bool {
        let over = match self.since_due {
            Some(since) if since < self.every_ticks => return false,
            Some(since) => since - self.every_ticks,
            None => 0,
        };
        // After a gap nothing is made up for.
        self.since_due = Some(if over < self.every_ticks { over } else { 0 });
        true
    }

    /// From the first to the last, ticks.
    pub(super) const fn ticks(&self) -> u64 {
        self.ticks
    }

    pub(super) fn recorded(&self, damaged_frames: u64) -> RecordedCounts {
        let every_s = match self.count {
            0 | 1 => seconds(u64::from(self.every_ticks)),
            count => seconds(self.recorded_ticks) / (count - 1) as f64,
        };
        RecordedCounts {
            count: self.count,
            lost: self.lost,
            damaged_frames,
            length_s: seconds(self.recorded_ticks),
            every_s,
            longest_s: seconds(self.longest_ticks),
        }
    }
}

impl RecordedCounts {
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
#[allow(clippy::unwrap_used, reason = "a test may panic")]
mod tests {
    use super::{Restarted, SampleCounter};

    /// Requested ticks, number and tick of each telemetry, the end, and how much is recorded and lost until then.
    type Case = (u16, &'static [(u32, u32)], Result<(), Restarted>, [u64; 2]);

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
        (80, &[(5, 8000), (6, 8080), (7, 40)], Err(Restarted), [2, 0]),
        // Ticks and numbers may wrap.
        (80, &[(MAX, MAX - 39), (0, 40), (1, 120)], Ok(()), [3, 0]),
        // Another host has a higher rate: of its telemetry every second is recorded, and of a rate between on the average as much.
        (
            80,
            &[(5, 100), (6, 140), (7, 180), (8, 220), (9, 260)],
            Ok(()),
            [3, 0],
        ),
        (
            80,
            &[(1, 0), (2, 48), (3, 96), (4, 144), (5, 192), (6, 240)],
            Ok(()),
            [4, 0],
        ),
        // After a gap the next is not followed by one that makes up for it.
        (
            40,
            &[(5, 100), (6, 140), (7, 900), (8, 920), (9, 940)],
            Ok(()),
            [4, 0],
        ),
    ];

    #[test]
    fn telemetry_is_recorded_as_often_as_it_was_asked_for() {
        for (every_ticks, replies, expected, [count, lost]) in CASES {
            let mut counter = SampleCounter::new(every_ticks);
            let mut taken = replies
                .iter()
                .map(|&(number, tick)| counter.take(number, tick));
            let ended = taken.try_for_each(|taken| taken.map(|_| ()));
            assert_eq!(ended, expected);
            let recorded = counter.recorded(0);
            assert_eq!(
                [recorded.count, recorded.lost],
                [count, lost],
                "{replies:?}"
            );
            if every_ticks == 27 {
                let times = [recorded.every_s, recorded.longest_s, recorded.length_s];
                assert_eq!(times, [40.0 / 8000.0, 64.0 / 8000.0, 160.0 / 8000.0]);
            }
        }
    }

    /// At once, and then not every time: the leg may not be able to do more. A loss is none.
    #[test]
    fn a_lower_rate_has_the_leg_asked_again() {
        let mut counter = SampleCounter::new(40);
        let replies = [
            (5, 100, false),
            (6, 180, true),
            (7, 260, false),
            (8, 340, false),
            (9, 420, true),
            (10, 460, false),
            (12, 540, false),
            (13, 620, true),
        ];
        for (number, tick, ask_again) in replies {
            let taken = counter.take(number, tick).unwrap();
            assert_eq!(taken.ask_again, ask_again, "{number}");
        }
    }
}
