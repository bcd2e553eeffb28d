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

/// A signal that has numbers.
#[derive(Clone, Copy)]
enum Source {
    Reported(&'static Signal<Report>),
    Simulated(&'static Signal<Simulated>),
}

/// A signal, and where its numbers stand in a sample.
#[derive(Clone, Copy)]
pub struct Column {
    source: Source,
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
            Source::Reported(signal) => signal.name,
            Source::Simulated(signal) => signal.name,
        }
    }

    /// What it is and means.
    #[must_use]
    pub fn meaning(&self) -> String {
        let (origin, meaning) = match self.source {
            Source::Reported(signal) => (signal.origin, signal.meaning),
            Source::Simulated(signal) => (signal.origin, signal.meaning),
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
    pub fn of_reports() -> Self {
        Self::new(REPORT_SIGNALS, &[])
    }

    fn new(reported: &'static [Signal<Report>], simulated: &'static [Signal<Simulated>]) -> Self {
        let reported = reported
            .iter()
            .map(|signal| (signal.width(), Source::Reported(signal)));
        let simulated = simulated
            .iter()
            .map(|signal| (signal.width(), Source::Simulated(signal)));
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
            Self::of_reports()
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
                Source::Reported(signal) => signal.numbers(&snapshot.report, &mut self.numbers),
                Source::Simulated(signal) => {
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
    pub fn at(&self, column: Column, at_s: f64) -> &[f32] {
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
