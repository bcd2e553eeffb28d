//! Keep-alives: a driven leg comes to rest when it receives nothing from its host for its command timeout.

use super::error::COMMAND_TIME_MIN_S;
use super::{Operator, OperatorError};
use leg_firmware::command::Command;
use leg_firmware::host_link::HostRequest;
use std::time::Duration;

/// How often the host looks for Ctrl-C: 50 ms, which nobody feels as a delay.
const WAKE_TIME: Duration = Duration::from_millis(50);

/// Keep-alives within a command timeout: that many less one may be lost.
const KEEP_ALIVES: u32 = 4;

impl Operator {
    /// Finds out how often the leg has to receive something from this host, unless that is known.
    pub(super) fn learn_command_time(&mut self) -> Result<(), OperatorError> {
        if self.silence_max.is_some() {
            return Ok(());
        }
        let command_time_s = self.settings()?.limits.command_time_s;
        if command_time_s < COMMAND_TIME_MIN_S {
            return Err(OperatorError::CommandTimeTooShort(command_time_s));
        }
        let command_time = Duration::try_from_secs_f32(command_time_s).unwrap_or(Duration::MAX);
        self.silence_max = Some(WAKE_TIME.min(command_time / KEEP_ALIVES));
        Ok(())
    }

    /// When the host has to wake next.
    pub(super) fn wake_at(&self) -> Duration {
        let wake = self.now() + WAKE_TIME;
        self.keep_alive_due().map_or(wake, |due| wake.min(due))
    }

    /// When the next keep-alive is due; none if none is needed.
    fn keep_alive_due(&self) -> Option<Duration> {
        let silence_max = self.silence_max.unwrap_or(WAKE_TIME);
        (self.keeps_alive && self.drives).then_some(self.commanded_at + silence_max)
    }

    /// Sends a keep-alive if one is due.
    pub(super) fn keep_alive(&mut self) -> Result<(), OperatorError> {
        if self.keep_alive_due().is_some_and(|due| self.now() >= due) {
            self.commanded_at = self.now();
            self.connection.send(&HostRequest::Command {
                host: self.host,
                command: Command::KeepAlive,
            })?;
        }
        Ok(())
    }
}
