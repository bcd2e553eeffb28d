//! Where the leg shall be at any time: jerk-limited ways through half-tangent coordinates, which are smooth at the
//! vertical.

use super::CYCLE_S;
use super::plan::{Limits, longer};
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

/// A way that is tried with ever more time, once a cycle.
#[derive(Clone, Copy, Debug)]
struct Plan<T> {
    end: End<T>,
    duration_s: Option<T>,
}

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
        self.planned = Some(Plan {
            end: End::At(q.xy()),
            duration_s: None,
        });
    }

    /// Comes to rest.
    pub fn stop(&mut self) {
        self.planned = Some(Plan {
            end: End::Soon,
            duration_s: None,
        });
    }

    /// Whether it is on its way.
    #[inline(always)]
    pub fn moving(&self) -> bool {
        self.cycle < self.cycles || self.planned.is_some()
    }

    /// The point of the next cycle.
    #[inline(always)]
    pub fn next(&mut self) -> Point<T> {
        if self.cycle < self.cycles {
            self.cycle += 1;
        }
        if let Some(plan) = self.planned {
            self.planned = self.attempt(plan);
        }
        let [x, y] = self.way.position(self.part());
        HalfTangent::new(x, y)
    }

    #[inline(always)]
    fn part(&self) -> T {
        if self.cycle < self.cycles {
            T::from(self.cycle as f32) / T::from(self.cycles as f32)
        } else {
            T::one()
        }
    }

    /// Tries a way from where the trajectory is now; gives back the plan unless the way keeps the limits.
    #[inline(never)]
    fn attempt(&mut self, plan: Plan<T>) -> Option<Plan<T>> {
        let start = self.way.motion(self.part());
        let duration_s = match (plan.duration_s, plan.end) {
            (Some(tried_s), _) => longer(tried_s),
            (None, End::At(end)) => self.limits.shortest_s(&start, end),
            (None, End::Soon) => T::from(0.02),
        };
        if duration_s > T::from(LONGEST_S) {
            return None;
        }
        let end = match plan.end {
            End::At(end) => end,
            End::Soon => {
                let ahead =
                    |i: usize| start.position[i] + start.rate[i] * duration_s * T::from(0.4);
                [ahead(0), ahead(1)]
            }
        };
        let way = Quintic::new(&start, end, duration_s);
        if !self.limits.kept(&way) {
            return Some(Plan {
                end: plan.end,
                duration_s: Some(duration_s),
            });
        }
        self.cycles = cycles(duration_s);
        // Whole cycles: the way is stretched to them.
        let whole_s = T::from(self.cycles as f32 * CYCLE_S);
        self.way = Quintic::new(&start, end, whole_s);
        self.cycle = 0;
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
