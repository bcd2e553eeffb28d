//! Whoever hangs weights and turns motors: the user, or the emulation of one.

use leg_base::failure::Failure;
use leg_host::operator::Operator;
use leg_host::transport::emulated::Emulated;
use std::io::BufRead;
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::time::Duration;

/// How long an emulated hand takes for one turn, and for a weight to come to rest.
const EMULATED_TIME: Duration = Duration::from_millis(1500);

/// How often a wait for the user looks whether it shall end.
const LOOK_TIME: Duration = Duration::from_millis(50);

/// Who does what the calibration asks for.
pub(super) enum Hand<'a> {
    User,
    Emulated(&'a Emulated),
}

impl<'a> Hand<'a> {
    /// The user's where the leg is a real one.
    pub(super) fn of(emulated: Option<&'a Emulated>) -> Self {
        emulated.map_or(Self::User, Self::Emulated)
    }

    /// Hangs a weight on a load cell in the place of its tendon; the cell is counted from 0.
    pub(super) fn hang(
        &self,
        operator: &mut Operator,
        cell: usize,
        [kg, newtons]: [f64; 2],
    ) -> Result<(), Failure> {
        match self {
            Self::User => ask(
                operator,
                &format!(
                    "hang {kg} kg on load cell {} in the place of its tendon",
                    cell + 1
                ),
            ),
            Self::Emulated(leg) => {
                leg.touch(|plant| plant.hang_on_cell(cell, Some(newtons)));
                Ok(operator.pause(EMULATED_TIME)?)
            }
        }
    }

    /// Turns a motor by one turn so that it pulls its tendon in; the motor is counted from 0.
    pub(super) fn turn(&self, operator: &mut Operator, motor: usize) -> Result<(), Failure> {
        match self {
            Self::User => ask(
                operator,
                &format!(
                    "turn motor {} once, so that its tendon is pulled in",
                    motor + 1
                ),
            ),
            Self::Emulated(leg) => {
                leg.touch(|plant| plant.turn_motor(motor, 1.0));
                Ok(operator.pause(EMULATED_TIME)?)
            }
        }
    }
}

/// Asks the user for something and waits for the Enter key.
fn ask(operator: &mut Operator, what: &str) -> Result<(), Failure> {
    eprintln!("leg: {what}, then press Enter");
    let (sender, entered) = channel();
    std::thread::spawn(move || {
        let mut line = String::new();
        let read = std::io::stdin().lock().read_line(&mut line);
        // Nobody waits any more if the user has ended the calibration.
        let _ = sender.send(read.is_ok_and(|count| count > 0));
    });
    loop {
        match entered.recv_timeout(LOOK_TIME) {
            Ok(true) => return Ok(()),
            Ok(false) | Err(RecvTimeoutError::Disconnected) => {
                let help = "answer on the terminal, or try with --on sim";
                return Err(Failure::refused("standard input has ended", help));
            }
            // What comes meanwhile is heard, so that it does not pile up; Ctrl-C is, too.
            Err(RecvTimeoutError::Timeout) => operator.pause(Duration::ZERO)?,
        }
    }
}

/// Refuses a leg that drives its motors.
pub(super) fn drivers_off(operator: &mut Operator, asked: &'static str) -> Result<(), Failure> {
    if operator.telemetry()?.telemetry.state.driven() {
        return Err(Failure::refused(
            format!("the leg does not {asked} while its drivers are on"),
            "run `leg disarm` first",
        ));
    }
    Ok(())
}
