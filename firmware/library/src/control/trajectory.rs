//! Where the leg shall be at any time: jerk-limited ways through half-tangent coordinates, which are smooth at the
//! vertical.

use super::CYCLE_S;
use super::plan::{Limits, PLACES, longer};
use super::quintic::{Motion, Quintic};
use crate::settings::Settings;
use leg_model::{HalfTangent, Scalar};

/// Longest way, s: one that would need more is given up, and the leg stays on the old one.
const LONGEST_S: f32 = 600.0;

/// A point of the trajectory.
pub type Point<T> = HalfTangent<T>;

/// The trajectory: a way that is followed and, while one is planned, where it shall lead.
#[derive(Clone, Copy, Debug)]
pub struct Trajectory<T> {
    limits: Limits<T>,
    way: Quintic<T>,
    cycle: u32,
    cycles: u32,
    planned: Option<Plan<T>>,
}

/// A way that is tried with ever more time, and looked at place by place.
#[derive(Clone, Copy, Debug)]
struct Plan<T> {
    end: End<T>,
    duration_s: Option<T>,
    tried: Option<Attempt<T>>,
}

/// A way that is being looked at. It starts where the present way will be in a few cycles.
#[derive(Clone, Copy, Debug)]
struct Attempt<T> {
    way: Quintic<T>,
    cycles: u32,
    /// Cycles until it starts.
    ahead: u32,
    /// The next place to look at.
    place: u8,
}

/// Cycles that are given to look at a way: enough for all its places.
const AHEAD: u32 = PLACES as u32 / PLACES_A_CYCLE as u32 + 1;

/// Places looked at in a cycle.
const PLACES_A_CYCLE: u8 = 2;

/// Where a way shall end.
#[derive(Clone, Copy, Debug)]
enum End<T> {
    /// There.
    At([T; 2]),
    /// As soon as the limits allow.
    Soon,
}

impl<T: Scalar> Trajectory<T> {
    /// At rest, straight down.
    pub fn new(settings: &Settings) -> Self {
        let start = [T::zero(); 2];
        Self {
            limits: Limits::new(&settings.motion),
            way: Quintic::new(&Motion::at(start), start, T::one()),
            cycle: 1,
            cycles: 1,
            planned: None,
        }
    }

    /// Starts anew, at rest.
    pub fn start(&mut self, q: Point<T>) {
        self.way = Quintic::new(&Motion::at(q.xy()), q.xy(), T::one());
        (self.cycle, self.cycles, self.planned) = (1, 1, None);
    }

    /// Goes to a point, from wherever the trajectory is and however it moves.
    pub fn go(&mut self, q: Point<T>) {
        self.plan(End::At(q.xy()));
    }

    /// Comes to rest.
    pub fn stop(&mut self) {
        self.plan(End::Soon);
    }

    fn plan(&mut self, end: End<T>) {
        self.planned = Some(Plan {
            end,
            duration_s: None,
            tried: None,
        });
    }

    /// Whether it is on its way.
    #[inline(always)]
    pub fn moving(&self) -> bool {
        self.cycle < self.cycles || self.planned.is_some()
    }

    /// The point of the next cycle.
    #[inline(always)]
    pub fn step(&mut self) -> Point<T> {
        if self.cycle < self.cycles {
            self.cycle += 1;
        }
        let [x, y] = self.way.position(self.part(0));
        HalfTangent::new(x, y)
    }

    /// Goes on with the plan of another way, once a cycle.
    #[inline(never)]
    pub fn advance_plan(&mut self) {
        if let Some(plan) = self.planned {
            self.planned = match plan.tried {
                Some(attempt) => self.look(plan, attempt),
                None => self.attempt(plan),
            };
        }
    }

    /// The part of the way that will be done in some cycles.
    #[inline(always)]
    fn part(&self, ahead: u32) -> T {
        let cycle = self.cycle + ahead;
        if cycle < self.cycles {
            T::from(cycle as f32) / T::from(self.cycles as f32)
        } else {
            T::one()
        }
    }

    /// Makes a way from where the trajectory will be; no plan if it would take too long.
    #[inline(always)]
    fn attempt(&self, plan: Plan<T>) -> Option<Plan<T>> {
        let start = self.way.motion(self.part(AHEAD));
        let duration_s = match (plan.duration_s, plan.end) {
            (Some(duration_s), _) => duration_s,
            (None, End::At(end)) => self.limits.shortest_s(&start, end),
            (None, End::Soon) => T::from(0.02),
        };
        if duration_s > T::from(LONGEST_S) {
            return None;
        }
        let end = match plan.end {
            End::At(end) => end,
            End::Soon => {
                let on = |i: usize| start.position[i] + start.rate[i] * duration_s * T::from(0.4);
                [on(0), on(1)]
            }
        };
        // Whole cycles: the way is stretched to them.
        let cycles = cycles(duration_s);
        let attempt = Attempt {
            way: Quintic::new(&start, end, T::from(cycles as f32 * CYCLE_S)),
            cycles,
            ahead: AHEAD,
            place: 0,
        };
        Some(Plan {
            duration_s: Some(duration_s),
            tried: Some(attempt),
            ..plan
        })
    }

    /// Looks at the next places of a way. One that leaves the limits is tried again with more time; one that keeps them
    /// is taken when its start has come.
    #[inline(always)]
    fn look(&mut self, plan: Plan<T>, mut attempt: Attempt<T>) -> Option<Plan<T>> {
        attempt.ahead = attempt.ahead.saturating_sub(1);
        for _ in 0..PLACES_A_CYCLE {
            if attempt.place > PLACES {
                break;
            }
            if !self.limits.kept(&attempt.way, attempt.place) {
                return Some(Plan {
                    duration_s: plan.duration_s.map(longer),
                    tried: None,
                    ..plan
                });
            }
            attempt.place += 1;
        }
        if attempt.ahead > 0 {
            return Some(Plan {
                tried: Some(attempt),
                ..plan
            });
        }
        (self.way, self.cycle, self.cycles) = (attempt.way, 0, attempt.cycles);
        None
    }
}

/// Whole cycles in a time, rounded up.
#[inline(always)]
fn cycles<T: Scalar>(duration_s: T) -> u32 {
    // By counting up in halves: a number of the model's type cannot be cast.
    let (mut low, mut high) = (1_u32, (LONGEST_S / CYCLE_S) as u32 + 1);
    while low < high {
        let middle = low + (high - low) / 2;
        if T::from(middle as f32 * CYCLE_S) < duration_s {
            low = middle + 1;
        } else {
            high = middle;
        }
    }
    low
}
