//! The host that streams a path: a move to its run-up, then its points, each a little ahead of its time.

use super::SimulationError;
use super::follow_error::FollowError;
use super::test_stand::TestStand;
use leg_base::timed_path::{TimedPath, TimedPoint};
use leg_firmware::command::Command;
use leg_firmware::sensors::TICK_HZ;
use leg_firmware::set_point::StreamPart;
use leg_firmware::supervisor::State;

/// Time by which a point is sent before that of the point before it, ticks: 0.1 s, so ten points at 100 Hz wait on the board.
const AHEAD_TICKS: u32 = TICK_HZ as u32 / 10;

/// Time that the leg rests at the run-up's start, ticks: 0.5 s.
const REST_TICKS: u32 = TICK_HZ as u32 / 2;

/// A path that is being streamed.
#[derive(Clone, Debug)]
pub(super) struct Follower {
    path: TimedPath,
    /// The points with the rest before them.
    points: Vec<TimedPoint>,
    ends: bool,
    /// Since when the leg rests at the first of them.
    rests_from: Option<u32>,
    /// The tick at which the path begins.
    begins: Option<u32>,
    sent: usize,
    /// The tick of the last point that was sent.
    last_tick: u32,
}

impl Follower {
    /// Sends the leg to the rest before the path.
    pub fn new(
        path: TimedPath,
        ends: bool,
        stand: &mut TestStand<'_>,
    ) -> Result<Self, SimulationError> {
        let points = path.streamed(&stand.settings);
        let points =
            points.map_err(|(time_s, refusal)| SimulationError::Path { time_s, refusal })?;
        let [x, y] = points[0].motion.position.map(|number| number as f32);
        stand.send(&Command::Move { x, y })?;
        stand.follow_error = FollowError::default();
        Ok(Self {
            path,
            points,
            ends,
            rests_from: None,
            begins: None,
            sent: 0,
            last_tick: 0,
        })
    }

    /// Sends what is due; whether the path is over and, if its last point was told, the leg rests.
    pub fn advance(&mut self, stand: &mut TestStand<'_>) -> Result<bool, SimulationError> {
        let Some(telemetry) = stand.telemetry else {
            return Ok(false);
        };
        let now = telemetry.tick;
        let Some(begins) = self.begins else {
            let rests = telemetry.state == State::Active && !telemetry.moving;
            self.begins = self.beginning(now, rests);
            self.last_tick = now;
            return Ok(false);
        };
        while let Some(point) = self.points.get(self.sent) {
            let part = match self.sent {
                0 => StreamPart::First,
                _ if self.ends && self.sent + 1 == self.points.len() => StreamPart::Last,
                _ => StreamPart::Next,
            };
            let set_point = point.set_point(begins, part);
            if self.last_tick.wrapping_sub(now) as i32 > AHEAD_TICKS as i32 {
                break;
            }
            stand.send(&Command::Follow(set_point))?;
            self.last_tick = set_point.tick;
            self.sent += 1;
        }
        let time_s = f64::from(now.wrapping_sub(begins) as i32) / f64::from(TICK_HZ);
        if let Some(at) = self.path.at(time_s) {
            stand.compare_with(&at);
        }
        let last = self.points.last();
        let over = last.is_none_or(|last| time_s > last.time_s);
        if over {
            stand.forget_commanded();
        }
        Ok(over && !(self.ends && telemetry.moving))
    }

    /// The tick at which the path begins, once the leg has rested long enough.
    fn beginning(&mut self, now: u32, rests: bool) -> Option<u32> {
        if !rests {
            self.rests_from = None;
            return None;
        }
        let rests_from = *self.rests_from.get_or_insert(now);
        let run_up_s = self.points.first().map_or(0.0, |rest| -rest.time_s);
        let ahead = AHEAD_TICKS + (run_up_s * f64::from(TICK_HZ)) as u32;
        (now.wrapping_sub(rests_from) >= REST_TICKS).then(|| now.wrapping_add(ahead))
    }
}
