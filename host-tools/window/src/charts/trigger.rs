//! A trigger: the charts stand still around the time at which a signal passes a level.

use crate::history::History;

/// Which way the signal passes it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Edge {
    Rising,
    Falling,
}

/// What becomes of the trigger once it has caught something.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Mode {
    /// It is off.
    Once,
    /// It waits for the next time.
    Again,
}

/// What it does.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Watch {
    Off,
    /// It has looked at the signal up to that time, s.
    Armed(f64),
    /// The signal has passed the level at that time, s; what comes after it is waited for.
    Passed(f64),
}

/// It.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Trigger {
    /// The name of the signal; none until one is chosen.
    pub signal: Option<&'static str>,
    /// Which of its numbers.
    pub number: usize,
    pub edge: Edge,
    pub level: f64,
    pub mode: Mode,
    watch: Watch,
    /// The time that it caught last, s.
    caught_s: Option<f64>,
}

impl Default for Trigger {
    fn default() -> Self {
        Self {
            signal: None,
            number: 0,
            edge: Edge::Rising,
            level: 0.0,
            mode: Mode::Once,
            watch: Watch::Off,
            caught_s: None,
        }
    }
}

impl Trigger {
    /// Waits for what comes after a time, s.
    pub fn arm(&mut self, now_s: f64) {
        self.watch = Watch::Armed(now_s);
        self.caught_s = None;
    }

    /// Waits no more.
    pub fn disarm(&mut self) {
        self.watch = Watch::Off;
        self.caught_s = None;
    }

    /// Whether it waits for something.
    pub fn armed(&self) -> bool {
        self.watch != Watch::Off
    }

    /// The time that it caught last, s.
    pub const fn caught_s(&self) -> Option<f64> {
        self.caught_s
    }

    /// What it does, in words of one length.
    pub fn words(&self) -> String {
        match (self.watch, self.caught_s) {
            (Watch::Passed(at_s), _) => format!("passed {at_s:9.3} s"),
            (_, Some(at_s)) => format!("caught {at_s:9.3} s"),
            (Watch::Armed(_), None) => format!("{:18}", "waits"),
            (Watch::Off, None) => format!("{:18}", "off"),
        }
    }

    /// Looks at what came until now. The time around which the charts are to stand still, s, once so much was seen after it, s.
    pub fn advance(&mut self, history: &History, now_s: f64, after_s: f64) -> Option<f64> {
        if let Watch::Armed(since_s) = self.watch {
            // The leg's time may begin again.
            let since_s = since_s.min(now_s);
            let column = self.signal.and_then(|name| history.named(name))?;
            let mut last_s = since_s;
            let points = history.line(column, self.number, since_s);
            let passed = passing(
                points.inspect(|[time_s, _]| last_s = *time_s),
                self.edge,
                self.level,
            );
            self.watch = passed.map_or(Watch::Armed(last_s), Watch::Passed);
        }
        let Watch::Passed(at_s) = self.watch else {
            return None;
        };
        if now_s < at_s {
            self.watch = Watch::Armed(now_s);
            return None;
        }
        if now_s < at_s + after_s {
            return None;
        }
        self.caught_s = Some(at_s);
        self.watch = match self.mode {
            Mode::Once => Watch::Off,
            Mode::Again => Watch::Armed(now_s),
        };
        Some(at_s)
    }
}

/// When a signal passes a level for the first time, s.
fn passing(points: impl Iterator<Item = [f64; 2]>, edge: Edge, level: f64) -> Option<f64> {
    let mut last: Option<[f64; 2]> = None;
    for point in points {
        if let Some([from_s, from]) = last {
            let [to_s, to] = point;
            let passed = match edge {
                Edge::Rising => from < level && to >= level,
                Edge::Falling => from > level && to <= level,
            };
            if passed {
                return Some(from_s + (to_s - from_s) * (level - from) / (to - from));
            }
        }
        last = Some(point);
    }
    None
}

#[cfg(test)]
mod tests {
    use super::{Edge, Mode, Trigger, passing};
    use crate::history::History;

    #[test]
    fn a_level_is_passed_in_one_direction_and_between_samples() {
        let wave = [[0.0, 5.0], [1.0, 1.0], [2.0, 3.0], [3.0, 0.0]];
        let at = |edge, level| passing(wave.into_iter(), edge, level);
        assert_eq!(at(Edge::Rising, 2.0), Some(1.5));
        assert_eq!(at(Edge::Falling, 3.0), Some(0.5));
        assert_eq!(at(Edge::Rising, 3.0), Some(2.0));
        assert_eq!(at(Edge::Rising, 4.0), None);
        assert_eq!(at(Edge::Falling, -1.0), None);
    }

    /// A supply that falls from 24 V to 20 V at 2 s and comes back at 3 s, over and over.
    fn history(until_s: f64) -> History {
        let columns = History::live();
        let place = columns.named("supply_v").map_or(0, |column| column.start());
        let samples = (0..)
            .map(|i| f64::from(i) * 0.005)
            .take_while(move |time_s| *time_s <= until_s);
        let samples = samples.map(|time_s| {
            let mut numbers = vec![0.0; place + 1];
            numbers[place] = if (time_s % 3.0) < 2.0 { 24.0 } else { 20.0 };
            (time_s, numbers.into_boxed_slice())
        });
        History::recorded(false, samples)
    }

    fn trigger(mode: Mode) -> Trigger {
        let mut trigger = Trigger {
            signal: Some("supply_v"),
            edge: Edge::Falling,
            level: 22.0,
            mode,
            ..Trigger::default()
        };
        trigger.arm(0.5);
        trigger
    }

    /// What is caught in frames of 20 ms until a time.
    fn caught(trigger: &mut Trigger, until_s: f64) -> Vec<[f64; 2]> {
        let whole = history(until_s);
        let frames = (25..)
            .map(|frame| f64::from(frame) * 0.02)
            .take_while(|now_s| *now_s <= until_s);
        // The history of a frame is a part of the whole: what is later is not asked for.
        frames
            .filter_map(|now_s| {
                Some([
                    trigger.advance(&whole.part_until(now_s), now_s, 1.0)?,
                    now_s,
                ])
            })
            .collect()
    }

    #[test]
    fn once_is_once_and_the_chart_stands_still_when_enough_was_seen() {
        let mut trigger = trigger(Mode::Once);
        let caught = caught(&mut trigger, 9.0);
        assert_eq!(caught.len(), 1, "{caught:?}");
        let [at_s, now_s] = caught[0];
        assert!(
            (at_s - 1.9975).abs() < 0.003 && (now_s - at_s - 1.0).abs() < 0.03,
            "{caught:?}"
        );
        assert!(!trigger.armed() && trigger.caught_s() == Some(at_s));
        assert!(trigger.words().starts_with("caught"));
        trigger.arm(9.0);
        assert!(trigger.armed() && trigger.caught_s().is_none());
    }

    #[test]
    fn again_catches_the_next_ones_too() {
        let mut trigger = trigger(Mode::Again);
        let caught = caught(&mut trigger, 9.5);
        let times: Vec<i64> = caught.iter().map(|[at_s, _]| at_s.round() as i64).collect();
        assert_eq!(times, [2, 5, 8]);
        assert!(trigger.armed());
    }

    #[test]
    fn time_that_begins_again_does_not_keep_it_waiting() {
        let mut trigger = trigger(Mode::Once);
        trigger.arm(1000.0);
        assert_eq!(caught(&mut trigger, 4.0).len(), 1);
    }
}
