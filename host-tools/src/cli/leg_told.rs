//! What a command tells of the leg when it ends.

use super::print;
use crate::failure::Failure;
use crate::leg_report::{LegReport, rows};
use leg_firmware::telemetry::Telemetry;
use serde::Serialize;

/// Prints what the leg is doing.
pub(super) fn tell(telemetry: &Telemetry<f32>, json: bool) -> Result<(), Failure> {
    print(&if json {
        to_line(&LegReport::of(telemetry))?
    } else {
        rows(telemetry)
    })
}

/// One line of JSON.
pub(super) fn to_line<T: Serialize>(value: &T) -> Result<String, Failure> {
    match serde_json::to_string(value) {
        Ok(json) => Ok(json + "\n"),
        Err(error) => Err(Failure::from_error(&error)),
    }
}
