//! Finds the zero: the leg hangs free, and one tendon after the other is reeled in until it just pulls.
//!
//! Slack tendons show the zero of the load cells. One taut tendon and the leg's own weight settle where the leg rests, and so
//! how long that tendon is.

mod haul_limit;
mod rest_search;
mod tendon_number;

use super::{AxisGoal, Debounce, Measured, Mechanism, filter::LowPass, ticks};
use crate::settings;
pub use haul_limit::HaulLimit;
use leg_model::Scalar;
use rest_search::RestSearch;
use tendon_number::TendonNumber;

/// What homing does now.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum HomingPhase {
    /// Every tendon is paid out, until that changes no tension any more.
    Release,
    /// The slack load cells are averaged.
    Tare,
    /// One tendon is reeled in.
    ReelIn(TendonNumber),
    /// The leg comes to rest on it.
    Settle(TendonNumber),
    /// Its tension and position are averaged.
    Average(TendonNumber),
    /// The pose in which the leg rests on it is searched for, one step a tick.
    Search(TendonNumber),
    /// It is paid out again.
    PayOut(TendonNumber),
}

/// What a tick of homing asks for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum HomingStep<T> {
    /// Lead the axes there.
    Lead([AxisGoal<T>; 3]),
    /// The load cells are slack: their averages are their zero, N.
    Tare([T; 3]),
    /// The length of each tendon without tension when the board started, m.
    Found([T; 3]),
    /// Nothing but time.
    Searching,
    /// A load cell is too far off, a tendon did not become slack or taut within its travel, or the leg does not come to rest
    /// on it as its weight says; the tendon counts from 1.
    Failed(u8),
}

/// The course of homing.
#[derive(Clone, Copy, Debug)]
pub struct HomingSequence<T> {
    phase: HomingPhase,
    left: u32,
    goals_m: [T; 3],
    /// How far every tendon was paid out, m, and the tensions before the last step of that, N.
    released_m: T,
    before_n: Option<[T; 3]>,
    sums: [T; 3],
    position_sum: T,
    count: u32,
    steady: [LowPass<T>; 3],
    /// What each motor does not draw for long, and how long it has.
    limits: [HaulLimit<T>; 3],
    hauling: [Debounce; 3],
    found: [T; 3],
    rest: RestSearch<T>,
    start_m: T,
    times: HomingTimes,
    speed: T,
    release_m: T,
    tare_max_n: T,
    touch_n: T,
    /// A tendon that shows no more than this is slack, N.
    slack_n: T,
    travel_m: T,
    /// How near to its goal a tendon has arrived, m.
    arrived_m: T,
}

#[derive(Clone, Copy, Debug)]
struct HomingTimes {
    tare: u32,
    settle: u32,
    average: u32,
    /// In which a tendon that is reeled in is slack yet.
    slack: u32,
}

/// Lowest tension with which a leg at rest rests on a tendon, as a part of the tension of the touch: the leg swings at the
/// touch, so most of that tension is gone when it has come to rest. At the default touch of 2 N it is 0.04 N, enough to
/// distinguish a leg that rests from one that hangs free. Scenario `homing` holds it.
const REST_PART: f32 = 0.02;

/// Time constant of the filter that detects a touch, s: forty ticks average the noise of the load cells out, and at 10 mm/s the
/// tendon moves by 0.05 mm meanwhile.
const TOUCH_TIME_S: f32 = 0.005;

/// Change of a tension over a step of the release below which the tendon counts as slack, as a part of the tension of a
/// touch: the offset of the cell is not known yet, but it does not change. A quarter is 0.5 N at the default touch: above the
/// noise, and far below what a taut tendon loses over a step of 4 mm.
const SLACK_PART: f32 = 0.25;

/// Tension that a slack tendon may show after the tare, as a part of the tension of a touch: twice what [`SLACK_PART`] allows, for
/// the zero has had time to drift, and half of what would be taken for a touch.
const OTHER_PART: f32 = 0.5;

/// Time for which a motor draws more than any tension of homing asks for, s, before homing ends: longer than a motor takes to
/// start, short enough that the tension rises by 3 N at most.
const HAUL_TIME_S: f32 = 0.03;

/// Part of a step of the release over which a tendon that is reeled in is slack yet. The last step changed no tension: all of it is slack,
/// but for what a tendon that pulled by less than [`SLACK_PART`] may have lost.
const SLACK_PART_OF_RELEASE: f32 = 0.5;

/// A tendon this near to its goal, beside the servo's dead band, has arrived, m: far below a step of the release.
const ARRIVED_M: f32 = 1e-4;

impl<T: Scalar> HomingSequence<T> {
    /// Starts from where the tendons are, m.
    /// None of the motors may draw more than its limit but for moments, and none comes nearer to its goal than `dead_band_m`, m.
    pub fn new(
        homing: &settings::Homing,
        pulled_m: &[T; 3],
        limits: [HaulLimit<T>; 3],
        dead_band_m: T,
    ) -> Self {
        let release_m = T::from(homing.release_m);
        Self {
            phase: HomingPhase::Release,
            left: 0,
            goals_m: pulled_m.map(|pulled| pulled - release_m),
            released_m: release_m,
            before_n: None,
            sums: [T::zero(); 3],
            position_sum: T::zero(),
            count: 0,
            steady: [LowPass::new(TOUCH_TIME_S, super::TICK_S); 3],
            limits,
            hauling: [Debounce::new(ticks(HAUL_TIME_S)); 3],
            found: [T::zero(); 3],
            rest: RestSearch::new(T::zero(), T::zero()),
            start_m: T::zero(),
            times: HomingTimes {
                tare: ticks(homing.tare_time_s),
                settle: ticks(homing.settle_time_s),
                average: ticks(homing.average_time_s),
                slack: ticks(SLACK_PART_OF_RELEASE * homing.release_m / homing.speed_m_per_s),
            },
            speed: homing.speed_m_per_s.into(),
            release_m,
            tare_max_n: homing.tare_max_n.into(),
            touch_n: homing.touch_n.into(),
            slack_n: T::from(OTHER_PART * homing.touch_n),
            travel_m: homing.travel_m.into(),
            arrived_m: dead_band_m + T::from(ARRIVED_M),
        }
    }

    /// One tick.
    #[inline(never)]
    pub fn step(&mut self, mechanism: &Mechanism<T>, measured: &Measured<T>) -> HomingStep<T> {
        let (pulled_m, tensions_n) = (&measured.pulled_m, &measured.tensions_n);
        if let Some(tendon) = self.contradicted(measured) {
            return HomingStep::Failed(tendon);
        }
        match self.phase {
            HomingPhase::Release => self.release(pulled_m, tensions_n),
            HomingPhase::Tare => self.tare(tensions_n),
            HomingPhase::ReelIn(tendon) => self.reel_in(tendon, measured),
            HomingPhase::Settle(tendon) => self.settle(tendon),
            HomingPhase::Average(tendon) => self.average(tendon, pulled_m, tensions_n),
            HomingPhase::Search(tendon) => self.search(mechanism, tendon),
            HomingPhase::PayOut(tendon) => self.pay_out(tendon, pulled_m),
        }
    }

    /// The first tendon, from 1, whose motor draws what no tension of homing asks for, or whose load cell shows a tension where it
    /// is slack: all but the one that is reeled in.
    fn contradicted(&mut self, measured: &Measured<T>) -> Option<u8> {
        let taut = match self.phase {
            HomingPhase::Release | HomingPhase::Tare => return None,
            HomingPhase::ReelIn(tendon)
            | HomingPhase::Settle(tendon)
            | HomingPhase::Average(tendon)
            | HomingPhase::Search(tendon)
            | HomingPhase::PayOut(tendon) => tendon.number(),
        };
        let mut found = None;
        let tendons = self.steady.iter_mut().zip(&mut self.hauling);
        let tendons = (1..).zip(tendons).zip(&mut self.limits);
        let shown = measured.tensions_n.iter().zip(&measured.currents_a);
        for (((number, (steady, hauling)), limit), (&tension, &current)) in tendons.zip(shown) {
            let shows = !(steady.step(tension).abs() <= self.slack_n);
            let hauls = hauling.update(limit.update(current));
            if hauls || (shows && number != taut) {
                found = Some(number);
            }
        }
        found
    }

    fn lead(&self) -> HomingStep<T> {
        HomingStep::Lead(self.goals_m.map(|pulled_m| AxisGoal {
            pulled_m,
            speed_m_per_s: self.speed,
        }))
    }

    fn release(&mut self, pulled_m: &[T; 3], tensions_n: &[T; 3]) -> HomingStep<T> {
        let Some(before_n) = self.before_n else {
            self.steady
                .iter_mut()
                .zip(tensions_n)
                .for_each(|(steady, tension)| steady.set(*tension));
            self.before_n = Some(*tensions_n);
            return self.lead();
        };
        let mut now_n = *tensions_n;
        for (now, steady) in now_n.iter_mut().zip(&mut self.steady) {
            *now = steady.step(*now);
        }
        let near = self.arrived_m;
        let arrived = pulled_m
            .iter()
            .zip(&self.goals_m)
            .all(|(pulled, goal)| (*pulled - *goal).abs() < near);
        if !arrived {
            return self.lead();
        }
        let slack_n = self.touch_n * T::from(SLACK_PART);
        let taut = |(now, before): (T, T)| !((now - before).abs() <= slack_n);
        match (1..)
            .zip(now_n.into_iter().zip(before_n))
            .find(|&(_, pair)| taut(pair))
        {
            None => self.begin_tare(),
            Some((tendon, _)) if self.released_m >= self.travel_m => {
                return HomingStep::Failed(tendon);
            }
            Some(_) => {
                self.before_n = Some(now_n);
                self.released_m += self.release_m;
                self.goals_m = self.goals_m.map(|goal| goal - self.release_m);
            }
        }
        self.lead()
    }

    /// The tendons are slack; from the tare on the load cells read zero.
    fn begin_tare(&mut self) {
        (self.phase, self.count) = (HomingPhase::Tare, 0);
        self.steady
            .iter_mut()
            .for_each(|steady| steady.set(T::zero()));
    }

    /// Whether tendons may still pull as they did before homing.
    #[must_use]
    pub fn releases(&self) -> bool {
        self.phase == HomingPhase::Release
    }

    fn tare(&mut self, tensions_n: &[T; 3]) -> HomingStep<T> {
        for (sum, tension) in self.sums.iter_mut().zip(tensions_n) {
            *sum += *tension;
        }
        self.count += 1;
        if self.count < self.times.tare {
            return self.lead();
        }
        let count = T::from(self.count as f32);
        let offsets = self.sums.map(|sum| sum / count);
        for (tendon, offset) in (1..).zip(offsets) {
            if !(offset.abs() <= self.tare_max_n) {
                return HomingStep::Failed(tendon);
            }
        }
        self.begin_reeling_in(TendonNumber::First);
        let [start, ..] = self.goals_m;
        self.start_m = start;
        HomingStep::Tare(offsets)
    }

    fn begin_reeling_in(&mut self, tendon: TendonNumber) {
        self.phase = HomingPhase::ReelIn(tendon);
        (self.count, self.sums) = (0, [T::zero(); 3]);
    }

    fn reel_in(&mut self, tendon: TendonNumber, measured: &Measured<T>) -> HomingStep<T> {
        let (i, pulled_m) = (tendon.index(), &measured.pulled_m);
        self.learn_friction(i, measured.currents_a[i]);
        if self.steady[i].value() >= self.touch_n {
            self.goals_m[i] = pulled_m[i];
            (self.phase, self.left) = (HomingPhase::Settle(tendon), self.times.settle);
            return self.lead();
        }
        self.goals_m[i] = self.start_m + self.travel_m;
        if pulled_m[i] >= self.start_m + self.travel_m - self.arrived_m {
            return HomingStep::Failed(tendon.number());
        }
        self.lead()
    }

    /// Takes the current, A, of a tick in which a tendon is reeled in that is slack yet. In the first half of these ticks the motor starts.
    fn learn_friction(&mut self, i: usize, current_a: T) {
        let (slack, starts) = (self.times.slack, self.times.slack / 2);
        if self.count >= slack {
            return;
        }
        self.count += 1;
        if self.count > starts {
            self.sums[i] += current_a;
            if self.count == slack {
                self.limits[i].lower(self.sums[i] / T::from((slack - starts) as f32));
            }
        }
    }

    fn settle(&mut self, tendon: TendonNumber) -> HomingStep<T> {
        self.left = self.left.saturating_sub(1);
        if self.left == 0 {
            self.phase = HomingPhase::Average(tendon);
            (self.count, self.position_sum, self.sums) = (0, T::zero(), [T::zero(); 3]);
        }
        self.lead()
    }

    fn average(
        &mut self,
        tendon: TendonNumber,
        pulled_m: &[T; 3],
        tensions_n: &[T; 3],
    ) -> HomingStep<T> {
        let i = tendon.index();
        self.sums[i] += tensions_n[i];
        // From where it rests, so that the sum stays small.
        self.position_sum += pulled_m[i] - self.goals_m[i];
        self.count += 1;
        if self.count < self.times.average {
            return self.lead();
        }
        let count = T::from(self.count as f32);
        let tension = self.sums[i] / count;
        if !(tension >= self.touch_n * T::from(REST_PART)) {
            // The leg has only swung against it, and hangs free: it is reeled in farther.
            self.steady[i].set(T::zero());
            self.count = self.times.slack;
            self.phase = HomingPhase::ReelIn(tendon);
            return self.lead();
        }
        let pulled = self.goals_m[i] + self.position_sum / count;
        self.rest = RestSearch::new(tension, pulled);
        self.phase = HomingPhase::Search(tendon);
        self.lead()
    }

    fn search(&mut self, mechanism: &Mechanism<T>, tendon: TendonNumber) -> HomingStep<T> {
        let i = tendon.index();
        match self.rest.step(mechanism, i) {
            Ok(None) => return HomingStep::Searching,
            Ok(Some(unstretched_at_zero)) => self.found[i] = unstretched_at_zero,
            Err(_) => return HomingStep::Failed(tendon.number()),
        }
        self.goals_m[i] -= self.release_m;
        self.phase = HomingPhase::PayOut(tendon);
        self.lead()
    }

    fn pay_out(&mut self, tendon: TendonNumber, pulled_m: &[T; 3]) -> HomingStep<T> {
        let i = tendon.index();
        if !((pulled_m[i] - self.goals_m[i]).abs() < self.arrived_m) {
            return self.lead();
        }
        // Slack again, the load cell has to show nothing again: otherwise its zero has moved meanwhile.
        if !(self.steady[i].value().abs() <= self.slack_n) {
            return HomingStep::Failed(tendon.number());
        }
        let Some(next) = tendon.next() else {
            return HomingStep::Found(self.found);
        };
        self.start_m = self.goals_m[next.index()];
        self.begin_reeling_in(next);
        self.lead()
    }
}

#[cfg(test)]
mod tests;
