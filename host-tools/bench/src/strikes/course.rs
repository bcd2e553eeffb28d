//! What tensions and motors of an unstruck leg do.

use super::naming::Unstruck;
use crate::stand::Stand;

/// How often it is looked at, s.
const EVERY_S: f64 = 1e-3;

/// Tensions and motors of a leg over time.
#[derive(Clone, Debug)]
pub(super) struct Course {
    first: Instant,
    rest: Vec<Instant>,
}

#[derive(Clone, Copy, Debug)]
struct Instant {
    time_s: f64,
    /// True, N.
    tensions_n: [f64; 3],
    /// How far each tendon is pulled in, m.
    pulled_m: [f64; 3],
}

impl Instant {
    fn now(stand: &Stand) -> Self {
        let telemetry = stand.telemetry.as_ref();
        Self {
            time_s: stand.time_s(),
            tensions_n: stand.truth.tensions_n,
            pulled_m: telemetry.map_or([0.0; 3], |telemetry| telemetry.pulled_m.map(f64::from)),
        }
    }
}

impl Course {
    /// Begins where a leg is now.
    pub fn begin(stand: &Stand) -> Self {
        Self {
            first: Instant::now(stand),
            rest: Vec::new(),
        }
    }

    pub fn add(&mut self, stand: &Stand) {
        let last = self.rest.last().unwrap_or(&self.first);
        if stand.time_s() >= last.time_s + EVERY_S {
            self.rest.push(Instant::now(stand));
        }
    }

    /// What comes from a time on, s.
    pub fn rest(&self, time_s: f64) -> Unstruck {
        let before = self.rest.partition_point(|one| one.time_s <= time_s);
        let (before, after) = self.rest.split_at(before);
        let first = before.last().unwrap_or(&self.first);
        let most = |of: &dyn Fn(&Instant) -> f64| after.iter().map(of).fold(of(first), f64::max);
        Unstruck {
            tensions_n: first.tensions_n,
            highest_n: std::array::from_fn(|i| most(&|instant| instant.tensions_n[i])),
            travels_m: std::array::from_fn(|i| {
                most(&|instant| (instant.pulled_m[i] - first.pulled_m[i]).abs())
            }),
        }
    }
}
