//! A leg and the pages that show it.

use super::link::{PageHello, PageLink};
use leg_firmware::command::{Command, CommandRefusal};
use leg_firmware::frame::{self, Decoder, MAX_FRAME};
use leg_firmware::host_link::{HOST_SCHEMA, Hello, HostId, HostRefusal, HostReply, HostRequest};
use leg_firmware::sensors::TICK_HZ;
use leg_host::cancel_flag::CancelFlag;
use leg_host::transport::Transport;
use leg_rig::settings_text;
use std::io::{self, ErrorKind};
use std::time::{Duration, Instant};

/// Ticks from one report to the next: 60 a second.
const REPORT_TICKS: u16 = TICK_HZ / 60;

/// Time without a report after which the leg is asked again: its board may have started anew, or another host ended the reports.
const SILENCE_TIME: Duration = Duration::from_secs(1);

/// From one stop to the next, until it is answered.
const STOP_TIME: Duration = Duration::from_millis(50);

/// Longest wait for bytes, so that those of the pages are passed on.
const WAIT_TIME: Duration = Duration::from_millis(5);

/// Messages of pages that are passed on at once.
const FRAMES_A_TURN: usize = 8;

/// Number of what is asked without interest in the answer: as of what the leg sends by itself.
const NO_NUMBER: u16 = 0;

/// Number of a stop. Pages take lower ones.
const STOP_NUMBER: u16 = u16::MAX;

/// Passes on what leg and pages send each other, until the flag is set. The leg reports by itself; `hello` is what pages are told of
/// it first, and follows what a page sets it to.
///
/// # Errors
/// A line that has ended; the pages are told.
pub fn run(
    transport: &mut dyn Transport,
    pages: &PageLink,
    hello: PageHello,
    host: HostId,
    cancel: &CancelFlag,
) -> io::Result<()> {
    let mut bridge = Bridge {
        transport,
        pages,
        hello,
        host,
        decoder: Decoder::new(),
        heard: None,
        stopped: None,
    };
    let passed = loop {
        match bridge.turn() {
            Ok(()) if cancel.is_set() => break bridge.send(NO_NUMBER, &HostRequest::Stream(0)),
            Ok(()) => {}
            Err(error) => break Err(error),
        }
    };
    let why = passed.as_ref().err().map(ToString::to_string);
    pages.close(why.as_deref().unwrap_or("`leg ui` has ended"));
    passed
}

struct Bridge<'a> {
    transport: &'a mut dyn Transport,
    pages: &'a PageLink,
    hello: PageHello,
    host: HostId,
    decoder: Decoder,
    /// When the leg last reported, or was asked to; none if it has to be asked.
    heard: Option<Instant>,
    /// When it was last told to stop; none once it has answered.
    stopped: Option<Instant>,
}

impl Bridge<'_> {
    fn turn(&mut self) -> io::Result<()> {
        if self
            .heard
            .is_none_or(|heard| heard.elapsed() > SILENCE_TIME)
        {
            let schema = HOST_SCHEMA;
            self.send(NO_NUMBER, &HostRequest::Identify(Hello { schema }))?;
            self.send(NO_NUMBER, &HostRequest::Stream(REPORT_TICKS))?;
            self.heard = Some(Instant::now());
        }
        self.receive()?;
        for _ in 0..FRAMES_A_TURN {
            self.stop()?;
            // A leg that is to stop gets no other commands.
            if self.stopped.is_some() {
                let _ = self.pages.next_frames();
            } else if let Some(frames) = self.pages.next_frames() {
                unless_lost(self.transport.send(&frames))?;
            }
        }
        Ok(())
    }

    /// Passes a page's stop on, and repeats it until the leg has answered.
    fn stop(&mut self) -> io::Result<()> {
        let again = self
            .stopped
            .is_some_and(|stopped| stopped.elapsed() > STOP_TIME);
        if !self.pages.take_stop() && !again {
            return Ok(());
        }
        self.stopped = Some(Instant::now());
        let stop = HostRequest::Command {
            host: self.host,
            command: Command::Stop,
        };
        unless_lost(
            self.transport
                .send_urgent(framed(STOP_NUMBER, &stop, &mut [0; MAX_FRAME])?),
        )
    }

    fn receive(&mut self) -> io::Result<()> {
        let mut bytes = [0; MAX_FRAME];
        match self.transport.receive(&mut bytes, WAIT_TIME) {
            Ok(0) => Err(ErrorKind::UnexpectedEof.into()),
            Ok(count) => {
                let bytes = bytes.get(..count).unwrap_or_default();
                self.pages.send(bytes);
                self.listen(bytes);
                Ok(())
            }
            Err(error) if error.kind() == ErrorKind::Interrupted => Ok(()),
            received => unless_lost(received.map(drop)),
        }
    }

    fn listen(&mut self, bytes: &[u8]) {
        for &byte in bytes {
            let Some(Ok(frame)) = self.decoder.push(byte) else {
                continue;
            };
            match (frame.sequence, frame.message()) {
                (_, Some(HostReply::Telemetry(_))) => self.heard = Some(Instant::now()),
                (_, Some(HostReply::Settings(settings))) => {
                    self.hello.rig = settings_text::rig_file(&settings);
                    self.pages.introduce(self.hello.clone());
                }
                // A board that has started anew: it is asked at once.
                (_, Some(HostReply::Refused(HostRefusal::NotIdentified))) => self.heard = None,
                // Where the state does not allow it, nothing of the leg follows commands.
                (
                    STOP_NUMBER,
                    Some(
                        HostReply::Done
                        | HostReply::Refused(HostRefusal::Command(CommandRefusal::State(_))),
                    ),
                ) => self.stopped = None,
                _ => {}
            }
        }
    }

    fn send(&mut self, number: u16, request: &HostRequest) -> io::Result<()> {
        unless_lost(
            self.transport
                .send(framed(number, request, &mut [0; MAX_FRAME])?),
        )
    }
}

/// What a line did not take in time, or cannot carry, is lost, and nothing else; so is time in which nothing came.
fn unless_lost(sent: io::Result<()>) -> io::Result<()> {
    match sent {
        Err(error) if [ErrorKind::TimedOut, ErrorKind::InvalidInput].contains(&error.kind()) => {
            Ok(())
        }
        sent => sent,
    }
}

fn framed<'a>(
    number: u16,
    request: &HostRequest,
    out: &'a mut [u8; MAX_FRAME],
) -> io::Result<&'a [u8]> {
    frame::encode(number, request, out).map_err(|_| ErrorKind::InvalidInput.into())
}

#[cfg(test)]
mod tests;
