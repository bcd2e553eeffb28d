//! Reading the board's recorder.

use super::{Operator, OperatorError};
use leg_base::recorder_rows::{self, RecorderRow};
use leg_base::tick_time::seconds;
use leg_firmware::host_link::{HostRefusal, HostReply, HostRequest};
use leg_firmware::recorder::{RecorderReply, RecorderReport, RecorderRequest, RecorderState};
use leg_firmware::settings::Settings;
use std::time::Duration;

const ASKED: &str = "send what it has recorded";

/// From one look to the next whether a recording has ended.
const POLL_TIME: Duration = Duration::from_millis(20);

/// What a recorder held.
pub struct Scope {
    /// Its report, when it had ended.
    pub report: RecorderReport,
    /// The oldest row first.
    pub rows: Vec<RecorderRow>,
}

impl Scope {
    /// The time that is held before the fault, and from it on, s. All of it is before where a host has ended the recording.
    #[must_use]
    pub fn sides_s(&self) -> [f64; 2] {
        let is_before = |row: &&RecorderRow| {
            row.fault_tick
                .is_none_or(|fault| (row.tick.wrapping_sub(fault) as i32) < 0)
        };
        let before = self.rows.iter().filter(is_before).count();
        [before, self.rows.len() - before].map(|ticks| seconds(ticks as u64))
    }
}

impl Operator {
    /// What the board's recorder holds: up to a fault that is latched and a little beyond, or else up to now. It goes on
    /// afterwards unless it is a fault's. `settings` are those of the leg.
    ///
    /// # Errors
    /// [`OperatorError::NothingRecorded`] where the settings choose no signal, and those of any request.
    pub fn scope(&mut self, settings: &Settings) -> Result<Scope, OperatorError> {
        let mut report = self.recorder(RecorderRequest::Stop)?;
        while report.state == RecorderState::Triggered {
            self.pause(POLL_TIME)?;
            report = self.recorder(RecorderRequest::Report)?;
        }
        if report.state == RecorderState::Off {
            return Err(OperatorError::NothingRecorded);
        }
        let triples = self.triples(&report);
        // Whatever became of the reading, the next fault is to be recorded.
        if report.state == RecorderState::Stopped {
            self.uncancelled(|operator| operator.recorder(RecorderRequest::Restart))?;
        }
        let rows = recorder_rows::rows(&report, &triples?, settings);
        Ok(Scope { report, rows })
    }

    fn triples(&mut self, report: &RecorderReport) -> Result<Vec<[u16; 3]>, OperatorError> {
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
        let after = self.recorder(RecorderRequest::Report)?;
        if after == *report {
            Ok(triples)
        } else {
            Err(OperatorError::RecordingReplaced)
        }
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
