//! Finds the zero: the leg hangs free, and one tendon after the other is taken up until it just pulls.
//!
//! Slack tendons tell the load cells' zero. One taut tendon and the leg's own weight settle where the leg rests, and so
//! how long that tendon is.

use super::{AxisGoal, Mechanism, filter::LowPass, ticks};
use crate::settings;
use leg_model::{Direction, Elasticity, Error, Scalar, estimate_load, inverse_kinematics};
use nalgebra::SVector;

/// What homing does now.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Phase {
    /// Every tendon is let out, until that changes no tension any more.
    Release,
    /// The slack load cells are averaged.
    Tare,
    /// One tendon is taken up.
    TakeUp(Tendon),
    /// The leg comes to rest on it.
    Settle(Tendon),
    /// Its tension and position are averaged.
    Average(Tendon),
    /// The pose in which the leg rests on it is looked for, one step a tick.
    Search(Tendon),
    /// It is let out again.
    LetOut(Tendon),
}

/// The tendon that is taken up.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Tendon {
    First,
    Second,
    Third,
}

impl Tendon {
    const fn index(self) -> usize {
        match self {
            Self::First => 0,
            Self::Second => 1,
            Self::Third => 2,
        }
    }

    /// Counted from 1.
    const fn number(self) -> u8 {
        match self {
            Self::First => 1,
            Self::Second => 2,
            Self::Third => 3,
        }
    }

    const fn next(self) -> Option<Self> {
        match self {
            Self::First => Some(Self::Second),
            Self::Second => Some(Self::Third),
            Self::Third => None,
        }
    }
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
pub struct Homing<T> {
    phase: Phase,
    left: u32,
    goals_m: [T; 3],
    /// How far every tendon was let out, m, and the tensions before the last step of that, N.
    released_m: T,
    before_n: Option<[T; 3]>,
    sums: [T; 3],
    position_sum: T,
    count: u32,
    steady: [LowPass<T>; 3],
    found: [T; 3],
    rest: Rest<T>,
    start_m: T,
    times: Times,
    speed: T,
    release_m: T,
    tare_max_n: T,
    touch_n: T,
    travel_m: T,
}

#[derive(Clone, Copy, Debug)]
struct Times {
    tare: u32,
    settle: u32,
    average: u32,
}

/// Tension with which a leg rests on a tendon at least, of the tension of the touch: it comes in motion, so most of that
/// is gone when the leg has come to rest.
const REST_PART: f32 = 0.02;

/// Time constant with which a touch is felt, s.
const TOUCH_TIME_S: f32 = 0.005;

/// Change of a tension over a step of the release below which the tendon counts as slack, of the tension of a touch: the
/// cell's own offset is not known, but it does not change.
const SLACK_PART: f32 = 0.25;

impl<T: Scalar> Homing<T> {
    /// Starts from where the tendons are, m.
    pub fn new(homing: &settings::Homing, pulled_m: &[T; 3]) -> Self {
        let release_m = T::from(homing.release_m);
        Self {
            phase: Phase::Release,
            left: 0,
            goals_m: pulled_m.map(|pulled| pulled - release_m),
            released_m: release_m,
            before_n: None,
            sums: [T::zero(); 3],
            position_sum: T::zero(),
            count: 0,
            steady: [LowPass::new(TOUCH_TIME_S, super::TICK_S); 3],
            found: [T::zero(); 3],
            rest: Rest::new(T::zero(), T::zero()),
            start_m: T::zero(),
            times: Times {
                tare: ticks(homing.tare_time_s),
                settle: ticks(homing.settle_time_s),
                average: ticks(homing.average_time_s),
            },
            speed: homing.speed_m_per_s.into(),
            release_m,
            tare_max_n: homing.tare_max_n.into(),
            touch_n: homing.touch_n.into(),
            travel_m: homing.travel_m.into(),
        }
    }

    /// One tick.
    #[inline(never)]
    pub fn step(
        &mut self,
        mechanism: &Mechanism<T>,
        pulled_m: &[T; 3],
        tensions_n: &[T; 3],
    ) -> HomingStep<T> {
        match self.phase {
            Phase::Release => self.release(pulled_m, tensions_n),
            Phase::Tare => self.tare(tensions_n),
            Phase::TakeUp(tendon) => self.take_up(tendon, pulled_m, tensions_n),
            Phase::Settle(tendon) => self.settle(tendon),
            Phase::Average(tendon) => self.average(tendon, pulled_m, tensions_n),
            Phase::Search(tendon) => self.search(mechanism, tendon),
            Phase::LetOut(tendon) => self.let_out(tendon, pulled_m),
        }
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
        let near = T::from(1e-4);
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

    /// The tendons are slack; from the tare on the load cells tell zero.
    fn begin_tare(&mut self) {
        (self.phase, self.count) = (Phase::Tare, 0);
        self.steady
            .iter_mut()
            .for_each(|steady| steady.set(T::zero()));
    }

    /// Whether tendons may still pull as they did before homing.
    #[must_use]
    pub fn releases(&self) -> bool {
        self.phase == Phase::Release
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
        self.phase = Phase::TakeUp(Tendon::First);
        let [start, ..] = self.goals_m;
        self.start_m = start;
        HomingStep::Tare(offsets)
    }

    fn take_up(&mut self, tendon: Tendon, pulled_m: &[T; 3], tensions_n: &[T; 3]) -> HomingStep<T> {
        let i = tendon.index();
        if self.steady[i].step(tensions_n[i]) >= self.touch_n {
            self.goals_m[i] = pulled_m[i];
            (self.phase, self.left) = (Phase::Settle(tendon), self.times.settle);
            return self.lead();
        }
        self.goals_m[i] = self.start_m + self.travel_m;
        if pulled_m[i] >= self.start_m + self.travel_m - T::from(1e-4) {
            return HomingStep::Failed(tendon.number());
        }
        self.lead()
    }

    fn settle(&mut self, tendon: Tendon) -> HomingStep<T> {
        self.left = self.left.saturating_sub(1);
        if self.left == 0 {
            self.phase = Phase::Average(tendon);
            (self.count, self.position_sum, self.sums) = (0, T::zero(), [T::zero(); 3]);
        }
        self.lead()
    }

    fn average(&mut self, tendon: Tendon, pulled_m: &[T; 3], tensions_n: &[T; 3]) -> HomingStep<T> {
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
            // The leg has only swung against it, and hangs free: it is taken up farther.
            self.steady[i].set(T::zero());
            self.phase = Phase::TakeUp(tendon);
            return self.lead();
        }
        let pulled = self.goals_m[i] + self.position_sum / count;
        self.rest = Rest::new(tension, pulled);
        self.phase = Phase::Search(tendon);
        self.lead()
    }

    fn search(&mut self, mechanism: &Mechanism<T>, tendon: Tendon) -> HomingStep<T> {
        let i = tendon.index();
        match self.rest.step(mechanism, i) {
            Ok(None) => return HomingStep::Searching,
            Ok(Some(unstretched_at_zero)) => self.found[i] = unstretched_at_zero,
            Err(_) => return HomingStep::Failed(tendon.number()),
        }
        let Some(next) = tendon.next() else {
            return HomingStep::Found(self.found);
        };
        self.goals_m[i] -= self.release_m;
        self.start_m = self.goals_m[next.index()];
        self.phase = Phase::LetOut(tendon);
        self.lead()
    }

    fn let_out(&mut self, tendon: Tendon, pulled_m: &[T; 3]) -> HomingStep<T> {
        let i = tendon.index();
        if (pulled_m[i] - self.goals_m[i]).abs() < T::from(1e-4)
            && let Some(next) = tendon.next()
        {
            self.phase = Phase::TakeUp(next);
        }
        self.lead()
    }
}

/// Steps of the search for the pose on one tendon.
const STEPS: u8 = 12;

/// Searches the pose in which a hanging leg rests on one tendon, one step a tick.
#[derive(Clone, Copy, Debug)]
struct Rest<T> {
    direction: Direction<T>,
    tension_n: T,
    pulled_m: T,
    steps: u8,
}

impl<T: Scalar> Rest<T> {
    fn new(tension_n: T, pulled_m: T) -> Self {
        Self {
            direction: Direction::down(),
            tension_n,
            pulled_m,
            steps: 0,
        }
    }

    /// The next step; at the end, the length of tendon `i` without tension when the board started, m.
    fn step(&mut self, mechanism: &Mechanism<T>, i: usize) -> Result<Option<T>, Error> {
        if self.steps < STEPS {
            self.steps += 1;
            self.direction = self.nearer(mechanism, i)?;
            return Ok(None);
        }
        let mut twisted = None;
        let geometry = mechanism.geometry(&self.direction, T::zero(), &mut twisted);
        let kinematics = inverse_kinematics(geometry, &self.direction)?;
        let elongation = mechanism.tendons[i].elongation(self.tension_n)?;
        Ok(Some(kinematics.lengths[i] - elongation + self.pulled_m))
    }

    fn nearer(&self, mechanism: &Mechanism<T>, i: usize) -> Result<Direction<T>, Error> {
        let direction = self.direction;
        let mut pull = SVector::<T, 3>::zeros();
        pull[i] = self.tension_n;
        let mut twisted = None;
        let geometry = mechanism.geometry(&direction, T::zero(), &mut twisted);
        let load = estimate_load(geometry, &mechanism.support, &direction, T::zero(), &pull)?;
        let plane = mechanism.support.plane(&direction);
        let [x, y] = plane.project(&load);
        let own = mechanism.leg.moment(&direction);
        // What is out of balance, over the stiffness that the weight alone gives: the weights' own is the least there is.
        let stiffness = mechanism.leg.stiffness(&direction)[(0, 0)]
            + mechanism.support.joint().bending_nm_per_rad;
        if !(stiffness > T::zero()) {
            return Err(Error::Unstable);
        }
        let (turn_x, turn_y) = ((own.x - x) / stiffness, (own.y - y) / stiffness);
        // A turn about x moves the tip along −p_z y, one about y along p_z x.
        let vector = direction.vector();
        Direction::from_xy(vector.x + vector.z * turn_y, vector.y - vector.z * turn_x)
    }
}
