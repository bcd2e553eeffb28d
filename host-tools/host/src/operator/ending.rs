//! Bringing the leg to rest.

use super::{Operator, OperatorError};
use leg_firmware::command::{Command, CommandRefusal};
use leg_firmware::host_link::{HOST_SCHEMA, Hello};
use leg_firmware::host_link::{HostRefusal, HostReply, HostRequest};
use leg_firmware::supervisor::State;
use leg_firmware::telemetry::Telemetry;
use std::time::Duration;

/// How often a stop is repeated.
const STOP_TIME: Duration = Duration::from_millis(50);

/// Stops without an answer.
const STOPS: u32 = 40;

/// Longest relaxing.
const RELAX_TIME: Duration = Duration::from_secs(30);

impl Operator {
    /// Stops the leg, whatever else is going on: repeated until it is acknowledged, whoever drives, heedless of Ctrl-C.
    /// Where the leg already rests or relaxes there is nothing to stop.
    ///
    /// # Errors
    /// [`OperatorError::NotStopped`]; a line that breaks.
    pub fn stop(&mut self) -> Result<Telemetry<f32>, OperatorError> {
        let stopped = self.heedless(|operator| {
            operator.send_stops()?;
            operator.telemetry()
        });
        self.drives = false;
        stopped.map(|told| told.telemetry)
    }

    /// The same without a look at the leg.
    pub(super) fn halt(&mut self) -> Result<(), OperatorError> {
        let halted = self.heedless(Self::send_stops);
        self.drives = false;
        halted
    }

    /// Does `work` heedless of Ctrl-C, and without being heard in between.
    pub(super) fn heedless<T>(
        &mut self,
        work: impl FnOnce(&mut Self) -> Result<T, OperatorError>,
    ) -> Result<T, OperatorError> {
        let interrupt = std::mem::take(&mut self.interrupt);
        let alive = std::mem::replace(&mut self.alive, false);
        let result = work(self);
        (self.interrupt, self.alive) = (interrupt, alive);
        result
    }

    fn send_stops(&mut self) -> Result<(), OperatorError> {
        let request = HostRequest::Command {
            host: self.host,
            command: Command::Stop,
        };
        let mut numbers = Vec::new();
        for _ in 0..STOPS {
            numbers.push(self.line.send_urgent(&request)?);
            let until = self.now() + STOP_TIME;
            match self.reply(&numbers, until)?.0 {
                Some(HostReply::Done) => return Ok(()),
                // It relaxes or starts: nothing of it follows commands.
                Some(HostReply::Refused(HostRefusal::Command(CommandRefusal::State(_)))) => {
                    return Ok(());
                }
                Some(HostReply::Refused(HostRefusal::NotIdentified)) => {
                    let hello = Hello {
                        schema: HOST_SCHEMA,
                    };
                    self.line.send(&HostRequest::Identify(hello))?;
                }
                // No room, or overtaken by another stop: again.
                _ => {}
            }
        }
        Err(OperatorError::NotStopped { name: self.name() })
    }

    /// Relaxes the tendons and waits until the drivers are off.
    ///
    /// # Errors
    /// As [`Self::command`]; [`OperatorError::Late`].
    pub fn disarm(&mut self) -> Result<(), OperatorError> {
        self.command(Command::Disarm)?;
        self.drives = false;
        self.until("relax", RELAX_TIME, |telemetry| {
            matches!(telemetry.state, State::Disarmed | State::Off)
        })?;
        Ok(())
    }

    /// Clears the faults whose cause is gone, and leaves the leg in hold if it was held.
    ///
    /// # Errors
    /// As [`Self::command`]; [`OperatorError::NotCleared`] where a cause is still there.
    pub fn clear(&mut self) -> Result<(), OperatorError> {
        self.drive(|operator| operator.command(Command::Clear))
    }
}
