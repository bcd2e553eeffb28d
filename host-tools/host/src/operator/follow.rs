//! Streaming a path to the leg as set-points.

use super::motion::unlimited;
use super::{Operator, OperatorError};
use crate::path_reader::{PathSource, PathStep};
use leg_base::failure::Failure;
use leg_base::timed_path::{self, TimedPoint};
use leg_firmware::command::{Command, CommandRefusal};
use leg_firmware::control::StreamLimits;
use leg_firmware::host_link::HostRefusal;
use leg_firmware::sensors::TICK_HZ;
use leg_firmware::set_point::{PointRefusal, StreamPart};
use leg_firmware::settings::Settings;
use leg_firmware::telemetry::Telemetry;
use std::time::Duration;

/// What the leg is asked to do.
const ASKED: &str = "follow set-points";

/// Wait for room on the board, or for the next row of a program.
const WAIT_TIME: Duration = Duration::from_millis(5);

/// Longest way to rest after the last point.
const REST_TIME: Duration = Duration::from_secs(60);

impl Operator {
    /// Follows a path whose points are all known; refused before the leg moves where a point is.
    ///
    /// # Errors
    /// As [`Self::follow`].
    pub fn follow_whole(
        &mut self,
        points: &[TimedPoint],
        lead: Duration,
    ) -> Result<Telemetry<f32>, OperatorError> {
        let settings = self.settings()?;
        let Some(first) = points.first() else {
            return Err(no_points());
        };
        let limits = StreamLimits::<f32>::new(&settings);
        for point in points {
            let motion = limits.motion(&point.set_point(0, StreamPart::Next));
            motion.map_err(|refusal| refused_point(point, refusal))?;
        }
        let mut all = vec![rest_before(first, &settings)?];
        all.extend_from_slice(points);
        timed_path::check(&all, &settings).map_err(|(number, refusal)| {
            let refused = all.get(number).unwrap_or(first);
            refused_point(refused, refusal)
        })?;
        self.follow(&mut PathSource::whole(points.to_vec()), lead)
    }

    /// Leads the leg to where it rests before a path, streams the path from `lead` after that on, waits until the leg rests, and
    /// leaves it in hold.
    ///
    /// # Errors
    /// [`OperatorError::Path`]; as [`Self::reach`].
    pub fn follow(
        &mut self,
        path: &mut PathSource,
        lead: Duration,
    ) -> Result<Telemetry<f32>, OperatorError> {
        self.settle_state(ASKED)?;
        let settings = self.settings()?;
        let first = self.first_point(path)?;
        let rest = rest_before(&first, &settings)?;
        self.drive(|operator| {
            operator.activate(ASKED)?;
            let [x, y] = rest.derivatives[0].map(|component| component as f32);
            operator.command(Command::Move { x, y })?;
            let telemetry = operator.settle(ASKED)?;
            unlimited(ASKED, &telemetry)?;
            let begins_s = lead.as_secs_f64() + first.time_s - rest.time_s;
            let begins = (begins_s * f64::from(TICK_HZ)) as u32;
            let begins = operator.telemetry()?.telemetry.tick.wrapping_add(begins);
            operator.send_point(&rest, begins, StreamPart::First)?;
            let mut last = first;
            while let Some(next) = operator.next_point(path)? {
                operator.send_point(&last, begins, StreamPart::Next)?;
                last = next;
            }
            operator.send_point(&last, begins, StreamPart::Last)?;
            let telemetry =
                operator.poll_followed(ASKED, REST_TIME, |telemetry| !telemetry.moving)?;
            unlimited(ASKED, &telemetry)?;
            operator.settle(ASKED)
        })
    }

    fn first_point(&mut self, path: &mut PathSource) -> Result<TimedPoint, OperatorError> {
        self.next_point(path)?.ok_or_else(no_points)
    }

    /// The next point of a path, once it is there; none at the end.
    fn next_point(&mut self, path: &mut PathSource) -> Result<Option<TimedPoint>, OperatorError> {
        loop {
            match path.next_step().map_err(OperatorError::Path)? {
                PathStep::Point(point) => return Ok(Some(point)),
                PathStep::Wait => self.pause(WAIT_TIME)?,
                PathStep::End => return Ok(None),
            }
        }
    }

    /// Sends a point, as soon as there is room for it.
    fn send_point(
        &mut self,
        point: &TimedPoint,
        begins: u32,
        part: StreamPart,
    ) -> Result<(), OperatorError> {
        let command = Command::Follow(point.set_point(begins, part));
        loop {
            let Err(error) = self.command(command) else {
                return Ok(());
            };
            let OperatorError::Refused(_, HostRefusal::Command(CommandRefusal::Point(refusal))) =
                error
            else {
                return Err(error);
            };
            match refusal {
                PointRefusal::Full | PointRefusal::Early => self.pause(WAIT_TIME)?,
                PointRefusal::NoStream => {
                    // Why the stream has ended says more.
                    let telemetry = self.telemetry()?.telemetry;
                    unlimited(ASKED, &telemetry)?;
                    return Err(error);
                }
                _ => return Err(refused_point(point, refusal)),
            }
        }
    }
}

fn rest_before(first: &TimedPoint, settings: &Settings) -> Result<TimedPoint, OperatorError> {
    timed_path::run_up(first, settings).map_err(|refusal| refused_point(first, refusal))
}

fn refused_point(point: &TimedPoint, refusal: PointRefusal) -> OperatorError {
    let [wrong, remedy] = refusal.description();
    let sentence = format!("the path {:.3} s after its start: {wrong}", point.time_s);
    OperatorError::Path(Failure::refused(sentence, remedy))
}

fn no_points() -> OperatorError {
    OperatorError::Path(Failure::refused("the path has no rows", "give two or more"))
}
