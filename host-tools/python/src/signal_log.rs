//! Signals over time.

use crate::signals::{NumericSignal, Snapshot};

/// Most numbers that one recording keeps: 2 GB.
const NUMBERS_MAX: usize = 250_000_000;

/// A recording that goes on.
#[derive(Clone)]
pub struct SignalLog {
    every_ticks: u64,
    /// Ticks until the next row.
    left: u64,
    /// s.
    pub times_s: Vec<f64>,
    /// The signals, and the numbers of each, row by row.
    pub columns: Vec<(NumericSignal, Vec<f64>)>,
}

impl SignalLog {
    /// Of some signals, every so many ticks, from the next tick on.
    pub fn new(signals: &[NumericSignal], every_ticks: u64) -> Self {
        Self {
            every_ticks,
            left: 1,
            times_s: Vec::new(),
            columns: signals.iter().map(|signal| (*signal, Vec::new())).collect(),
        }
    }

    /// Whether the next tick's row is due.
    pub fn due(&mut self) -> bool {
        self.left -= 1;
        if self.left > 0 {
            return false;
        }
        self.left = self.every_ticks;
        true
    }

    /// Takes a row; false if there is no room for it.
    pub fn take(&mut self, snapshot: &Snapshot) -> bool {
        let width: usize = self.columns.iter().map(|(signal, _)| signal.width()).sum();
        if (self.times_s.len() + 1) * (width + 1) > NUMBERS_MAX {
            return false;
        }
        self.times_s.push(snapshot.simulated.truth.time_s);
        for (signal, numbers) in &mut self.columns {
            signal.read(snapshot, numbers);
        }
        true
    }
}
