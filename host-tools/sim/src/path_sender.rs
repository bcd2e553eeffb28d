//! The host that streams a path: a move to its run-up, then its points, each a little ahead of its time.

use leg_base::timed_path::{TimedPath, TimedPoint};
use leg_firmware::command::Command;
use leg_firmware::control::MotionState;
use leg_firmware::sensors::TICK_HZ;
use leg_firmware::set_point::{PointRefusal, StreamPart};
use leg_firmware::settings::Settings;
use leg_firmware::supervisor::State;
use leg_firmware::telemetry::Telemetry;

/// Time by which a point is sent before that of the point before it, ticks: 0.1 s, so ten points at 100 Hz wait on the board.
const AHEAD_TICKS: u32 = TICK_HZ as u32 / 10;

/// Time that the leg rests at the run-up's start, ticks: 0.5 s.
const REST_TICKS: u32 = TICK_HZ as u32 / 2;

/// A path that is being streamed.
#[derive(Clone, Debug)]
pub struct PathSender {
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

impl PathSender {
    /// A path for a leg with these settings. Without `ends` its last point is not marked as the last.
    ///
    /// # Errors
    /// The time of the point that is refused, s, and why.
    pub fn new(
        path: TimedPath,
        ends: bool,
        settings: &Settings,
    ) -> Result<Self, (f64, PointRefusal)> {
        Ok(Self {
            points: path.streamed(settings)?,
            path,
            ends,
            rests_from: None,
            begins: None,
            sent: 0,
            last_tick: 0,
        })
    }

    /// What sends the leg to the rest before the path: the first command.
    #[must_use]
    pub fn approach(&self) -> Command {
        let first = self.points.first();
        let [x, y] = first.map_or([0.0; 2], |point| point.motion.position.map(|p| p as f32));
        Command::Move { x, y }
    }

    /// The points that are due after a tick.
    pub fn due(&mut self, telemetry: &Telemetry<f32>) -> Vec<Command> {
        let now = telemetry.tick;
        let mut due = Vec::new();
        let Some(begins) = self.begins else {
            let rests = telemetry.state == State::Active && !telemetry.moving;
            self.begins = self.beginning(now, rests);
            self.last_tick = now;
            return due;
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
            due.push(Command::Follow(set_point));
            self.last_tick = set_point.tick;
            self.sent += 1;
        }
        due
    }

    /// Time since the first row at a tick, s; none before the leg rests long enough to begin. Negative on the way to the first
    /// row.
    #[must_use]
    pub fn time_s(&self, telemetry: &Telemetry<f32>) -> Option<f64> {
        let ticks = telemetry.tick.wrapping_sub(self.begins?) as i32;
        Some(f64::from(ticks) / f64::from(TICK_HZ))
    }

    /// Where the path has the leg at a time; none before and after it.
    #[must_use]
    pub fn motion(&self, time_s: f64) -> Option<MotionState<f64>> {
        self.path.motion(time_s)
    }

    /// Whether the path is over at a time.
    #[must_use]
    pub fn is_over(&self, time_s: f64) -> bool {
        self.points.last().is_none_or(|last| time_s > last.time_s)
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
