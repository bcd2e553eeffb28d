//! Listening to the leg.

use super::asking::Repeat;
use super::{Operator, OperatorError};
use leg_firmware::host_link::{HostReply, HostRequest, Told};
use leg_firmware::telemetry::Telemetry;
use std::time::Duration;

/// How often the operator looks while it waits for the leg.
pub(super) const LOOK_TIME: Duration = Duration::from_millis(20);

impl Operator {
    /// Asks for telemetry every so many ticks, or for no more with 0.
    ///
    /// # Errors
    /// As [`Self::command`].
    pub fn stream(&mut self, every_ticks: u16) -> Result<(), OperatorError> {
        let asked = "send telemetry";
        match self.ask(asked, &HostRequest::Stream(every_ticks), Repeat::Always)? {
            HostReply::Done => {
                self.streams = every_ticks > 0;
                Ok(())
            }
            _ => Err(OperatorError::WrongReply { asked }),
        }
    }

    /// The next telemetry of the stream; none if none comes in time.
    ///
    /// # Errors
    /// A line that breaks; [`OperatorError::Interrupted`].
    pub fn streamed(&mut self, timeout: Duration) -> Result<Option<Told>, OperatorError> {
        let until = self.now() + timeout;
        loop {
            if let Some(told) = self.told.pop_front() {
                return Ok(Some(told));
            }
            if self.interrupt.raised() {
                return Err(OperatorError::Interrupted);
            }
            match self.line.receive(until)? {
                Some((0, HostReply::Telemetry(told))) => return Ok(Some(told)),
                None => return Ok(None),
                Some(_) => {}
            }
        }
    }

    /// Looks at the leg again and again until `done` with it.
    ///
    /// # Errors
    /// [`OperatorError::Late`] after `timeout`; as [`Self::command`].
    pub fn until(
        &mut self,
        what: &'static str,
        timeout: Duration,
        mut done: impl FnMut(&Telemetry<f32>) -> bool,
    ) -> Result<Telemetry<f32>, OperatorError> {
        let until = self.now() + timeout;
        loop {
            let telemetry = self.telemetry()?.telemetry;
            if done(&telemetry) {
                return Ok(telemetry);
            }
            if self.now() >= until {
                return Err(OperatorError::Late {
                    what,
                    timeout,
                    state: telemetry.state,
                    faults: telemetry.faults,
                });
            }
            self.pause(LOOK_TIME)?;
        }
    }
}
