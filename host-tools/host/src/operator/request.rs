//! Requests and their replies.

use super::{Operator, OperatorError};
use leg_firmware::command::{Command, CommandRefusal};
use leg_firmware::host_link::{HostRefusal, HostReply, HostRequest};
use std::time::Duration;

/// Wait for a reply before the request is taken for lost.
pub(super) const REPLY_TIME: Duration = Duration::from_millis(250);

/// How often a request is sent at most: for ten seconds, as this machine may be so busy that this program, or a leg which it
/// emulates, has to wait for seconds.
const ATTEMPTS: u32 = 40;

/// After how many it is said that the leg does not answer: three seconds.
const ATTEMPTS_LATE: u32 = 12;

/// Wait before a busy leg is asked again.
const BUSY_TIME: Duration = Duration::from_millis(50);

/// When a request that got no reply is sent again.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Repeat {
    /// Always: to do it twice is to do it once.
    Always,
    /// Only if the leg reported a frame that it could not read: to do it later than asked may be to do something else.
    IfLost,
}

/// Whether a request ends what the leg does.
fn ends(request: &HostRequest) -> bool {
    let HostRequest::Command { command, .. } = request else {
        return false;
    };
    matches!(command, Command::Stop | Command::Disarm)
}

/// Whether a reply may be that of a request. Hosts that share a line hear each other's replies, whose numbers may be alike.
const fn answers(request: &HostRequest, reply: &HostReply) -> bool {
    match reply {
        HostReply::Refused(HostRefusal::Command(_) | HostRefusal::OtherHost) => {
            matches!(request, HostRequest::Command { .. })
        }
        HostReply::Refused(_) => true,
        HostReply::Done => matches!(
            request,
            HostRequest::Command { .. }
                | HostRequest::Stream(_)
                | HostRequest::SetSettings(_)
                | HostRequest::SaveSettings
        ),
        HostReply::Identified(_) => matches!(request, HostRequest::Identify(_)),
        HostReply::Telemetry(_) => matches!(request, HostRequest::Telemetry),
        HostReply::Sensors(_) => matches!(request, HostRequest::Sensors),
        HostReply::Settings(_) => matches!(request, HostRequest::GetSettings),
        HostReply::Jog(_) => matches!(request, HostRequest::JogReport),
        HostReply::Recorder(_) => matches!(request, HostRequest::Recorder(_)),
    }
}

/// What came as the answer to a request.
#[derive(Debug, Default)]
pub(super) struct ReceivedReply {
    /// The reply; none if none came in time.
    pub reply: Option<HostReply>,
    /// Whether the leg could not read a frame meanwhile.
    lost: bool,
    /// Whether a reply of another kind had its number.
    other_kind: bool,
}

/// The reply to a request that has nothing to report.
pub(super) fn done(reply: HostReply) -> Option<()> {
    matches!(reply, HostReply::Done).then_some(())
}

impl Operator {
    /// Sends a harmless request until it is answered; `read` takes what is wanted out of the reply.
    pub(super) fn ask<T>(
        &mut self,
        asked: &'static str,
        request: &HostRequest,
        read: impl FnOnce(HostReply) -> Option<T>,
    ) -> Result<T, OperatorError> {
        let reply = self.exchange(asked, request, Repeat::Always, REPLY_TIME)?;
        read(reply).ok_or(OperatorError::WrongReply(asked))
    }

    /// Sends a request until it is answered, as often as that is harmless.
    pub(super) fn exchange(
        &mut self,
        asked: &'static str,
        request: &HostRequest,
        repeat: Repeat,
        reply_time: Duration,
    ) -> Result<HostReply, OperatorError> {
        let mut numbers = Vec::new();
        let (mut busy, mut other_kind) = (false, false);
        for attempt in 0..ATTEMPTS {
            if attempt == ATTEMPTS_LATE && !busy {
                let error = OperatorError::NoAnswer(self.name().into());
                (self.late_watcher)(&error);
            }
            numbers.push(self.connection.send(request)?);
            let until = self.now() + reply_time;
            let answer = self.answer(&numbers, request, until)?;
            other_kind |= answer.other_kind;
            busy = answer.reply == Some(HostReply::Refused(HostRefusal::Busy));
            match answer.reply {
                Some(_) if busy => self.pause(BUSY_TIME)?,
                Some(HostReply::Refused(refusal)) => {
                    return Err(self.connection.refused(asked, refusal));
                }
                Some(reply) => return Ok(reply),
                None if repeat == Repeat::Always || answer.lost => {}
                None => return Err(OperatorError::Unacknowledged(asked)),
            }
        }
        Err(if busy {
            self.connection.refused(asked, HostRefusal::Busy)
        } else if other_kind {
            OperatorError::WrongReply(asked)
        } else {
            OperatorError::NoAnswer(self.name().into())
        })
    }

    /// The answer to one of the requests with these numbers, which are the same one. One that ends what the leg does, a stop or a disarm, supersedes
    /// its earlier copies: what is said of those is no answer.
    pub(super) fn answer(
        &mut self,
        numbers: &[u16],
        request: &HostRequest,
        until: Duration,
    ) -> Result<ReceivedReply, OperatorError> {
        let mut answer = ReceivedReply::default();
        while let Some((number, reply)) = self.next_reply(until)? {
            if numbers.contains(&number) {
                let superseded =
                    HostReply::Refused(HostRefusal::Command(CommandRefusal::Superseded));
                if ends(request) && reply == superseded && numbers.last() != Some(&number) {
                    continue;
                }
                if answers(request, &reply) {
                    answer.reply = Some(reply);
                    return Ok(answer);
                }
                answer.other_kind = true;
            }
            let bad_frame = matches!(reply, HostReply::Refused(HostRefusal::BadFrame(_)));
            answer.lost |= number == 0 && bad_frame;
        }
        Ok(answer)
    }

    /// The next message that is no telemetry; none if none came in time. Sends keep-alives meanwhile.
    fn next_reply(&mut self, until: Duration) -> Result<Option<(u16, HostReply)>, OperatorError> {
        loop {
            if self.cancel.is_set() {
                return Err(OperatorError::Cancelled);
            }
            self.keep_alive()?;
            let wake = until.min(self.wake_at());
            match self.connection.receive(wake)? {
                Some((0, HostReply::Telemetry(report))) => self.stream.keep(report),
                Some(message) => {
                    self.stream.note_introduction(&message.1);
                    return Ok(Some(message));
                }
                None if self.now() >= until => return Ok(None),
                None => {}
            }
        }
    }

    /// Lets time pass.
    pub fn pause(&mut self, time: Duration) -> Result<(), OperatorError> {
        let until = self.now() + time;
        while self.next_reply(until)?.is_some() {}
        Ok(())
    }
}
