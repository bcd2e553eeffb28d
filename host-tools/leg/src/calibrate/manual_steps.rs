//! What a calibration needs done by hand: weights hung, motors turned.

use leg_base::failure::Failure;
use leg_host::operator::Operator;
use leg_host::transport::emulated::EmulatedLine;
use std::io::BufRead;
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::time::Duration;

/// Time for one turn of an emulated motor, and for an emulated weight to come to rest.
const EMULATED_TIME: Duration = Duration::from_millis(1500);

/// How often a wait for the user checks whether it is interrupted.
const POLL_TIME: Duration = Duration::from_millis(50);

/// Who does the manual steps: the user on a real leg, the emulation on an emulated one.
pub(super) enum ManualSteps<'a> {
    User,
    Emulated(&'a EmulatedLine),
}

impl<'a> ManualSteps<'a> {
    pub(super) fn new(emulated: Option<&'a EmulatedLine>) -> Self {
        emulated.map_or(Self::User, Self::Emulated)
    }

    /// Hangs a weight on a load cell in the place of its tendon; the cell is counted from 0.
    pub(super) fn hang_weight(
        &self,
        operator: &mut Operator,
        cell: usize,
        [kg, newtons]: [f64; 2],
    ) -> Result<(), Failure> {
        let Self::Emulated(leg) = self else {
            let number = cell + 1;
            let step = format!("hang {kg} kg on load cell {number} in the place of its tendon");
            return ask(operator, &step);
        };
        leg.with_plant(|plant| plant.hang_on_cell(cell, Some(newtons)));
        Ok(operator.pause(EMULATED_TIME)?)
    }

    /// Turns a motor by one turn so that it reels its tendon in; the motor is counted from 0.
    pub(super) fn turn_motor(&self, operator: &mut Operator, motor: usize) -> Result<(), Failure> {
        let Self::Emulated(leg) = self else {
            let number = motor + 1;
            let step = format!("turn motor {number} by one turn, so that it reels its tendon in");
            return ask(operator, &step);
        };
        leg.with_plant(|plant| plant.turn_motor(motor, 1.0));
        Ok(operator.pause(EMULATED_TIME)?)
    }
}

/// Asks the user for a step and waits for the Enter key.
fn ask(operator: &mut Operator, step: &str) -> Result<(), Failure> {
    eprintln!("leg: {step}, then press Enter");
    let (sender, entered) = channel();
    std::thread::spawn(move || {
        let mut line = String::new();
        let read = std::io::stdin().lock().read_line(&mut line);
        // Nobody waits any more if the user has ended the calibration.
        let _ = sender.send(read.is_ok_and(|count| count > 0));
    });
    loop {
        match entered.recv_timeout(POLL_TIME) {
            Ok(true) => return Ok(()),
            Ok(false) | Err(RecvTimeoutError::Disconnected) => {
                let help = "answer on the terminal, or try with --on sim";
                return Err(Failure::refused("standard input has ended", help));
            }
            // Reads what arrives meanwhile, so that it does not pile up, and notices Ctrl-C.
            Err(RecvTimeoutError::Timeout) => operator.pause(Duration::ZERO)?,
        }
    }
}

/// Refuses a leg that drives its motors.
pub(super) fn require_drivers_off(
    operator: &mut Operator,
    asked: &'static str,
) -> Result<(), Failure> {
    if operator.telemetry()?.telemetry.state.driven() {
        return Err(Failure::refused(
            format!("the leg does not {asked} while its drivers are on"),
            "run `leg disarm` first",
        ));
    }
    Ok(())
}
