//! Requests and their replies.

use super::looking::Seen;
use super::{Operator, OperatorError};
use leg_firmware::command::{Command, CommandRefusal};
use leg_firmware::host_link::{HostRefusal, HostReply, HostRequest, Told};
use leg_firmware::sensors::Sensors;
use std::time::Duration;

/// Wait for a reply before the request is taken for lost.
const REPLY_TIME: Duration = Duration::from_millis(250);

/// How often a request is sent at most: for three seconds, as the machine may have much else to do.
const ATTEMPTS: u32 = 12;

/// How often a command is sent after a look at the leg.
const LOOKS: u32 = 3;

/// Wait before a busy leg is asked again.
const BUSY_TIME: Duration = Duration::from_millis(50);

/// When a request that got no reply is sent again.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Repeat {
    /// Always: to do it twice is to do it once.
    Always,
    /// Only if the leg said that it could not read a frame: to do it later than asked may be to do something else.
    IfLost,
}

impl Operator {
    /// Commands the leg and waits until a tick has obeyed.
    ///
    /// # Errors
    /// [`OperatorError::Refused`], [`OperatorError::Faulted`], [`OperatorError::NotCleared`] or
    /// [`OperatorError::Unanswered`]; a line that breaks; [`OperatorError::Interrupted`].
    pub fn command(&mut self, command: Command) -> Result<(), OperatorError> {
        let asked = name(&command);
        let request = HostRequest::Command {
            host: self.host,
            command,
        };
        let ends = matches!(command, Command::Stop | Command::Disarm);
        let before = self.drives;
        // From the moment that it is sent the leg may obey.
        self.drives |= !ends;
        match self.ask_and_look(asked, &request, &command) {
            Ok(()) => Ok(()),
            Err(error) => {
                if let OperatorError::Refused { refusal, .. } = &error {
                    self.drives = before;
                    if *refusal == HostRefusal::Command(CommandRefusal::Faulted) {
                        let faults = self.telemetry()?.telemetry.faults.without_limits();
                        return Err(match command {
                            Command::Clear => OperatorError::NotCleared { faults },
                            _ => OperatorError::Faulted { asked, faults },
                        });
                    }
                }
                Err(error)
            }
        }
    }

    /// Sends a command. One without an answer that must not be done later than asked is sent once more only after a look at
    /// the leg.
    fn ask_and_look(
        &mut self,
        asked: &'static str,
        request: &HostRequest,
        command: &Command,
    ) -> Result<(), OperatorError> {
        for _ in 0..LOOKS {
            self.spoke_at = self.now();
            match self.ask(asked, request, repeat(command)) {
                Ok(HostReply::Done) => return Ok(()),
                Ok(_) => return Err(OperatorError::WrongReply { asked }),
                Err(OperatorError::Unanswered { .. }) => match self.look(command)? {
                    Seen::Obeyed => return Ok(()),
                    Seen::Lost => {}
                    Seen::Unclear => break,
                },
                Err(error) => return Err(error),
            }
        }
        Err(OperatorError::Unanswered { asked })
    }

    /// What the leg tells of itself now.
    ///
    /// # Errors
    /// As [`Self::command`].
    pub fn telemetry(&mut self) -> Result<Told, OperatorError> {
        let asked = "tell of itself";
        let told = match self.ask(asked, &HostRequest::Telemetry, Repeat::Always)? {
            HostReply::Telemetry(told) => told,
            _ => return Err(OperatorError::WrongReply { asked }),
        };
        if let Some(watcher) = &mut self.watcher {
            watcher(&told.telemetry);
        }
        Ok(told)
    }

    /// The raw codes of the sensors in the last tick.
    ///
    /// # Errors
    /// As [`Self::command`].
    pub fn sensors(&mut self) -> Result<Sensors, OperatorError> {
        let asked = "tell what its sensors read";
        match self.ask(asked, &HostRequest::Sensors, Repeat::Always)? {
            HostReply::Sensors(sensors) => Ok(sensors),
            _ => Err(OperatorError::WrongReply { asked }),
        }
    }

    /// Sends a request until it is answered, as often as that is harmless.
    pub(super) fn ask(
        &mut self,
        asked: &'static str,
        request: &HostRequest,
        repeat: Repeat,
    ) -> Result<HostReply, OperatorError> {
        self.ask_within(asked, request, repeat, REPLY_TIME)
    }

    pub(super) fn ask_within(
        &mut self,
        asked: &'static str,
        request: &HostRequest,
        repeat: Repeat,
        reply_time: Duration,
    ) -> Result<HostReply, OperatorError> {
        let mut numbers = Vec::new();
        let mut busy = false;
        for _ in 0..ATTEMPTS {
            numbers.push(self.line.send(request)?);
            let until = self.now() + reply_time;
            let (reply, lost) = self.reply(&numbers, until)?;
            busy = reply == Some(HostReply::Refused(HostRefusal::Busy));
            match reply {
                Some(_) if busy => self.pause(BUSY_TIME)?,
                Some(HostReply::Refused(refusal)) => {
                    return Err(self.line.refused(asked, refusal));
                }
                Some(reply) => return Ok(reply),
                None if repeat == Repeat::Always || lost => {}
                None => return Err(OperatorError::Unanswered { asked }),
            }
        }
        Err(if busy {
            self.line.refused(asked, HostRefusal::Busy)
        } else {
            OperatorError::Silent { name: self.name() }
        })
    }

    /// The reply to one of these requests, and whether the leg could not read a frame meanwhile.
    pub(super) fn reply(
        &mut self,
        numbers: &[u16],
        until: Duration,
    ) -> Result<(Option<HostReply>, bool), OperatorError> {
        let mut lost = false;
        while let Some((number, reply)) = self.hear(until)? {
            if numbers.contains(&number) {
                return Ok((Some(reply), lost));
            }
            lost |= matches!(
                (number, reply),
                (0, HostReply::Refused(HostRefusal::BadFrame(_)))
            );
        }
        Ok((None, lost))
    }

    /// The next message that is no telemetry; none if none came in time. Keeps the leg from missing the host.
    pub(super) fn hear(
        &mut self,
        until: Duration,
    ) -> Result<Option<(u16, HostReply)>, OperatorError> {
        loop {
            if self.interrupt.raised() {
                return Err(OperatorError::Interrupted);
            }
            self.keep_alive()?;
            let wake = until.min(self.wake_at());
            match self.line.receive(wake)? {
                Some((0, HostReply::Telemetry(told))) => self.overhear(told),
                Some(message) => {
                    self.overhear_reply(&message.1);
                    return Ok(Some(message));
                }
                None if self.now() >= until => return Ok(None),
                None => {}
            }
        }
    }

    /// Lets time pass.
    ///
    /// # Errors
    /// A line that breaks; [`OperatorError::Interrupted`].
    pub fn pause(&mut self, time: Duration) -> Result<(), OperatorError> {
        let until = self.now() + time;
        while self.hear(until)?.is_some() {}
        Ok(())
    }
}

/// What a command asks of the leg.
const fn name(command: &Command) -> &'static str {
    match command {
        Command::KeepAlive => "hear the host",
        Command::Arm => "arm",
        Command::Home => "home",
        Command::Move { .. } => "move",
        Command::Hold => "come to rest",
        Command::Pretension(_) => "change its pretension",
        Command::Stiffness { .. } => "change its stiffness",
        Command::Compensation(_) => "change its compensation",
        Command::Stop => "stop",
        Command::Disarm => "disarm",
        Command::Clear => "clear its faults",
    }
}

const fn repeat(command: &Command) -> Repeat {
    match command {
        Command::Arm | Command::Home | Command::Move { .. } | Command::Clear => Repeat::IfLost,
        _ => Repeat::Always,
    }
}
