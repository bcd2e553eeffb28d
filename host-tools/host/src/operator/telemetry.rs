//! Listening to the leg.

use super::alive::WAKE_TIME;
use super::asking::Repeat;
use super::{Operator, OperatorError};
use leg_firmware::host_link::{HostReply, HostRequest, Told};
use leg_firmware::telemetry::Telemetry;
use std::collections::VecDeque;
use std::time::Duration;

/// How often the operator looks while it waits for the leg.
pub(super) const LOOK_TIME: Duration = Duration::from_millis(20);

/// Telemetry that comes by itself.
#[derive(Debug, Default)]
pub(super) struct Stream {
    /// Ticks from one to the next that this host has asked for; 0 for none: that of others on the same line is theirs.
    every_ticks: u16,
    /// What came and was not looked at yet.
    told: VecDeque<Told>,
    /// Whether another host has introduced itself since: a leg may take that for the end of the stream.
    greeted: bool,
}

impl Operator {
    /// Asks for telemetry every so many ticks, or for no more with 0.
    ///
    /// # Errors
    /// As [`Self::command`].
    pub fn stream(&mut self, every_ticks: u16) -> Result<(), OperatorError> {
        let asked = "send telemetry";
        match self.ask(asked, &HostRequest::Stream(every_ticks), Repeat::Always)? {
            HostReply::Done => {
                self.stream.every_ticks = every_ticks;
                Ok(())
            }
            _ => Err(OperatorError::WrongReply { asked }),
        }
    }

    /// Lets the telemetry end, heedless of Ctrl-C: a leg that goes on telling takes room from the other hosts.
    ///
    /// # Errors
    /// As [`Self::stream`].
    pub fn end_stream(&mut self) -> Result<(), OperatorError> {
        self.heedless(|operator| operator.stream(0))
    }

    /// Keeps telemetry that came while something else was waited for.
    pub(super) fn overhear(&mut self, told: Told) {
        if self.stream.every_ticks > 0 {
            self.stream.told.push_back(told);
        }
    }

    /// Takes note of what other hosts are answered.
    pub(super) fn overhear_reply(&mut self, reply: &HostReply) {
        if self.stream.every_ticks > 0 && matches!(reply, HostReply::Identified(_)) {
            self.stream.greeted = true;
        }
    }

    /// The next telemetry of the stream; none if none comes in time. It is asked for again where another host's introduction
    /// has ended it.
    ///
    /// # Errors
    /// As [`Self::command`].
    pub fn streamed(&mut self, timeout: Duration) -> Result<Option<Told>, OperatorError> {
        let until = self.now() + timeout;
        loop {
            if let Some(told) = self.stream.told.pop_front() {
                return Ok(Some(told));
            }
            if self.interrupt.raised() {
                return Err(OperatorError::Interrupted);
            }
            if std::mem::take(&mut self.stream.greeted) {
                self.stream(self.stream.every_ticks)?;
                continue;
            }
            match self.line.receive(until.min(self.now() + WAKE_TIME))? {
                Some((0, HostReply::Telemetry(told))) => return Ok(Some(told)),
                Some((_, reply)) => self.overhear_reply(&reply),
                None if self.now() >= until => return Ok(None),
                None => {}
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
