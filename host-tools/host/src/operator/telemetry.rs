//! Telemetry and sensors, asked for or streamed.

use super::request::done;
use super::{Operator, OperatorError, TelemetryStream};
use leg_firmware::host_link::{HOST_SCHEMA, Hello, HostReply, HostRequest, TelemetryReport};
use leg_firmware::sensors::SensorReading;
use leg_firmware::telemetry::Telemetry;
use std::time::Duration;

/// How often telemetry is asked for while the leg does something.
pub(super) const POLL_TIME: Duration = Duration::from_millis(20);

impl TelemetryStream {
    /// Keeps telemetry that came while something else was waited for.
    pub(super) fn keep(&mut self, report: TelemetryReport) {
        if self.every_ticks > 0 {
            self.received.push_back(report);
        }
    }

    /// Notes where another host introduces itself.
    pub(super) fn note_introduction(&mut self, reply: &HostReply) {
        self.other_host_came |= self.every_ticks > 0 && matches!(reply, HostReply::Identified(_));
    }
}

impl Operator {
    /// The telemetry of the last tick.
    pub fn telemetry(&mut self) -> Result<TelemetryReport, OperatorError> {
        let request = HostRequest::Telemetry;
        let report = self.ask("send telemetry", &request, |reply| match reply {
            HostReply::Telemetry(report) => Some(report),
            _ => None,
        })?;
        if let Some(watcher) = &mut self.watcher {
            watcher(&report.telemetry);
        }
        Ok(report)
    }

    /// The raw codes of the sensors in the last tick, and the zeros of the currents.
    pub fn sensors(&mut self) -> Result<SensorReading, OperatorError> {
        let request = HostRequest::Sensors;
        self.ask("report its sensors", &request, |reply| match reply {
            HostReply::Sensors(sensors) => Some(sensors),
            _ => None,
        })
    }

    /// Asks for telemetry every so many ticks, or for no more with 0.
    pub fn start_stream(&mut self, every_ticks: u16) -> Result<(), OperatorError> {
        self.ask("stream telemetry", &HostRequest::Stream(every_ticks), done)?;
        self.stream.every_ticks = every_ticks;
        Ok(())
    }

    /// Ends the stream, Ctrl-C or not: one that goes on takes room from the other hosts. By an introduction, which the other hosts
    /// see: those that stream ask for it again at once, before any of theirs is due.
    pub fn end_stream(&mut self) -> Result<(), OperatorError> {
        self.stream.every_ticks = 0;
        let schema = HOST_SCHEMA;
        self.uncancelled(|operator| {
            let hello = HostRequest::Identify(Hello { schema });
            operator.ask("end its telemetry", &hello, |reply| match reply {
                HostReply::Identified(_) => Some(()),
                _ => None,
            })
        })
    }

    /// The next telemetry of the stream; none if none comes in time. The stream is asked for again where another host's
    /// introduction has ended it.
    pub fn next_streamed(
        &mut self,
        timeout: Duration,
    ) -> Result<Option<TelemetryReport>, OperatorError> {
        let until = self.now() + timeout;
        loop {
            if let Some(report) = self.stream.received.pop_front() {
                return Ok(Some(report));
            }
            if self.cancel.is_set() {
                return Err(OperatorError::Cancelled);
            }
            if std::mem::take(&mut self.stream.other_host_came) {
                self.start_stream(self.stream.every_ticks)?;
                continue;
            }
            self.keep_alive()?;
            let wake = until.min(self.wake_at());
            match self.connection.receive(wake)? {
                Some((0, HostReply::Telemetry(report))) => return Ok(Some(report)),
                Some((_, reply)) => self.stream.note_introduction(&reply),
                None if self.now() >= until => return Ok(None),
                None => {}
            }
        }
    }

    /// Polls telemetry until `done`, by the time and the telemetry, says so or fails.
    pub(super) fn poll(
        &mut self,
        asked: &'static str,
        timeout: Duration,
        mut done: impl FnMut(Duration, &Telemetry<f32>) -> Result<bool, OperatorError>,
    ) -> Result<Telemetry<f32>, OperatorError> {
        let until = self.now() + timeout;
        loop {
            let telemetry = self.telemetry()?.telemetry;
            if done(self.now(), &telemetry)? {
                return Ok(telemetry);
            }
            if self.now() >= until {
                let telemetry = Box::new(telemetry);
                return Err(OperatorError::TimedOut(asked, timeout, telemetry));
            }
            self.pause(POLL_TIME)?;
        }
    }
}
