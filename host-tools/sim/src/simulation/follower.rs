//! A path that is streamed to the leg of a scenario, and compared with where the leg is.

use super::SimulationError;
use super::follow_error::FollowError;
use super::test_stand::TestStand;
use crate::path_sender::PathSender;
use leg_base::timed_path::TimedPath;

/// A path that is being streamed.
#[derive(Clone, Debug)]
pub(super) struct Follower {
    sender: PathSender,
    ends: bool,
}

impl Follower {
    /// Sends the leg to the rest before the path.
    pub fn new(
        path: TimedPath,
        ends: bool,
        stand: &mut TestStand<'_>,
    ) -> Result<Self, SimulationError> {
        let sender = PathSender::new(path, ends, &stand.settings);
        let sender =
            sender.map_err(|(time_s, refusal)| SimulationError::Path { time_s, refusal })?;
        stand.send(&sender.approach(), "move to the path")?;
        stand.follow_error = FollowError::default();
        Ok(Self { sender, ends })
    }

    /// Sends what is due; whether the path is over and, if its last point was marked as that, the leg rests.
    pub fn advance(&mut self, stand: &mut TestStand<'_>) -> Result<bool, SimulationError> {
        let Some(telemetry) = stand.leg.telemetry().copied() else {
            return Ok(false);
        };
        let Some(time_s) = self.sender.time_s(&telemetry) else {
            self.sender.due(&telemetry);
            return Ok(false);
        };
        for command in self.sender.due(&telemetry) {
            stand.send(&command, "follow")?;
        }
        if let Some(at) = self.sender.motion(time_s) {
            stand.compare_with(&at);
        }
        let over = self.sender.is_over(time_s);
        if over {
            stand.forget_commanded();
        }
        Ok(over && !(self.ends && telemetry.moving))
    }
}
