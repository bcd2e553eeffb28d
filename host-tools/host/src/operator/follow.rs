//! Streaming a path to the leg as set-points.

use super::motion::{MOVE, is_overtaken, not_following, unlimited};
use super::{Operator, OperatorError};
use crate::path_reader::{PathSource, PathStep};
use leg_base::failure::Failure;
use leg_base::timed_path::{TimedPath, TimedPoint, run_up, way};
use leg_firmware::command::{Command, CommandRefusal};
use leg_firmware::host_link::HostRefusal;
use leg_firmware::sensors::TICK_HZ;
use leg_firmware::set_point::{PointRefusal, StreamPart};
use leg_firmware::supervisor::{Fault, FaultSet, State};
use leg_firmware::telemetry::Telemetry;
use std::time::Duration;

/// What the leg is asked to do.
const ASKED: &str = "follow the path";

/// Wait for room on the board, or for the next row of a program.
const WAIT_TIME: Duration = Duration::from_millis(5);

/// Such waits after which it is looked at what the leg does.
const WAITS: u32 = 20;

/// A stream that is being sent.
struct Sending {
    /// The tick at which the path begins.
    begins: u32,
    /// The point that is sent as soon as it is known whether another follows.
    held_back: Option<TimedPoint>,
}

impl Operator {
    /// Follows a path that is known to its end; refused before the leg moves where a point is.
    ///
    /// # Errors
    /// As [`Self::follow`].
    pub fn follow_whole(
        &mut self,
        path: &TimedPath,
        lead: Duration,
    ) -> Result<Telemetry<f32>, OperatorError> {
        let settings = self.settings()?;
        let checked = path.streamed(&settings);
        checked.map_err(|(time_s, refusal)| OperatorError::Point(time_s, refusal))?;
        self.follow(&mut PathSource::whole(path.points().to_vec()), lead)
    }

    /// Leads the leg to where it rests before a path, streams the path from `lead` after that on, waits until the leg rests, and
    /// leaves it to itself.
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
        let Some(first) = self.next_point(path)? else {
            let failure = Failure::refused("the path has no rows", "give one or more");
            return Err(OperatorError::Path(failure));
        };
        let start = run_up(&first, &settings);
        let start = start.map_err(|refusal| OperatorError::Point(first.time_s, refusal))?;
        let rest = *start.first().unwrap_or(&first);
        self.drive_to_station(|operator| {
            operator.activate(ASKED)?;
            let [x, y] = rest.motion.position.map(|component| component as f32);
            operator.command(Command::Move { x, y })?;
            let telemetry = operator.settle(ASKED)?;
            unlimited(ASKED, &telemetry)?;
            let begins_s = lead.as_secs_f64() - rest.time_s;
            let begins = (begins_s * f64::from(TICK_HZ)) as u32;
            let begins = operator.telemetry()?.telemetry.tick.wrapping_add(begins);
            operator.send_point(&rest, begins, StreamPart::First)?;
            let mut sending = Sending {
                begins,
                held_back: None,
            };
            let mut sent = operator.send_points(start.iter().skip(1), &mut sending);
            if sent.is_ok() {
                sent = operator.send_rest(path, first, &mut sending);
            }
            // Whatever is wrong with the path: the leg comes to rest first.
            if !matches!(
                sent,
                Ok(()) | Err(OperatorError::Path(_) | OperatorError::Point(..))
            ) {
                return sent.and_then(|()| operator.settle(ASKED));
            }
            if let Some(last) = sending.held_back {
                operator.send_point(&last, begins, StreamPart::Last)?;
            }
            let telemetry = operator.poll_followed(ASKED, &MOVE, |telemetry| !telemetry.moving)?;
            sent?;
            unlimited(ASKED, &telemetry)?;
            operator.settle(ASKED)
        })
    }

    /// Sends what is left of a path, with points between those that are far from each other.
    fn send_rest(
        &mut self,
        path: &mut PathSource,
        first: TimedPoint,
        sending: &mut Sending,
    ) -> Result<(), OperatorError> {
        let mut from = first;
        while let Some(to) = self.next_point(path)? {
            self.send_points(way(&from, &to).iter(), sending)?;
            from = to;
        }
        Ok(())
    }

    /// Sends the point that was held back and all of these but the last, which is held back then.
    fn send_points<'a>(
        &mut self,
        points: impl Iterator<Item = &'a TimedPoint>,
        sending: &mut Sending,
    ) -> Result<(), OperatorError> {
        for point in points {
            let Some(before) = sending.held_back.replace(*point) else {
                continue;
            };
            if let Err(error) = self.send_point(&before, sending.begins, StreamPart::Next) {
                // What comes after a point that is refused is none of the leg's.
                sending.held_back = None;
                return Err(error);
            }
        }
        Ok(())
    }

    /// The next point of a path, once it is there; none at the end.
    fn next_point(&mut self, path: &mut PathSource) -> Result<Option<TimedPoint>, OperatorError> {
        for waits in 1_u32.. {
            match path.next_step().map_err(OperatorError::Path)? {
                PathStep::Point(point) => return Ok(Some(point)),
                PathStep::Wait => self.pause(WAIT_TIME)?,
                PathStep::End => break,
            }
            if self.drives && waits.is_multiple_of(WAITS) {
                self.require_stream()?;
            }
        }
        Ok(None)
    }

    /// Fails if the leg does not follow the stream any more, with the reason.
    fn require_stream(&mut self) -> Result<(), OperatorError> {
        let telemetry = self.telemetry()?.telemetry;
        if !telemetry.state.follows() {
            return Err(not_following(ASKED, &telemetry));
        }
        // A tension that is out of reach is held at its bound, and the stream goes on.
        let mut limits = telemetry.faults.limits();
        limits = limits.difference(FaultSet::single(Fault::Unreachable));
        if limits.any() {
            return Err(OperatorError::Limited(ASKED, Box::new(telemetry)));
        }
        Ok(())
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
            let error = match self.command(command) {
                Ok(()) => return Ok(()),
                Err(error) => error,
            };
            match error {
                OperatorError::Refused(_, HostRefusal::Command(CommandRefusal::Point(refusal))) => {
                    match refusal {
                        PointRefusal::Full | PointRefusal::Early => self.pause(WAIT_TIME)?,
                        PointRefusal::NoStream => {
                            self.require_stream()?;
                            return Err(error);
                        }
                        _ => return Err(OperatorError::Point(point.time_s, refusal)),
                    }
                }
                // What limits the leg on its way down is no matter.
                OperatorError::Refused(
                    _,
                    HostRefusal::Command(CommandRefusal::State(state @ State::RampingDown)),
                ) => return Err(OperatorError::StoppedByOtherHost(ASKED, state)),
                error if is_overtaken(&error) => return Err(error),
                OperatorError::Refused(..) | OperatorError::Faulted(..) => {
                    // Why it no longer follows says more.
                    self.require_stream()?;
                    return Err(error);
                }
                _ => return Err(error),
            }
        }
    }
}
