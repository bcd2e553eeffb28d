//! The settings of a board that was given none: those of the paper's leg.

use super::Settings;

/// In postcard's format. `tests/suite/firmware/default_settings.rs` compares it with what the rig file `table1` gives, and
/// writes it.
const TABLE_1: &[u8] = include_bytes!("default.postcard");

impl Settings {
    /// The settings for the leg of the paper's Table 1 with the actuators of its rig file, not homed.
    ///
    /// `None` only if the program was built from a blob of another shape, which a test excludes.
    #[must_use]
    pub fn table_1() -> Option<Self> {
        match postcard::take_from_bytes(TABLE_1) {
            Ok((settings, [])) => Some(settings),
            Ok(_) | Err(_) => None,
        }
    }
}
