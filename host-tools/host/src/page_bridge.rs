//! A leg and the pages that show it.

use crate::cancel_flag::CancelFlag;
use crate::page_link::{PageLink, PageRequest};
use crate::transport::Transport;
use leg_firmware::command::Command;
use leg_firmware::frame::{self, MAX_FRAME};
use leg_firmware::host_link::{HOST_SCHEMA, Hello, HostId, HostRequest};
use leg_firmware::sensors::TICK_HZ;
use std::io::{self, ErrorKind};
use std::time::{Duration, Instant};

/// Ticks from one report to the next: 60 a second.
const REPORT_TICKS: u16 = TICK_HZ / 60;

/// Time after which a leg that sends nothing is asked again: its board may have started anew.
const SILENCE_TIME: Duration = Duration::from_secs(1);

/// Longest wait for bytes, so that those of the pages are passed on.
const WAIT_TIME: Duration = Duration::from_millis(5);

/// Number of the requests of this program itself. Pages begin theirs where they like, and look at no answer but their own.
const NUMBER: u16 = u16::MAX;

/// Passes on what leg and pages send each other, until the flag is set. The leg reports by itself.
///
/// # Errors
/// A line that has ended; the pages are told.
pub fn run(
    transport: &mut dyn Transport,
    pages: &PageLink,
    host: HostId,
    cancel: &CancelFlag,
) -> io::Result<()> {
    let passed = pass(transport, pages, host, cancel);
    if let Err(error) = &passed {
        pages.send_lost(error.to_string());
    }
    passed
}

fn pass(
    transport: &mut dyn Transport,
    pages: &PageLink,
    host: HostId,
    cancel: &CancelFlag,
) -> io::Result<()> {
    let mut asked: Option<Instant> = None;
    while !cancel.is_set() {
        if asked.is_none_or(|asked| asked.elapsed() > SILENCE_TIME) {
            let schema = HOST_SCHEMA;
            send(transport, &HostRequest::Identify(Hello { schema }))?;
            send(transport, &HostRequest::Stream(REPORT_TICKS))?;
            asked = Some(Instant::now());
        }
        let mut bytes = [0; MAX_FRAME];
        match transport.receive(&mut bytes, WAIT_TIME) {
            Ok(0) => return Err(ErrorKind::UnexpectedEof.into()),
            Ok(count) => {
                pages.send(bytes.get(..count).unwrap_or_default());
                asked = Some(Instant::now());
            }
            Err(error) if [ErrorKind::TimedOut, ErrorKind::Interrupted].contains(&error.kind()) => {
            }
            Err(error) => return Err(error),
        }
        while let Some(request) = pages.request() {
            match request {
                PageRequest::Frames(bytes) => transport.send(&bytes)?,
                PageRequest::Stop => {
                    let command = Command::Stop;
                    let stop = HostRequest::Command { host, command };
                    transport.send_urgent(framed(&stop, &mut [0; MAX_FRAME])?)?;
                }
            }
        }
    }
    Ok(())
}

fn send(transport: &mut dyn Transport, request: &HostRequest) -> io::Result<()> {
    transport.send(framed(request, &mut [0; MAX_FRAME])?)
}

fn framed<'a>(request: &HostRequest, out: &'a mut [u8; MAX_FRAME]) -> io::Result<&'a [u8]> {
    frame::encode(NUMBER, request, out).map_err(|_| ErrorKind::InvalidInput.into())
}
