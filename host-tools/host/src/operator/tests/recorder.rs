//! Reading the recorder while something happens to the leg or its line.

use super::{BadLine, hanging_leg, operator};
use crate::cancel_flag::CancelFlag;
use crate::operator::{OperatorError, Scope};
use crate::transport::Transport;
use crate::transport::emulated::{EmulatedLine, EmulatedTransport};
use leg_firmware::frame::Decoder;
use leg_firmware::host_link::HostRequest;
use leg_firmware::recorder::RecorderRequest;
use std::io;
use std::time::Duration;

fn request(frame: &[u8]) -> Option<HostRequest> {
    let mut decoder = Decoder::new();
    let messages = frame
        .iter()
        .filter_map(|byte| decoder.push(*byte)?.ok()?.message());
    messages.last()
}

/// What is read of a leg to which something happens before a request to its recorder is sent.
fn scope(
    before: impl Fn(&EmulatedLine, RecorderRequest) -> io::Result<()> + 'static,
) -> Result<Scope, OperatorError> {
    let leg = hanging_leg();
    let line = leg.clone();
    let send = move |inner: &mut EmulatedTransport, bytes: &[u8]| {
        if let Some(HostRequest::Recorder(request)) = request(bytes) {
            before(&line, request)?;
            // Ticks in which it shows.
            let _ = inner.receive(&mut [0; 99], Duration::from_millis(1));
        }
        inner.send(bytes)
    };
    let mut operator = operator(BadLine::new(&leg, send, |_| ()), &CancelFlag::default());
    operator.pause(Duration::from_millis(250))?;
    operator.scope()
}

#[test]
fn what_was_recorded_is_read_with_the_settings() {
    let scope = scope(|_, _| Ok(())).unwrap();
    assert_eq!((scope.rows.len(), scope.report.fault), (1600, None));
    assert_eq!(scope.settings.recorded, scope.report.signals);
}

/// The rows that were read belong to no recording any more.
#[test]
fn a_fault_while_it_is_read_replaces_the_recording() {
    for place in [0, 4000] {
        let result = scope(move |leg, request| {
            if matches!(request, RecorderRequest::Read(first) if first >= place) {
                leg.with_plant(|plant| plant.press_emergency_stop(true));
            }
            Ok(())
        });
        error_of!(result, OperatorError::RecordingReplaced);
    }
}

/// The board goes on by itself.
#[test]
fn rows_are_there_whether_or_not_the_recording_goes_on() {
    let scope = scope(|_, request| match request {
        RecorderRequest::Restart => Err(io::ErrorKind::BrokenPipe.into()),
        _ => Ok(()),
    });
    assert_eq!(scope.unwrap().rows.len(), 1600);
}
