//! Where the leg shall be at any time: jerk-limited paths through half-tangent coordinates, which are smooth at the
//! vertical.

use super::CYCLE_S;
use super::plan::{MotionLimits, PLACES, SHORTEST_S, longer};
use super::quintic::{MotionState, Quintic};
use leg_model::{HalfTangent, Scalar};

/// Longest trajectory, s: one that would need more is given up, and the leg stays on the old one. Its cycles, 1.2 million, are
/// exact in f32.
const LONGEST_S: f32 = 600.0;

/// A point of the trajectory.
pub type Point<T> = HalfTangent<T>;

/// The trajectory: a path that is followed and, while one is planned, where it shall lead.
#[derive(Clone, Copy, Debug)]
pub struct Trajectory<T> {
    limits: MotionLimits<T>,
    path: Quintic<T>,
    cycle: u32,
    cycles: u32,
    planned: Option<Plan<T>>,
}

/// A path that is tried with ever more time, and checked place by place.
#[derive(Clone, Copy, Debug)]
struct Plan<T> {
    end: End<T>,
    duration_s: Option<T>,
    tried: Option<Attempt<T>>,
}

/// A path that is being checked. It starts where the present path will be in a few cycles.
#[derive(Clone, Copy, Debug)]
struct Attempt<T> {
    path: Quintic<T>,
    cycles: u32,
    /// Cycles until it starts.
    ahead: u32,
    /// The next place to check.
    place: u8,
}

/// Cycles that are given to check a path: enough for all its places.
const AHEAD: u32 = PLACES as u32 / PLACES_A_CYCLE as u32 + 1;

/// Places checked in a cycle: as many as fit beside the monitors of two axes in a tick of the instruction budget.
const PLACES_A_CYCLE: u8 = 2;

/// Where a path shall end.
#[derive(Clone, Copy, Debug)]
enum End<T> {
    /// There.
    At([T; 2]),
    /// As soon as the limits allow.
    Soon,
}

impl<T: Scalar> Trajectory<T> {
    /// At rest at a point.
    pub fn new(limits: MotionLimits<T>, start: Point<T>) -> Self {
        let start = start.xy();
        Self {
            limits,
            path: Quintic::new(&MotionState::at_rest(start), start, T::one()),
            cycle: 1,
            cycles: 1,
            planned: None,
        }
    }

    /// Starts anew, at rest.
    pub fn start(&mut self, q: Point<T>) {
        self.path = Quintic::new(&MotionState::at_rest(q.xy()), q.xy(), T::one());
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

    /// Whether it moves, or a plan is being made.
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
        let [x, y] = self.path.position(self.part(0));
        HalfTangent::new(x, y)
    }

    /// Goes on with the plan of another path, once a cycle.
    #[inline(never)]
    pub fn advance_plan(&mut self) {
        if let Some(plan) = self.planned {
            self.planned = match plan.tried {
                Some(attempt) => self.check(plan, attempt),
                None => self.attempt(plan),
            };
        }
    }

    /// The part of the path that will be done in some cycles.
    #[inline(always)]
    fn part(&self, ahead: u32) -> T {
        let cycle = self.cycle + ahead;
        if cycle < self.cycles {
            T::from(cycle as f32) / T::from(self.cycles as f32)
        } else {
            T::one()
        }
    }

    /// Makes a path from where the trajectory will be; no plan if it would take too long.
    #[inline(always)]
    fn attempt(&self, plan: Plan<T>) -> Option<Plan<T>> {
        let start = self.path.motion(self.part(AHEAD));
        let duration_s = match (plan.duration_s, plan.end) {
            (Some(duration_s), _) => duration_s,
            (None, End::At(end)) => self.limits.shortest_s(&start, end),
            (None, End::Soon) => T::from(SHORTEST_S),
        };
        if duration_s > T::from(LONGEST_S) {
            return None;
        }
        let end = match plan.end {
            End::At(end) => end,
            End::Soon => {
                // With two fifths of rate × time the rate falls as (1 − s)³(1 + 3s): it never changes its sign, and both
                // acceleration and jerk end at zero.
                let on = |i: usize| start.position[i] + start.rate[i] * duration_s * T::from(0.4);
                [on(0), on(1)]
            }
        };
        // Whole cycles: the path is stretched to them.
        let cycles = cycles(duration_s);
        let attempt = Attempt {
            path: Quintic::new(&start, end, T::from(cycles as f32 * CYCLE_S)),
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

    /// Checks the next places of a path. One that leaves the limits is tried again with more time; one that keeps them
    /// is taken when its start has come.
    #[inline(always)]
    fn check(&mut self, plan: Plan<T>, mut attempt: Attempt<T>) -> Option<Plan<T>> {
        attempt.ahead = attempt.ahead.saturating_sub(1);
        for _ in 0..PLACES_A_CYCLE {
            if attempt.place > PLACES {
                break;
            }
            if !self.limits.kept(&attempt.path, attempt.place) {
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
        (self.path, self.cycle, self.cycles) = (attempt.path, 0, attempt.cycles);
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
