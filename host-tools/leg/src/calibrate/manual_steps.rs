//! What a calibration needs done by hand: weights hung, motors turned.

use crate::connection::LegConnection;
use crate::output::note;
use leg_base::failure::Failure;
use leg_base::text_input::{self, Line};
use leg_host::operator::Operator;
use leg_sim::plant::Plant;
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::time::Duration;

/// Time for one turn of an emulated motor, and for an emulated weight to come to rest.
const EMULATED_TIME: Duration = Duration::from_millis(1500);

/// How often a wait for the user checks whether it is interrupted.
const POLL_TIME: Duration = Duration::from_millis(50);

/// Has a step done: by the user on a real leg, by the emulation on an emulated one.
pub(super) fn manual_step(
    connection: &mut LegConnection,
    step: &str,
    emulated: impl FnOnce(&mut Plant),
) -> Result<(), Failure> {
    let Some(leg) = &connection.emulated else {
        return ask(&mut connection.operator, step);
    };
    leg.with_plant(emulated);
    Ok(connection.operator.pause(EMULATED_TIME)?)
}

/// Asks the user for a step before a real leg moves; an emulated one does not wait.
pub(crate) fn confirm(connection: &mut LegConnection, step: &str) -> Result<(), Failure> {
    match connection.emulated {
        Some(_) => Ok(()),
        None => ask(&mut connection.operator, step),
    }
}

/// Asks the user for a step and waits for the Enter key alone: whoever writes anything does not agree.
fn ask(operator: &mut Operator, step: &str) -> Result<(), Failure> {
    note(&format!("leg: {step}, then press Enter"));
    let (sender, entered) = channel();
    std::thread::spawn(move || {
        let line = text_input::next_line(&mut std::io::stdin().lock());
        // Nobody waits any more if the user has ended the calibration.
        let _ = sender.send(line.ok().flatten());
    });
    loop {
        match entered.recv_timeout(POLL_TIME) {
            Ok(Some(Line::Whole(line))) if line.trim_ascii().is_empty() => return Ok(()),
            Ok(Some(_)) => {
                return Err(Failure::refused(
                    "declined: nothing was moved for this step",
                    "press Enter alone to go on",
                ));
            }
            Ok(None) | Err(RecvTimeoutError::Disconnected) => {
                let help = "answer on the terminal, or try with --on sim";
                return Err(Failure::refused("standard input has ended", help));
            }
            // Reads what arrives meanwhile, so that it does not pile up, and notices Ctrl-C.
            Err(RecvTimeoutError::Timeout) => operator.pause(Duration::ZERO)?,
        }
    }
}
