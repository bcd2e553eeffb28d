//! Jogging one motor of a disarmed leg.

use super::{Operator, OperatorError};
use leg_firmware::command::Command;
use leg_firmware::control::JOG_TIME_MAX_S;
use leg_firmware::host_link::{HostReply, HostRequest};
use leg_firmware::jog::{JogDemand, JogReport};
use leg_firmware::supervisor::State;
use leg_firmware::telemetry::Telemetry;
use std::time::Duration;

/// A fifth longer than the board lets any jog take.
const JOG_TIME: Duration = Duration::from_millis((1200.0 * JOG_TIME_MAX_S) as u64);

impl Operator {
    /// Turns a motor and waits until it is off again; what the board measured, and the leg after it, also where a fault ended
    /// it.
    ///
    /// # Errors
    /// As [`Self::drive`] and [`Self::command`]; [`OperatorError::WrongReply`] where the board knows of no jog.
    pub fn jog(
        &mut self,
        demand: &JogDemand,
    ) -> Result<(JogReport<f32>, Telemetry<f32>), OperatorError> {
        let asked = "jog a motor";
        self.settle_state(asked)?;
        let telemetry = self.drive(|operator| {
            operator.command(Command::Jog(*demand))?;
            operator.poll(asked, JOG_TIME, |_, telemetry| {
                Ok(telemetry.state != State::Jogging)
            })
        })?;
        let report = self.ask(asked, &HostRequest::JogReport, |reply| match reply {
            HostReply::Jog(report) => report,
            _ => None,
        })?;
        Ok((report, telemetry))
    }
}
