//! Reading the board's recorder.

use super::{Operator, OperatorError};
use leg_base::recorder_rows::{self, RecorderRow};
use leg_base::tick_time::seconds;
use leg_firmware::host_link::{HostRefusal, HostReply, HostRequest};
use leg_firmware::recorder::{
    RecorderReply, RecorderReport, RecorderRequest, RecorderState, Triple,
};
use leg_firmware::settings::Settings;
use std::time::Duration;

const ASKED: &str = "send what it has recorded";

/// From one look to the next whether a recording has ended.
const POLL_TIME: Duration = Duration::from_millis(20);

/// What a recorder held.
pub struct Scope {
    /// Its report, when it had ended.
    pub report: RecorderReport,
    /// The leg's settings then.
    pub settings: Settings,
    /// The oldest row first.
    pub rows: Vec<RecorderRow>,
}

impl Scope {
    /// The time that is held before the fault, and from it on, s. All of it is before where a host has ended the recording.
    #[must_use]
    pub fn sides_s(&self) -> [f64; 2] {
        let is_before = |row: &&RecorderRow| row.ticks_since_fault().is_none_or(|ticks| ticks < 0);
        let before = self.rows.iter().filter(is_before).count();
        [before, self.rows.len() - before].map(|ticks| seconds(ticks as u64))
    }
}

impl Operator {
    /// What the board's recorder holds: up to a fault that is latched and a little beyond, or else up to now. It goes on
    /// afterwards unless it is a fault's.
    ///
    /// # Errors
    /// [`OperatorError::NothingRecorded`] where the settings choose no signal, and those of any request.
    pub fn scope(&mut self) -> Result<Scope, OperatorError> {
        let mut report = self.recorder(RecorderRequest::Stop)?;
        while report.state == RecorderState::Triggered {
            self.pause(POLL_TIME)?;
            report = self.recorder(RecorderRequest::Report)?;
        }
        if report.state == RecorderState::Off {
            return Err(OperatorError::NothingRecorded);
        }
        let read = self.read_recording(&report);
        // Whatever became of the reading, the next fault is to be recorded. What was read is not lost with this request: without it
        // the board goes on some seconds later.
        if report.state == RecorderState::Stopped {
            let _ = self.uncancelled(|operator| operator.recorder(RecorderRequest::Restart));
        }
        let (settings, triples) = read?;
        let rows = recorder_rows::rows(&report, &triples, &settings);
        Ok(Scope {
            report,
            settings,
            rows,
        })
    }

    /// The settings and all triples, if both belong to the report: other settings begin another recording.
    fn read_recording(
        &mut self,
        report: &RecorderReport,
    ) -> Result<(Settings, Vec<Triple>), OperatorError> {
        let settings = self.settings()?;
        let triples = self.triples(report)?;
        if self.recorder(RecorderRequest::Report)? == *report {
            Ok((settings, triples))
        } else {
            Err(OperatorError::RecordingReplaced)
        }
    }

    fn triples(&mut self, report: &RecorderReport) -> Result<Vec<Triple>, OperatorError> {
        let count = usize::from(report.rows) * report.signals.len();
        let mut triples = Vec::with_capacity(count);
        while triples.len() < count {
            let request = RecorderRequest::Read(triples.len() as u16);
            let read = self.ask(
                ASKED,
                &HostRequest::Recorder(request),
                |reply| match reply {
                    HostReply::Recorder(RecorderReply::Triples(read)) => Some(read),
                    _ => None,
                },
            );
            let read = match read {
                // It has begun anew meanwhile: a fault came, or was cleared.
                Err(OperatorError::Refused(_, HostRefusal::Recording)) => {
                    return Err(OperatorError::RecordingReplaced);
                }
                read => read?,
            };
            if read.is_empty() {
                // So it has with other settings.
                return Err(OperatorError::RecordingReplaced);
            }
            triples.extend(read);
        }
        triples.truncate(count);
        Ok(triples)
    }

    fn recorder(&mut self, request: RecorderRequest) -> Result<RecorderReport, OperatorError> {
        self.ask(
            ASKED,
            &HostRequest::Recorder(request),
            |reply| match reply {
                HostReply::Recorder(RecorderReply::Report(report)) => Some(report),
                _ => None,
            },
        )
    }
}
