//! Faults that strike a simulated leg wherever it is and whatever it does, and what they do to it.
//!
//! A [`Case`] is a rig, a pose, a payload, a pretension and what the leg is doing. The leg is brought there
//! once, and clones of it are struck by one fault each. Everything is measured on the true leg and judged by bars:
//! the highest tension, the way of the tip, the time until the fault is named, and motors that turn after the stop.

mod activity;
mod bars;
mod case;
mod course;
mod cut_off;
mod false_alarms;
mod naming;
mod preparation;
mod push;
mod strike;
mod struck;
mod table;
mod way;

pub use activity::Activity;
pub use bars::StrikeBars;
pub use case::Case;
pub use false_alarms::{Alarm, UseResult};
pub use strike::Moment;
pub use struck::Struck;
pub use table::{Measures, StrikeRow, WorstByBar, WorstStrike, rows};

use crate::draw::mixed;
use case::{SLOTS, kind_of, name_of};
use fastrand::Rng;
use leg_rig::rig_file::RigFile;
use leg_sim::plant::Defect;
use rayon::prelude::*;
use serde::Serialize;

/// Longest time that one user goes on, s.
const PART_S: f64 = 600.0;

/// Which strikes are made.
#[derive(Clone, Debug)]
pub struct StrikeCampaign {
    /// Everything random follows from it.
    pub seed: u64,
    /// The rigs by name.
    pub rigs: Vec<(String, RigFile)>,
    /// What the leg may be doing; empty for all.
    pub activities: Vec<Activity>,
    /// The faults, by their names in scenarios, or `none`; empty for all.
    pub faults: Vec<String>,
}

/// For so many ticks in a row, 0.1 s, a leg and its shadow in f64 may differ in state or faults: a limit at its edge, as a stiffness that is hardly
/// out of reach, and a fault that comes slowly to its limit.
const OTHER_TICKS: u64 = 800;

/// What came of all strikes.
#[derive(Clone, Debug, Serialize)]
pub struct StrikeSummary {
    /// How many there were.
    pub strikes: usize,
    /// How many were beyond a bar.
    pub failed: usize,
    /// The numbers of those that left their shadow in f64, and how many of so many may: two, and one of each thousand. Three of 6080 did.
    pub left_shadow: Vec<u64>,
    /// See `left_shadow`.
    pub left_shadow_at_most: usize,
    /// Whether neither is too many.
    pub passed: bool,
}

impl StrikeSummary {
    /// Of strikes.
    #[must_use]
    pub fn new(struck: &[Struck]) -> Self {
        let failed = struck.iter().filter(|struck| !struck.passes()).count();
        let left = struck.iter().filter(|struck| struck.left_shadow);
        let left_shadow: Vec<u64> = left.map(|struck| struck.index).collect();
        let left_shadow_at_most = 2 + struck.len() / 1000;
        Self {
            strikes: struck.len(),
            failed,
            passed: failed == 0 && left_shadow.len() <= left_shadow_at_most,
            left_shadow,
            left_shadow_at_most,
        }
    }
}

impl StrikeCampaign {
    /// Makes so many strikes, on all cores, and calls `done` after each. They come in the order of their numbers.
    pub fn run(&self, count: u64, done: impl Fn() + Sync) -> Vec<Struck> {
        let cases = self.cases(count);
        let struck = cases
            .par_iter()
            .flat_map_iter(|(number, slots)| self.strike(*number, slots, &done));
        struck.collect()
    }

    /// Uses each rig for a time, s, without a fault, on all cores, and calls `done` with seconds that are over. Each
    /// part takes ten minutes of the leg's time, and is as it is whatever the whole time.
    pub fn use_legs(&self, time_s: f64, done: impl Fn(u64) + Sync) -> Vec<UseResult> {
        let parts = (time_s / PART_S).ceil() as u64;
        let rigs = self.rigs.len() as u64;
        let usage = |number| {
            let (rig, file) = &self.rigs[(number % rigs) as usize];
            let part_s = PART_S.min(time_s - PART_S * (number / rigs) as f64);
            false_alarms::use_leg(self.seed, rig, file, number, part_s, &done)
        };
        (0..parts * rigs).into_par_iter().map(usage).collect()
    }

    /// The use of a part again, until a time, s.
    #[must_use]
    pub fn repeat_use(&self, part: u64, time_s: f64) -> UseResult {
        let (rig, file) = &self.rigs[(part % self.rigs.len() as u64) as usize];
        false_alarms::use_leg(self.seed, rig, file, part, time_s, &|_| ())
    }

    /// The strike of a number again, with its course every so many seconds.
    #[must_use]
    pub fn repeat(&self, index: u64, every_s: f64) -> (Struck, Vec<Moment>) {
        let mut case = Case::new(self.seed, &self.rigs, index / SLOTS);
        match preparation::prepare(&mut case) {
            Ok(prepared) => strike::strike(&case, &prepared, &self.fault_of(index), Some(every_s)),
            Err(reason) => (Struck::not_prepared(&case, index, reason), Vec::new()),
        }
    }

    /// Strikes a case in some of its slots; once and without a fault where it cannot be brought there.
    fn strike(&self, number: u64, slots: &[u64], done: &(impl Fn() + Sync)) -> Vec<Struck> {
        let mut case = Case::new(self.seed, &self.rigs, number);
        let first = number * SLOTS;
        let prepared = match preparation::prepare(&mut case) {
            Ok(prepared) => prepared,
            Err(reason) => return vec![Struck::not_prepared(&case, first + slots[0], reason)],
        };
        let strike = |slot: &u64| {
            let struck = strike::strike(&case, &prepared, &self.fault_of(first + slot), None).0;
            done();
            struck
        };
        slots.iter().map(strike).collect()
    }

    /// What strikes in a number.
    fn fault_of(&self, index: u64) -> struck::Strike {
        let mut rng = Rng::with_seed(mixed(self.seed, index) ^ 1);
        let (kind, tendon) = (kind_of(index / SLOTS, index % SLOTS), rng.usize(0..3));
        struck::Strike {
            index,
            defect: kind.and_then(|kind| Defect::numbered(kind, tendon)),
            name: name_of(kind),
            tendon,
        }
    }

    /// The numbers of the first cases that have so many strikes, each with its slots.
    fn cases(&self, count: u64) -> Vec<(u64, Vec<u64>)> {
        let (mut cases, mut left) = (Vec::new(), count as usize);
        // A filter that nothing passes must not search for ever.
        for number in 0..count.saturating_mul(200).max(10_000) {
            if left == 0 {
                break;
            }
            if !self.has(Activity::nth(number)) {
                continue;
            }
            let mut slots: Vec<u64> = (0..SLOTS)
                .filter(|slot| self.asks_for(kind_of(number, *slot)))
                .collect();
            slots.truncate(left);
            left -= slots.len();
            if !slots.is_empty() {
                cases.push((number, slots));
            }
        }
        cases
    }

    fn has(&self, activity: Activity) -> bool {
        self.activities.is_empty() || self.activities.contains(&activity)
    }

    fn asks_for(&self, kind: Option<usize>) -> bool {
        self.faults.is_empty() || self.faults.iter().any(|name| name == name_of(kind))
    }
}
