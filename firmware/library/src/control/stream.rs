//! Set-points that a host streams: checked when they come, kept until their time.

use super::pretension::PretensionDemand;
use super::quintic::MotionState;
use super::segment::{Knot, Segment};
use super::stream_limits::StreamLimits;
use super::{CYCLE_TICKS, TICK_S};
use crate::set_point::{PointRefusal, SetPoint, StreamPart, StreamTension};
use heapless::Deque;
use leg_model::Scalar;

/// Set-points that may wait: a third of a second at 100 Hz.
pub const POINTS_MAX: usize = 32;

/// Ticks between two points, at least: 5 ms. Nearer to each other, too much of their acceleration would be rounding.
const SPACING_MIN_TICKS: u32 = 10 * CYCLE_TICKS as u32;

/// Ticks from now to a point, at most: 10 s, thirty times what [`POINTS_MAX`] points at 100 Hz span. A point farther ahead has a wrong
/// count of ticks, and would keep its place in the queue until then.
const AHEAD_MAX_TICKS: u32 = 80_000;

/// The set-points that wait, and where the path to them has come to.
#[derive(Clone, Debug)]
pub struct Stream<T> {
    /// What every path keeps to.
    pub limits: StreamLimits<T>,
    waiting: Deque<Waiting<T>, POINTS_MAX>,
    /// What the segment that was just entered asks of the tendons, until that is taken.
    tension: Option<StreamTension>,
    /// Where the segment that is followed ends.
    reached: Knot<T>,
    /// The last point that was accepted, as a knot and as it came.
    last: Knot<T>,
    last_point: Option<SetPoint>,
    /// Whether more points may come.
    open: bool,
}

/// A point that waits.
#[derive(Clone, Copy, Debug)]
struct Waiting<T> {
    knot: Knot<T>,
    tension: PackedTension,
}

/// What a point asks of the tendons, in four bytes, as many points wait: a stiffness is kept below 0, and nothing as no number. A pretension
/// that is possible is not below 0, and a stiffness above it.
#[derive(Clone, Copy, Debug)]
struct PackedTension(f32);

impl PackedTension {
    const fn new(tension: Option<StreamTension>) -> Self {
        match tension {
            None => Self(f32::NAN),
            Some(StreamTension::Pretension(pretension_n)) => Self(pretension_n),
            Some(StreamTension::Stiffness(stiffness)) => Self(-stiffness),
        }
    }

    fn tension(self) -> Option<StreamTension> {
        if self.0.is_nan() {
            None
        } else if self.0 < 0.0 {
            Some(StreamTension::Stiffness(-self.0))
        } else {
            Some(StreamTension::Pretension(self.0))
        }
    }
}

impl<T: Scalar> Stream<T> {
    /// Without points.
    pub fn new(limits: StreamLimits<T>) -> Self {
        let origin = Knot {
            tick: 0,
            motion: MotionState::resting([T::zero(); 2]),
        };
        Self {
            limits,
            waiting: Deque::new(),
            tension: None,
            reached: origin,
            last: origin,
            last_point: None,
            open: false,
        }
    }

    /// Starts a stream from `start`, where the leg is led, with its first point.
    ///
    /// # Errors
    /// As [`Self::extend`]; whatever was there before stays.
    pub fn begin(&mut self, start: Knot<T>, point: &SetPoint) -> Result<(), PointRefusal> {
        let knot = self.checked(&start, start.tick, point)?;
        self.waiting.clear();
        self.reached = start;
        self.push(knot, point);
        self.open = true;
        Ok(())
    }

    /// Whether a point is the last one again: its answer was lost.
    pub fn repeats(&self, point: &SetPoint) -> bool {
        self.last_point == Some(*point)
    }

    /// Forgets it: the stream was left, and a point that comes again is not followed.
    pub fn leave(&mut self) {
        self.last_point = None;
    }

    /// Takes the next point of a stream.
    ///
    /// # Errors
    /// Why the point is refused. The points before it stay.
    pub fn extend(&mut self, now: u32, point: &SetPoint) -> Result<(), PointRefusal> {
        if !self.open {
            return Err(PointRefusal::NoStream);
        }
        if self.waiting.is_full() {
            return Err(PointRefusal::Full);
        }
        let knot = self.checked(&self.last, now, point)?;
        self.open = point.part != StreamPart::Last;
        self.push(knot, point);
        Ok(())
    }

    fn push(&mut self, knot: Knot<T>, point: &SetPoint) {
        (self.last, self.last_point) = (knot, Some(*point));
        // There is room: it was just checked, or made.
        let tension = PackedTension::new(point.tension);
        let _ = self.waiting.push_back(Waiting { knot, tension });
    }

    /// The knot of a point that may follow on `before`: the segment to it keeps the limits, and after it the leg can come to rest
    /// within them.
    fn checked(
        &self,
        before: &Knot<T>,
        now: u32,
        point: &SetPoint,
    ) -> Result<Knot<T>, PointRefusal> {
        let ticks = spacing(before.tick, now, point.tick)?;
        if !point.tension.is_none_or(StreamTension::is_possible) {
            return Err(PointRefusal::Number);
        }
        let mut motion = self.limits.motion(point)?;
        if point.acceleration.is_none() {
            let time_s = T::from(ticks as f32 * TICK_S);
            motion.acceleration = before.motion.acceleration_at_end(&motion, time_s);
        }
        let knot = Knot {
            tick: point.tick,
            motion,
        };
        self.limits.keeps(&Segment::connect(before, &knot).path)?;
        self.limits.keeps_to_rest(&motion)?;
        Ok(knot)
    }

    /// The segment to the next point; none without one.
    pub fn next_segment(&mut self) -> Option<Segment<T>> {
        let Waiting { knot: to, tension } = self.waiting.pop_front()?;
        self.tension = tension.tension();
        let from = core::mem::replace(&mut self.reached, to);
        Some(Segment::connect(&from, &to))
    }

    /// What the segment that was entered asks of the tendons, once.
    #[inline(always)]
    pub fn take_demand(&mut self) -> Option<PretensionDemand<T>> {
        Some(PretensionDemand::from(self.tension.take()?))
    }

    /// The segment that ends a stream in rest, and whether it ends before its last point came.
    pub fn end(&mut self) -> (Segment<T>, bool) {
        let missing = core::mem::take(&mut self.open);
        (self.limits.rest_segment(&self.reached.motion), missing)
    }
}

/// Ticks between two points.
fn spacing(before: u32, now: u32, tick: u32) -> Result<u32, PointRefusal> {
    // The count of ticks wraps after six days: what is half of that ahead is behind.
    let ahead = tick.wrapping_sub(now);
    if ahead == 0 || ahead > u32::MAX / 2 {
        return Err(PointRefusal::Late);
    }
    if ahead > AHEAD_MAX_TICKS {
        return Err(PointRefusal::Early);
    }
    let ticks = tick.wrapping_sub(before);
    if !(SPACING_MIN_TICKS..=u32::MAX / 2).contains(&ticks) {
        return Err(PointRefusal::Order);
    }
    Ok(ticks)
}

#[cfg(test)]
mod tests {
    use super::{
        AHEAD_MAX_TICKS, PackedTension, PointRefusal, SPACING_MIN_TICKS, StreamTension, spacing,
    };

    /// Also where the count of ticks wraps meanwhile.
    #[test]
    fn a_point_of_the_past_is_late_and_one_of_a_far_future_early() {
        let late = Err(PointRefusal::Late);
        for now in [0, 1_000_000, u32::MAX - SPACING_MIN_TICKS, u32::MAX] {
            let in_ticks = |ticks: u32| spacing(now, now, now.wrapping_add(ticks));
            for past in [0, 1, AHEAD_MAX_TICKS, i32::MAX.unsigned_abs()] {
                assert_eq!(spacing(now, now, now.wrapping_sub(past)), late, "{past}");
            }
            assert_eq!(in_ticks(SPACING_MIN_TICKS - 1), Err(PointRefusal::Order));
            for ticks in [SPACING_MIN_TICKS, AHEAD_MAX_TICKS] {
                assert_eq!(in_ticks(ticks), Ok(ticks));
            }
            assert_eq!(in_ticks(AHEAD_MAX_TICKS + 1), Err(PointRefusal::Early));
        }
    }

    #[test]
    fn what_a_point_asks_is_kept() {
        for tension in [
            None,
            Some(StreamTension::Pretension(0.0)),
            Some(StreamTension::Pretension(70.0)),
            Some(StreamTension::Stiffness(f32::MIN_POSITIVE)),
            Some(StreamTension::Stiffness(90.0)),
        ] {
            assert!(tension.is_none_or(StreamTension::is_possible));
            assert_eq!(PackedTension::new(tension).tension(), tension);
        }
        for tension in [
            StreamTension::Pretension(-1e-3),
            StreamTension::Pretension(f32::NAN),
            StreamTension::Pretension(f32::INFINITY),
            StreamTension::Stiffness(0.0),
            StreamTension::Stiffness(-1.0),
            StreamTension::Stiffness(f32::NAN),
            StreamTension::Stiffness(f32::INFINITY),
        ] {
            assert!(!tension.is_possible(), "{tension:?}");
        }
    }
}
