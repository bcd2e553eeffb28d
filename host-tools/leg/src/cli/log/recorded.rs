//! What came of the telemetry that was asked for.

use leg_base::tick_time::seconds;
use leg_firmware::host_link::Told;
use serde::Serialize;

/// How much later than asked a board tells, ticks: it looks about every millisecond.
const LATE_TICKS: u32 = 24;

/// So many late ones, one after the other, are no accident.
const LATE_MAX: u32 = 3;

/// What was recorded.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub(super) struct Recorded {
    /// Telemetry in the file.
    pub count: u64,
    /// Telemetry that the leg told and that did not come.
    pub lost: u64,
    /// Frames that could not be read.
    pub damaged_frames: u64,
    /// From the first to the last, s.
    pub length_s: f64,
    /// From one that the leg told to the next, on the average, s.
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

/// Counts what comes.
#[derive(Clone, Copy, Debug)]
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
    pub(super) const fn new(every_ticks: u16) -> Self {
        Self {
            every_ticks: every_ticks as u32,
            last: None,
            late: 0,
            ticks: 0,
            longest_ticks: 0,
            count: 0,
            lost: 0,
        }
    }

    /// Takes what the leg tells, unless it is none of this recording's.
    pub(super) fn take(&mut self, told: &Told) -> Result<(), Foreign> {
        let (number, tick) = (told.number, told.telemetry.tick);
        if let Some((last_number, last_tick)) = self.last {
            let ticks = tick.wrapping_sub(last_tick);
            // The leg's count of ticks runs over after six days: it went back only if it seems to have gone far ahead.
            if ticks > u32::MAX / 2 {
                return Err(Foreign::Restarted);
            }
            let steps = number.wrapping_sub(last_number);
            if steps == 1 {
                self.look(ticks)?;
            }
            self.lost += u64::from(steps.saturating_sub(1));
            self.ticks += u64::from(ticks);
            self.longest_ticks = self.longest_ticks.max(ticks);
        }
        self.last = Some((number, tick));
        self.count += 1;
        Ok(())
    }

    /// Looks whether this is how often this host has asked to be told.
    fn look(&mut self, ticks: u32) -> Result<(), Foreign> {
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
        let told = self.count + self.lost;
        let every_s = match told {
            0 | 1 => seconds(u64::from(self.every_ticks)),
            told => seconds(self.ticks) / (told - 1) as f64,
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
    pub(super) fn words(&self) -> String {
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
    use super::{Counter, Foreign};
    use leg_firmware::host_link::Told;
    use leg_host::operator::{Host, Interrupt, Operator};
    use leg_host::transport::emulated::Emulated;
    use leg_rig::rig_file::RigFile;
    use leg_sim::emulated_leg::{Beginning, EmulatedLeg};
    use leg_sim::simulation::InThisProcess;

    /// What a leg told, with number and tick as given, is taken one after the other.
    fn taken(every_ticks: u16, told: &[(u32, u32)]) -> (Counter, Result<(), Foreign>) {
        let rig = RigFile::load(None).unwrap();
        let controller = Box::new(InThisProcess::default());
        let leg = EmulatedLeg::new(&rig, Beginning::Hanging, controller).unwrap();
        let line = Box::new(Emulated::new(leg, "a leg").beside());
        let mut operator = Operator::open(line, Host::FIXED, Interrupt::default()).unwrap();
        let like = operator.telemetry().unwrap().telemetry;
        let mut counter = Counter::new(every_ticks);
        let taken = told.iter().try_for_each(|&(number, tick)| {
            let mut telemetry = like;
            telemetry.tick = tick;
            counter.take(&Told { number, telemetry })
        });
        (counter, taken)
    }

    #[test]
    fn what_is_lost_is_told_by_the_numbers_not_by_the_time() {
        // A board that looks every millisecond tells every 32 ticks when it is asked for 27.
        let (counter, taken) = taken(27, &[(5, 100), (6, 132), (7, 164), (9, 228), (10, 260)]);
        assert_eq!(taken, Ok(()));
        let recorded = counter.recorded(0);
        assert_eq!((recorded.count, recorded.lost), (5, 1));
        assert_eq!(recorded.every_s, 32.0 / 8000.0);
        assert_eq!(recorded.longest_s, 64.0 / 8000.0);
        assert_eq!(recorded.length_s, 160.0 / 8000.0);
    }

    #[test]
    fn a_leg_that_starts_anew_ends_the_recording() {
        let (counter, taken) = taken(80, &[(5, 8000), (6, 8080), (7, 40)]);
        assert_eq!(taken, Err(Foreign::Restarted));
        assert_eq!(counter.recorded(0).count, 2);
    }

    #[test]
    fn ticks_and_numbers_may_run_over() {
        let (counter, taken) = taken(80, &[(u32::MAX, u32::MAX - 39), (0, 40), (1, 120)]);
        assert_eq!(taken, Ok(()));
        assert_eq!(counter.ticks(), 160);
        assert_eq!(counter.recorded(0).lost, 0);
    }

    #[test]
    fn a_second_log_with_another_rate_is_noticed_by_the_one_that_loses() {
        let (_, sooner) = taken(80, &[(5, 100), (6, 180), (7, 220)]);
        assert_eq!(sooner, Err(Foreign::Every(0.005)));
        let (_, later) = taken(40, &[(5, 100), (6, 180), (7, 260), (8, 340)]);
        assert_eq!(later, Err(Foreign::Every(0.01)));
        // A pause, as beside another host's introduction, is none.
        let (_, paused) = taken(40, &[(5, 100), (6, 140), (7, 900), (8, 940)]);
        assert_eq!(paused, Ok(()));
    }
}
