//! The board's image on the emulated chip.

use leg_boards::image::FirmwareImage;
use leg_boards::setup;
use leg_firmware::sensors::{CODE_MAX, Sensors};
use leg_firmware_bench::protocol::TickRequest;
use leg_sim::emulated_leg::HostBytes;
use std::error::Error;
use std::path::PathBuf;

/// An image, built with what that needs.
pub fn image(image: FirmwareImage) -> Result<PathBuf, Box<dyn Error>> {
    setup::ensure_target(&mut |what: &str| eprintln!("{what}"))?;
    Ok(image.build()?)
}

/// A tick of a leg at rest, whose host says nothing.
pub fn at_rest() -> TickRequest {
    TickRequest {
        sensors: Sensors {
            cell_codes: [CODE_MAX / 4; 3],
            current_codes: [CODE_MAX / 2; 3],
            supply_code: CODE_MAX / 2,
            temperature_code: CODE_MAX / 4,
            cell_fresh: [true; 3],
            ..Sensors::default()
        },
        link: HostBytes::new(),
    }
}
