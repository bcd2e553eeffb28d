//! What the signals of the leg were in the last seconds.

use leg_sim::signals::{REPORT_SIGNALS, Report, SIMULATED_SIGNALS, Signal, Simulated};
use std::collections::VecDeque;

/// How much is kept, s.
pub const KEPT_S: f64 = 30.0;

/// Samples of a second.
pub const SAMPLE_HZ: u32 = 200;

const KEPT: usize = (KEPT_S as usize) * (SAMPLE_HZ as usize);

/// The leg at a time.
pub struct Snapshot {
    /// What it reports.
    pub report: Report,
    /// How it is, if it is simulated.
    pub simulated: Option<Simulated>,
}

/// How names end, and the unit of that: the longer ends first.
const UNITS: [(&str, &str); 13] = [
    ("_nm_per_rad", "N·m/rad"),
    ("_rad_per_s", "rad/s"),
    ("_deg", "°"),
    ("_kg", "kg"),
    ("_mm", "mm"),
    ("_nm", "N·m"),
    ("_rad", "rad"),
    ("_a", "A"),
    ("_c", "°C"),
    ("_m", "m"),
    ("_n", "N"),
    ("_s", "s"),
    ("_v", "V"),
];

/// A signal that has numbers.
#[derive(Clone, Copy)]
enum Origin {
    Reported(&'static Signal<Report>),
    Simulated(&'static Signal<Simulated>),
}

/// A signal, and where its numbers stand in a sample.
#[derive(Clone, Copy)]
pub struct Column {
    source: Origin,
    /// The first of its numbers.
    start: usize,
    /// How many.
    pub width: usize,
}

impl Column {
    /// Its name, which ends with its unit.
    #[must_use]
    pub const fn name(&self) -> &'static str {
        match self.source {
            Origin::Reported(signal) => signal.name,
            Origin::Simulated(signal) => signal.name,
        }
    }

    /// Where its first number stands in a sample.
    #[must_use]
    pub const fn start(&self) -> usize {
        self.start
    }

    /// The unit with which its name ends; empty if it has none.
    #[must_use]
    pub fn unit(&self) -> &'static str {
        let name = self.name();
        let mut units = UNITS.iter();
        let found = units.find(|(end, _)| name.ends_with(end));
        found.map_or("", |(_, unit)| unit)
    }

    /// What its number of that place is called.
    #[must_use]
    pub fn part_name(&self, number: usize) -> String {
        let name = self.name();
        let is_vector = ["tip_", "direction_"]
            .iter()
            .any(|begin| name.starts_with(begin));
        match ["x", "y", "z"].get(number) {
            Some(axis) if is_vector => (*axis).into(),
            _ => (number + 1).to_string(),
        }
    }

    /// What it is and means.
    #[must_use]
    pub fn meaning(&self) -> String {
        let (origin, meaning) = match self.source {
            Origin::Reported(signal) => (signal.origin, signal.meaning),
            Origin::Simulated(signal) => (signal.origin, signal.meaning),
        };
        format!("{}: {meaning}", origin.words())
    }
}

/// The samples of every signal that has numbers.
#[derive(Clone)]
pub struct History {
    columns: Vec<Column>,
    /// The time of each, s, and its numbers.
    samples: VecDeque<(f64, Box<[f32]>)>,
    numbers: Vec<f64>,
    /// How many samples are kept.
    kept: usize,
}

impl Default for History {
    fn default() -> Self {
        Self::new(REPORT_SIGNALS, SIMULATED_SIGNALS)
    }
}

impl History {
    /// Of a leg that says nothing but its reports.
    #[must_use]
    pub fn live() -> Self {
        Self::new(REPORT_SIGNALS, &[])
    }

    fn new(reported: &'static [Signal<Report>], simulated: &'static [Signal<Simulated>]) -> Self {
        let reported = reported
            .iter()
            .map(|signal| (signal.width(), Origin::Reported(signal)));
        let simulated = simulated
            .iter()
            .map(|signal| (signal.width(), Origin::Simulated(signal)));
        let mut start = 0;
        let mut columns = Vec::new();
        for (width, source) in reported.chain(simulated) {
            let Some(width) = width else { continue };
            columns.push(Column {
                source,
                start,
                width,
            });
            start += width;
        }
        Self {
            columns,
            samples: VecDeque::with_capacity(KEPT),
            numbers: Vec::with_capacity(start),
            kept: KEPT,
        }
    }

    /// Of a recording: each time, s, with the numbers of what was reported and, of a simulated leg, of what is true of it.
    pub fn recorded(simulated: bool, samples: impl Iterator<Item = (f64, Box<[f32]>)>) -> Self {
        let empty = if simulated {
            Self::default()
        } else {
            Self::live()
        };
        Self {
            samples: samples.collect(),
            kept: usize::MAX,
            ..empty
        }
    }

    /// Keeps the leg as it is now, and forgets what is too old.
    pub fn take(&mut self, time_s: f64, snapshot: &Snapshot) {
        self.numbers.clear();
        for column in &self.columns {
            match column.source {
                Origin::Reported(signal) => signal.numbers(&snapshot.report, &mut self.numbers),
                Origin::Simulated(signal) => {
                    if let Some(simulated) = &snapshot.simulated {
                        signal.numbers(simulated, &mut self.numbers);
                    }
                }
            }
        }
        if self.samples.len() >= self.kept {
            self.samples.pop_front();
        }
        let numbers = self.numbers.iter().map(|number| *number as f32);
        self.samples.push_back((time_s, numbers.collect()));
    }

    /// The same until a time, s.
    #[cfg(test)]
    pub fn part_until(&self, until_s: f64) -> Self {
        let samples = self.samples.iter();
        let until = samples.take_while(|(time_s, _)| *time_s <= until_s);
        Self {
            samples: until.cloned().collect(),
            ..self.clone()
        }
    }

    /// Every signal.
    #[must_use]
    pub fn columns(&self) -> &[Column] {
        &self.columns
    }

    /// That of a name.
    #[must_use]
    pub fn named(&self, name: &str) -> Option<Column> {
        let mut columns = self.columns.iter();
        columns.find(|column| column.name() == name).copied()
    }

    /// One number of a signal over time since a time, s.
    pub fn line(
        &self,
        column: Column,
        number: usize,
        since_s: f64,
    ) -> impl Iterator<Item = [f64; 2]> + '_ {
        let first = self
            .samples
            .partition_point(|(time_s, _)| *time_s < since_s);
        let values = self.samples.range(first..);
        values.filter_map(move |(time_s, numbers)| {
            let value = f64::from(*numbers.get(column.start + number)?);
            value.is_finite().then_some([*time_s, value])
        })
    }

    /// The numbers of a signal at a time, s: those of the last sample until then, or of the first.
    #[must_use]
    pub fn numbers_at(&self, column: Column, at_s: f64) -> &[f32] {
        let after = self.samples.partition_point(|(time_s, _)| *time_s <= at_s);
        self.numbers_of(column, self.samples.get(after.saturating_sub(1)))
    }

    fn numbers_of<'a>(&self, column: Column, sample: Option<&'a (f64, Box<[f32]>)>) -> &'a [f32] {
        sample
            .and_then(|(_, numbers)| numbers.get(column.start..column.start + column.width))
            .unwrap_or(&[])
    }

    /// The last numbers of a signal.
    #[must_use]
    pub fn last(&self, column: Column) -> &[f32] {
        self.numbers_of(column, self.samples.back())
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test may panic")]
mod tests {
    use super::History;

    #[test]
    fn units_are_those_of_the_names() {
        let history = History::default();
        for (name, unit) in [
            ("tip_error_mm", "mm"),
            ("tensions_n", "N"),
            ("stiffness_nm_per_rad", "N·m/rad"),
            ("load_nm", "N·m"),
            ("duties", ""),
            ("motor_speeds_true_rad_per_s", "rad/s"),
            ("supply_v", "V"),
            ("pulled_m", "m"),
        ] {
            assert_eq!(history.named(name).unwrap().unit(), unit, "{name}");
        }
    }

    #[test]
    fn numbers_of_axes_and_of_tendons_have_their_names() {
        let history = History::default();
        for (name, names) in [
            ("tip_estimated_mm", ["x", "y", "z"]),
            ("tensions_n", ["1", "2", "3"]),
        ] {
            let column = history.named(name).unwrap();
            assert_eq!([0, 1, 2].map(|number| column.part_name(number)), names);
        }
    }

    #[test]
    fn a_time_has_the_numbers_of_the_last_sample_until_then() {
        let columns = History::default();
        let width: usize = columns.columns().iter().map(|column| column.width).sum();
        let samples = [1.0_f32, 2.0].map(|at| (f64::from(at), vec![at; width].into()));
        let history = History::recorded(true, samples.into_iter());
        let column = history.named("tensions_true_n").unwrap();
        for (at_s, expected) in [(0.5, 1.0), (1.0, 1.0), (1.9, 1.0), (2.0, 2.0), (9.0, 2.0)] {
            assert_eq!(history.numbers_at(column, at_s), [expected; 3], "{at_s}");
        }
    }
}
