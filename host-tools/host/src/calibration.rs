//! Calibration by hand: what a leg has to be like for it, and how a load cell is read.

use crate::operator::{Operator, OperatorError};
use leg_base::failure::Failure;
pub use leg_rig::cell_fit::{CellFit, KnownWeight, fit, too_few_weights};
use std::time::Duration;

/// Readings that are averaged: noise of 13 codes (0.05 N of 250 N in 65 520 codes) falls to 0.4 codes.
const READINGS: u32 = 1000;

/// Time between two readings: at least a tick.
const READING_TIME: Duration = Duration::from_millis(1);

/// Refuses a leg that drives its motors; `asked` is what it does not do meanwhile.
///
/// # Errors
/// That [`Failure`]; the operator's.
pub fn require_drivers_off(operator: &mut Operator, asked: &str) -> Result<(), Failure> {
    if operator.telemetry()?.telemetry.state.driven() {
        return Err(Failure::refused(
            format!("the leg does not {asked} while its drivers are on"),
            "run `leg disarm` first",
        ));
    }
    Ok(())
}

/// Mean of the codes of a load cell, 0 to 2.
///
/// # Errors
/// The operator's.
pub fn mean_code(operator: &mut Operator, cell: usize) -> Result<f64, OperatorError> {
    let mut sum = 0.0;
    for _ in 0..READINGS {
        let codes = operator.sensors()?.codes.cell_codes;
        sum += codes.get(cell).copied().map_or(0.0, f64::from);
        operator.pause(READING_TIME)?;
    }
    Ok(sum / f64::from(READINGS))
}
