//! What a command tells of the leg when it ends.

use super::print;
use crate::failure::Failure;
use crate::leg_report::{LegReport, rows};
use crate::operator::Operator;
use serde::Serialize;

/// Asks the leg what it is doing and prints it.
pub(super) fn tell(operator: &mut Operator, json: bool) -> Result<(), Failure> {
    let telemetry = operator.telemetry()?.telemetry;
    print(&if json {
        to_line(&LegReport::of(&telemetry))?
    } else {
        rows(&telemetry)
    })
}

/// One line of JSON.
pub(super) fn to_line<T: Serialize>(value: &T) -> Result<String, Failure> {
    match serde_json::to_string(value) {
        Ok(json) => Ok(json + "\n"),
        Err(error) => Err(Failure::from_error(&error)),
    }
}
