//! Where the leg shall be at any time: jerk-limited paths through half-tangent coordinates, which are smooth at the
//! vertical.

use super::inertia::Turn;
use super::plan::{LONGEST_S, MotionLimits, PLACES, SHORTEST_S, cycles, longer};
use super::quintic::{MotionState, Quintic};
use super::segment::Segment;
use super::stream::Stream;
use super::{CYCLE_S, CYCLE_TICKS, TICK_S};
use leg_model::{HalfTangent, Scalar};

/// A point of the trajectory.
pub type Point<T> = HalfTangent<T>;

/// The trajectory: a path that is followed and, while one is planned, where it shall lead.
#[derive(Clone, Copy, Debug)]
pub struct Trajectory<T> {
    limits: MotionLimits<T>,
    path: Quintic<T>,
    /// Ticks since its start, and from there to its end. A segment of a stream may start within the next cycle: then the first are
    /// negative.
    elapsed: i32,
    duration: i32,
    /// Whether the path is a segment of a stream.
    streamed: bool,
    /// Whether that begins in this cycle: the path is still the one before it.
    begins: bool,
    /// Whether the last stream ended without its last point, and nothing was commanded since.
    point_missing: bool,
    planned: Option<Plan<T>>,
    /// The next point, and how the leg turns there.
    next: [T; 2],
    turn: Turn<T>,
}

/// Ticks of a cycle.
const CYCLE: i32 = CYCLE_TICKS as i32;

/// A path that is tried with ever more time, and checked place by place.
#[derive(Clone, Copy, Debug)]
struct Plan<T> {
    /// Where the leg shall come to rest, unless it stops.
    end: [T; 2],
    way: Way,
    /// The time that is tried, s.
    duration_s: T,
    tried: Option<Attempt<T>>,
}

/// How a path leads to its end. From a motion the other way the path to the end swings out, the farther the longer it takes: where it would leave
/// the greatest tilt, the leg brakes first, or follows the path that it is on for longer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Way {
    /// From the present motion.
    Direct,
    /// The leg comes to rest as soon as the limits allow, and then goes there.
    BrakesFirst,
    /// The leg follows the path that it is on, and leaves it as soon as one to the end stays within the greatest tilt.
    Later,
    /// The leg comes to rest as soon as the limits allow, wherever that is.
    Stops,
}

impl Way {
    /// Whether it leads to rest as soon as the limits allow.
    const fn brakes(self) -> bool {
        matches!(self, Self::BrakesFirst | Self::Stops)
    }

    /// The way instead of one that leads too far, or that comes to rest later than the path that the leg is on; none where that is
    /// followed to its end.
    const fn instead(self) -> Option<Self> {
        match self {
            Self::Direct => Some(Self::BrakesFirst),
            Self::BrakesFirst | Self::Later => Some(Self::Later),
            Self::Stops => None,
        }
    }
}

/// A path that is being checked. It starts where the present path will be in a few cycles.
#[derive(Clone, Copy, Debug)]
struct Attempt<T> {
    path: Quintic<T>,
    cycles: i32,
    /// Cycles until it starts.
    ahead: i32,
    /// The next place to check.
    place: u8,
}

/// Cycles that are given to check a path: the first for one place, the others for the rest.
const AHEAD: i32 = PLACES as i32 / PLACES_A_CYCLE as i32 + 1;

const _: () = assert!(PLACES.is_multiple_of(PLACES_A_CYCLE));

/// Places checked in a cycle: as many as fit beside the monitors of two axes in a tick of the instruction budget.
const PLACES_A_CYCLE: u8 = 2;

impl<T: Scalar> Trajectory<T> {
    /// At rest at a point.
    pub fn new(limits: MotionLimits<T>, start: Point<T>) -> Self {
        let start = start.xy();
        Self {
            limits,
            path: Quintic::new(&MotionState::resting(start), start, T::one()),
            elapsed: 0,
            duration: 0,
            streamed: false,
            begins: false,
            point_missing: false,
            planned: None,
            next: start,
            turn: Turn::none(),
        }
    }

    /// Starts anew, at rest.
    pub fn start(&mut self, q: Point<T>) {
        self.path = Quintic::new(&MotionState::resting(q.xy()), q.xy(), T::one());
        (self.elapsed, self.duration) = (0, 0);
        (self.streamed, self.begins, self.planned) = (false, false, None);
        (self.next, self.turn) = (q.xy(), Turn::none());
    }

    /// Rests at another point; where it shall lead stays.
    pub fn shift(&mut self, q: Point<T>) {
        let planned = self.planned;
        self.start(q);
        self.planned = planned;
    }

    /// Follows a stream from [`Self::next_motion`] on.
    pub fn begin_stream(&mut self) {
        self.planned = None;
        (self.streamed, self.begins) = (true, true);
        self.point_missing = false;
    }

    /// Leaves a stream: the segment leads to rest.
    pub fn leave_stream(&mut self, segment: &Segment<T>) {
        (self.streamed, self.begins) = (false, false);
        self.enter(segment, 0);
    }

    /// Whether it follows a stream.
    #[inline(always)]
    pub fn streamed(&self) -> bool {
        self.streamed
    }

    /// Whether the last stream ended without its last point, and nothing was commanded since.
    #[inline(always)]
    pub fn point_missing(&self) -> bool {
        self.point_missing
    }

    /// The motion at the next point.
    pub fn next_motion(&self) -> MotionState<T> {
        self.path.motion(self.part(CYCLE))
    }

    /// The motion at the last point.
    pub fn motion(&self) -> MotionState<T> {
        self.path.motion(self.part(0))
    }

    fn enter(&mut self, segment: &Segment<T>, elapsed: i32) {
        self.path = segment.path;
        (self.elapsed, self.duration) = (elapsed, segment.ticks);
    }

    /// Goes to a point, from wherever the trajectory is and however it moves.
    pub fn go(&mut self, q: Point<T>) {
        self.plan(q.xy(), Way::Direct);
    }

    /// Comes to rest.
    pub fn stop(&mut self) {
        self.plan(self.next, Way::Stops);
    }

    fn plan(&mut self, end: [T; 2], way: Way) {
        self.point_missing = false;
        self.planned = Some(self.begin_plan(end, way));
    }

    /// Plans the way instead of the one that was tried, if there is one.
    fn plan_instead(&mut self) {
        self.planned = self
            .planned
            .and_then(|plan| Some(self.begin_plan(plan.end, plan.way.instead()?)));
    }

    /// A plan that begins with a time that is too short, or just enough.
    fn begin_plan(&self, end: [T; 2], way: Way) -> Plan<T> {
        Plan {
            end,
            way,
            duration_s: if way.brakes() {
                T::from(SHORTEST_S)
            } else {
                self.limits.shortest_s(self.next, end)
            },
            tried: None,
        }
    }

    /// Whether it moves, or a plan is being made.
    #[inline(always)]
    pub fn moving(&self) -> bool {
        self.elapsed < self.duration || self.streamed || self.planned.is_some()
    }

    /// Ticks until the end of the path that is followed; none at rest, and none of a stream, whose end is not known.
    pub fn ticks_to_end(&self) -> Option<u32> {
        let left = self.duration - self.elapsed;
        (left > 0 && !self.streamed).then(|| left.unsigned_abs())
    }

    /// The point of the next cycle.
    #[inline(always)]
    pub fn step(&mut self) -> Point<T> {
        if self.elapsed < self.duration {
            self.elapsed += CYCLE;
        }
        let [x, y] = self.next;
        HalfTangent::new(x, y)
    }

    /// Goes on with the plan of another path, or with a stream, once a cycle; on a joint with a damping, N·m·s/rad.
    #[inline(never)]
    pub fn advance_plan(&mut self, stream: &mut Stream<T>, joint_damping: T) {
        if self.streamed {
            self.advance_stream(stream);
        } else {
            self.go_on_planning();
        }
        let motion = self.next_motion();
        self.next = motion.position;
        self.turn = motion.turn(joint_damping);
    }

    /// How the leg turns at the next point.
    #[inline(always)]
    pub fn turn(&self) -> &Turn<T> {
        &self.turn
    }

    /// Enters the next segment if the next point is in it: without one, that to rest.
    #[inline(always)]
    fn advance_stream(&mut self, stream: &mut Stream<T>) {
        let beyond = if core::mem::take(&mut self.begins) {
            0
        } else {
            self.elapsed - self.duration
        };
        if beyond + CYCLE <= 0 {
            return;
        }
        let segment = stream.next_segment().unwrap_or_else(|| {
            let (to_rest, missing) = stream.end();
            (self.streamed, self.point_missing) = (false, missing);
            to_rest
        });
        self.enter(&segment, beyond);
    }

    /// The part of the path that will be done in some ticks.
    #[inline(always)]
    fn part(&self, ahead: i32) -> T {
        let elapsed = self.elapsed + ahead;
        if elapsed < self.duration {
            T::from(elapsed as f32) / T::from(self.duration as f32)
        } else {
            T::one()
        }
    }

    /// Makes a path from where the trajectory will be, or checks the next places of one, and first of all how far it leads. Instead of one
    /// that leads too far, or that is no sooner at rest, another way is planned; one that is too fast is tried again with more time,
    /// and given up if that is too long; one that keeps the limits is taken when its start has come.
    // In place: to copy a plan would take a tick of the budget's last instructions.
    #[inline(always)]
    fn go_on_planning(&mut self) {
        let start_part = self.part(AHEAD * CYCLE);
        let Some(plan) = &mut self.planned else {
            return;
        };
        let Some(attempt) = &mut plan.tried else {
            let left = self.duration - self.elapsed - AHEAD * CYCLE;
            if plan.duration_s > T::from(LONGEST_S) {
                self.planned = None;
            } else if plan.way.brakes() && plan.duration_s >= T::from(left as f32 * TICK_S) {
                // A shorter one stays in the hull of the path that the leg is on: it leads no farther.
                self.plan_instead();
            } else {
                let mut start = self.path.motion(start_part);
                if left <= 0 {
                    // What rounding leaves of its motion would lead farther, the longer a path takes.
                    start = MotionState::resting(start.position);
                }
                plan.tried = Some(plan.attempt(&start));
            }
            return;
        };
        attempt.ahead -= 1;
        // How far the path leads takes the time of a place.
        let mut places = PLACES_A_CYCLE;
        if attempt.place == 0 {
            if !plan.way.brakes() && self.limits.leads_too_far(&attempt.path) {
                return self.plan_instead();
            }
            places -= 1;
        }
        for _ in 0..places {
            if !self.limits.kept(&attempt.path, attempt.place) {
                plan.duration_s = longer(plan.duration_s);
                plan.tried = None;
                return;
            }
            attempt.place += 1;
        }
        if attempt.ahead > 0 {
            return;
        }
        (self.path, self.elapsed, self.duration) = (attempt.path, 0, attempt.cycles * CYCLE);
        let (end, way) = (plan.end, plan.way);
        self.planned = (way == Way::BrakesFirst).then(|| self.begin_plan(end, Way::Later));
    }
}

impl<T: Scalar> Plan<T> {
    /// A path from where the trajectory will be.
    #[inline(always)]
    fn attempt(&self, start: &MotionState<T>) -> Attempt<T> {
        let end = if self.way.brakes() {
            start.rest_after(self.duration_s).position
        } else {
            self.end
        };
        // Whole cycles: the path is stretched to them.
        let cycles = cycles(self.duration_s);
        Attempt {
            path: Quintic::new(start, end, T::from(cycles as f32 * CYCLE_S)),
            cycles,
            ahead: AHEAD,
            place: 0,
        }
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test may panic")]
mod tests {
    use super::{AHEAD, LONGEST_S, Trajectory};
    use crate::control::{MotionLimits, Stream, StreamLimits};
    use crate::settings::Settings;
    use leg_model::HalfTangent;

    /// It is given up as a whole: none is begun that would be cut off.
    #[test]
    fn a_way_that_takes_too_long_is_not_begun() {
        let mut settings = Settings::table_1().unwrap();
        settings.motion.speed_rad_per_s = 1e-4;
        let limits = MotionLimits::<f64>::new(&settings);
        for (part, begins) in [(0.9, true), (1.1, false)] {
            let mut trajectory = Trajectory::new(limits, HalfTangent::new(0.0, 0.0));
            let mut stream = Stream::new(StreamLimits::new(&settings));
            let per_s = 1.0 / limits.shortest_s([0.0; 2], [1.0, 0.0]);
            trajectory.go(HalfTangent::new(part * f64::from(LONGEST_S) * per_s, 0.0));
            for _ in 0..=AHEAD {
                trajectory.advance_plan(&mut stream, 0.0);
                trajectory.step();
            }
            assert_eq!(trajectory.moving(), begins, "{part}");
        }
    }
}
