//! What a command tells of the leg when it ends.

use super::print;
use crate::failure::Failure;
use crate::json_line::to_line;
use crate::leg_report::{LegReport, rows};
use leg_firmware::telemetry::Telemetry;

/// Prints what the leg is doing.
pub(super) fn tell(telemetry: &Telemetry<f32>, json: bool) -> Result<(), Failure> {
    print(&if json {
        to_line(&LegReport::of(telemetry))?
    } else {
        rows(telemetry)
    })
}
