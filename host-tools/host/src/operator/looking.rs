//! Whether a leg has obeyed a command that it did not answer.

use super::{Operator, OperatorError};
use leg_firmware::command::Command;
use leg_firmware::supervisor::State;
use leg_firmware::telemetry::Telemetry;

/// What a look at the leg tells of a command.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Seen {
    /// It was obeyed.
    Obeyed,
    /// It was lost, and nothing has happened since that would make it mean something else now.
    Lost,
    /// It cannot be told.
    Unclear,
}

impl Operator {
    /// Looks at the leg after a command without an answer.
    pub(super) fn look(&mut self, command: &Command) -> Result<Seen, OperatorError> {
        let telemetry = self.telemetry()?.telemetry;
        Ok(seen(command, &telemetry))
    }
}

fn seen(command: &Command, telemetry: &Telemetry<f32>) -> Seen {
    let free = !telemetry.faults.without_limits().any();
    match (command, telemetry.state) {
        (Command::Arm, State::Active) | (Command::Home, State::Homing | State::Active) => {
            Seen::Obeyed
        }
        (Command::Arm | Command::Home, State::Disarmed) if free => Seen::Lost,
        (Command::Move { .. }, State::Active) if telemetry.moving => Seen::Obeyed,
        (Command::Move { x, y }, State::Active) if near(&telemetry.target, &[*x, *y]) => {
            Seen::Obeyed
        }
        (Command::Move { .. }, State::Active) => Seen::Lost,
        (Command::Clear, State::Active | State::RampingDown | State::Disarmed) if free => {
            Seen::Obeyed
        }
        _ => Seen::Unclear,
    }
}

/// Distance of two directions below which they are the same: 0.03°.
const NEAR: f32 = 5e-4;

/// Whether two directions are the same.
pub(super) fn near(a: &[f32; 2], b: &[f32; 2]) -> bool {
    a.iter().zip(b).all(|(a, b)| (a - b).abs() <= NEAR)
}
