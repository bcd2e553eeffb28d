//! The strikes, grouped by fault and what the leg was doing.

use super::activity::Activity;
use super::struck::Struck;
use serde::Serialize;
use std::collections::BTreeMap;

/// The worst of a measure, and the strike that had it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct WorstStrike {
    /// The measure.
    pub value: f64,
    /// The strike's number.
    pub index: u64,
}

impl WorstStrike {
    fn take(&mut self, value: f64, index: u64) {
        if value > self.value {
            *self = Self { value, index };
        }
    }
}

/// The worst of a measure by its bar.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct WorstByBar {
    /// The measure.
    pub value: f64,
    /// Its bar in that strike; zero until there is one.
    pub bar: f64,
    /// The strike's number.
    pub index: u64,
}

impl WorstByBar {
    fn take(&mut self, value: f64, bar: f64, index: u64) {
        if self.bar == 0.0 || value * self.bar > self.value * bar {
            *self = Self { value, bar, index };
        }
    }
}

/// The worst of each measure by its bar.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Measures {
    /// Highest true tension, N.
    pub tension_n: WorstByBar,
    /// The same while homing, N.
    pub homing_n: WorstByBar,
    /// How far the tip was from rest or off the way, mm.
    pub tip_mm: WorstByBar,
    /// Time to the first fault where there is a bar, s.
    pub named_s: WorstByBar,
}

impl Measures {
    fn take(&mut self, struck: &Struck) {
        let Some(bars) = struck.bars else { return };
        let index = struck.index;
        self.tension_n.take(struck.tension_n, bars.tension_n, index);
        self.homing_n.take(struck.homing_n, bars.homing_n, index);
        self.tip_mm.take(struck.tip_mm, bars.tip_mm, index);
        if let (Some(named_s), Some(bar_s)) = (struck.named_s, bars.named_s) {
            self.named_s.take(named_s, bar_s, index);
        }
    }
}

/// The strikes of one fault while the leg did one thing.
#[derive(Clone, Debug, Serialize)]
pub struct StrikeRow {
    /// The fault, by its name in scenarios.
    pub fault: &'static str,
    /// What the leg was doing.
    pub state: Activity,
    /// Strikes.
    pub count: u64,
    /// Highest true tension, N.
    pub tension_n: WorstStrike,
    /// Highest true tension while homing, N.
    pub homing_n: WorstStrike,
    /// How far the tip was from rest or off the way, mm.
    pub tip_mm: WorstStrike,
    /// Strikes after which the leg named a fault, and the longest time to it, s.
    pub named: u64,
    /// s.
    pub named_s: WorstStrike,
    /// The first names, and how often.
    pub names: BTreeMap<&'static str, u64>,
    /// Longest time that a motor was driven after the stop, s.
    pub driven_s: WorstStrike,
    /// The worst of each measure by its bar.
    pub by_bars: Measures,
    /// Strikes that failed.
    pub failed: u64,
    /// The first of them, and why.
    pub first_failed: Option<(u64, String)>,
}

/// The rows, by fault and what the leg was doing.
#[must_use]
pub fn rows(struck: &[Struck]) -> Vec<StrikeRow> {
    let mut rows: BTreeMap<(&str, Activity), StrikeRow> = BTreeMap::new();
    for one in struck {
        let row = rows.entry((one.fault, one.state));
        row.or_insert_with(|| StrikeRow::new(one)).take(one);
    }
    rows.into_values().collect()
}

impl StrikeRow {
    fn new(struck: &Struck) -> Self {
        Self {
            fault: struck.fault,
            state: struck.state,
            count: 0,
            tension_n: WorstStrike::default(),
            homing_n: WorstStrike::default(),
            tip_mm: WorstStrike::default(),
            named: 0,
            named_s: WorstStrike::default(),
            names: BTreeMap::new(),
            driven_s: WorstStrike::default(),
            by_bars: Measures::default(),
            failed: 0,
            first_failed: None,
        }
    }

    fn take(&mut self, struck: &Struck) {
        self.count += 1;
        self.tension_n.take(struck.tension_n, struck.index);
        self.homing_n.take(struck.homing_n, struck.index);
        self.tip_mm.take(struck.tip_mm, struck.index);
        self.driven_s.take(struck.driven_s, struck.index);
        self.by_bars.take(struck);
        if let (Some(name), Some(named_s)) = (struck.named, struck.named_s) {
            self.named += 1;
            self.named_s.take(named_s, struck.index);
            *self.names.entry(name).or_default() += 1;
        }
        if !struck.passes() {
            self.failed += 1;
            let why = || (struck.index, struck.failures.join(", "));
            self.first_failed.get_or_insert_with(why);
        }
    }
}
