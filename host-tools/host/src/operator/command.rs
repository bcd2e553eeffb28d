//! Commands: sent, and after no answer sent again only where the leg's telemetry shows that they were lost.

use super::request::{REPLY_TIME, Repeat};
use super::{Operator, OperatorError};
use leg_base::settling::same_direction;
use leg_firmware::command::{Command, CommandRefusal};
use leg_firmware::host_link::{HostRefusal, HostReply, HostRequest};
use leg_firmware::supervisor::State;
use leg_firmware::telemetry::Telemetry;

/// How often a command is sent at most, with telemetry read after each.
const COMMAND_ATTEMPTS: u32 = 3;

/// What telemetry shows of a command that got no answer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Evidence {
    /// It was obeyed.
    Obeyed,
    /// It was lost, and nothing has happened since that would make it mean something else now.
    Lost,
    /// Neither is certain.
    Unclear,
}

impl Operator {
    /// Commands the leg and waits until a tick has obeyed.
    ///
    /// # Errors
    /// [`OperatorError::Refused`], [`OperatorError::Faulted`], [`OperatorError::NotCleared`] or
    /// [`OperatorError::Unacknowledged`]; a connection that fails; [`OperatorError::Cancelled`].
    pub fn command(&mut self, command: Command) -> Result<(), OperatorError> {
        let ends = matches!(command, Command::Stop | Command::Disarm);
        let before = self.drives;
        // From the moment that it is sent the leg may obey.
        self.drives |= !ends;
        let result = self.send_command(&command);
        if let Err(OperatorError::Refused(asked, refusal)) = &result {
            self.drives = before;
            if *refusal == HostRefusal::Command(CommandRefusal::Faulted) {
                let faults = self.telemetry()?.telemetry.faults.stopping();
                return Err(match command {
                    Command::Clear => OperatorError::NotCleared(faults),
                    _ => OperatorError::Faulted(asked, faults),
                });
            }
        }
        result
    }

    fn send_command(&mut self, command: &Command) -> Result<(), OperatorError> {
        let asked = name(command);
        let request = HostRequest::Command {
            host: self.host,
            command: *command,
        };
        for _ in 0..COMMAND_ATTEMPTS {
            self.commanded_at = self.now();
            match self.exchange(asked, &request, repeat(command), REPLY_TIME) {
                Ok(HostReply::Done) => return Ok(()),
                Ok(_) => return Err(OperatorError::WrongReply(asked)),
                Err(OperatorError::Unacknowledged(_)) => {
                    match evidence(command, &self.telemetry()?.telemetry) {
                        Evidence::Obeyed => return Ok(()),
                        Evidence::Lost => {}
                        Evidence::Unclear => break,
                    }
                }
                Err(error) => return Err(error),
            }
        }
        Err(OperatorError::Unacknowledged(asked))
    }
}

fn evidence(command: &Command, telemetry: &Telemetry<f32>) -> Evidence {
    let no_fault = !telemetry.faults.stopping().any();
    match (command, telemetry.state) {
        (Command::Arm, State::Active)
        | (Command::Home, State::Homing | State::Active)
        | (Command::Jog(_), State::Jogging) => Evidence::Obeyed,
        (Command::Clear, State::Active | State::RampingDown | State::Disarmed) if no_fault => {
            Evidence::Obeyed
        }
        (Command::Clear, State::KeepingStation) => Evidence::Obeyed,
        (Command::KeepStation, State::KeepingStation | State::Held) if no_fault => Evidence::Obeyed,
        (Command::Arm, State::KeepingStation) | (Command::KeepStation, State::Active) => {
            Evidence::Lost
        }
        (Command::Arm | Command::Home, State::Disarmed) if no_fault => Evidence::Lost,
        (Command::Move { x, y }, State::Active)
            if telemetry.moving || same_direction(&telemetry.target, &[*x, *y]) =>
        {
            Evidence::Obeyed
        }
        (Command::Move { .. }, State::Active) => Evidence::Lost,
        _ => Evidence::Unclear,
    }
}

/// What a command asks of the leg.
pub(super) const fn name(command: &Command) -> &'static str {
    match command {
        Command::KeepAlive => "hear the host",
        Command::Arm => "arm",
        Command::Home => "home",
        Command::Move { .. } => "move",
        Command::Follow(_) => "follow set-points",
        Command::Hold => "come to rest",
        Command::Pretension(_) => "change its pretension",
        Command::Stiffness { .. } => "change its stiffness",
        Command::Compensation(_) => "change its compensation",
        Command::Stop => "stop",
        Command::Disarm => "disarm",
        Command::Clear => "clear its faults",
        Command::Jog(_) => "jog a motor",
        Command::KeepStation => "keep station",
    }
}

const fn repeat(command: &Command) -> Repeat {
    match command {
        Command::Arm | Command::Home | Command::Jog(_) | Command::Move { .. } | Command::Clear => {
            Repeat::IfLost
        }
        _ => Repeat::Always,
    }
}
