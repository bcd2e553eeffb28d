//! Speaking often enough: a driven leg that does not hear its host comes to rest.

use super::{Operator, OperatorError};
use leg_firmware::command::Command;
use leg_firmware::host_link::HostRequest;
use std::time::Duration;

/// How often the host looks whether it shall end, or has to speak.
pub(super) const WAKE_TIME: Duration = Duration::from_millis(50);

/// What a leg has to wait at least, s: a busy machine and a line by USB take some milliseconds each.
pub(super) const PATIENCE_MIN_S: f32 = 0.02;

/// Silences that a leg has to wait for: so many words may be lost before it misses its host.
const SILENCES: u32 = 4;

impl Operator {
    /// Finds out how often the leg has to hear of this host, unless that is known.
    pub(super) fn learn_patience(&mut self) -> Result<(), OperatorError> {
        if self.silence_max.is_some() {
            return Ok(());
        }
        let command_time_s = self.settings()?.limits.command_time_s;
        if command_time_s < PATIENCE_MIN_S {
            return Err(OperatorError::Impatient { command_time_s });
        }
        let patience = Duration::try_from_secs_f32(command_time_s).unwrap_or(Duration::MAX);
        self.silence_max = Some(WAKE_TIME.min(patience / SILENCES));
        Ok(())
    }

    /// When the host has to look again: for Ctrl-C, or to be heard.
    pub(super) fn wake_at(&self) -> Duration {
        let wake = self.now() + WAKE_TIME;
        self.speaks_at().map_or(wake, |speak| wake.min(speak))
    }

    /// When the leg has to hear of this host at the latest; none if it need not.
    fn speaks_at(&self) -> Option<Duration> {
        let silence_max = self.silence_max.unwrap_or(WAKE_TIME);
        (self.alive && self.drives).then_some(self.spoke_at + silence_max)
    }

    /// Speaks if it is time.
    pub(super) fn keep_alive(&mut self) -> Result<(), OperatorError> {
        if self.speaks_at().is_some_and(|speak| self.now() >= speak) {
            self.spoke_at = self.now();
            self.line.send(&HostRequest::Command {
                host: self.host,
                command: Command::KeepAlive,
            })?;
        }
        Ok(())
    }
}
