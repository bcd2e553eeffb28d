//! What a command tells of the leg when it ends.

use super::print;
use leg_base::failure::Failure;
use leg_base::json_line::to_line;
use leg_firmware::telemetry::Telemetry;
use leg_host::leg_report::{LegReport, rows};

/// Prints what the leg is doing.
pub(super) fn tell(telemetry: &Telemetry<f32>, json: bool) -> Result<(), Failure> {
    print(&if json {
        to_line(&LegReport::of(telemetry))?
    } else {
        rows(telemetry)
    })
}
