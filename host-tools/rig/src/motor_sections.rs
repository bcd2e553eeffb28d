//! What each motor may have for itself: `[actuator.2]` beside `[actuator]`, `[control.servo.2]` beside `[control.servo]`.

use crate::toml_error::TomlError;
use crate::toml_section::Section;

/// The motors by their sections.
pub(crate) const MOTORS: [&str; 3] = ["1", "2", "3"];

/// The section of a motor, from 0, within another one.
#[must_use]
pub fn motor_section(section: &str, motor: usize) -> String {
    format!("{section}.{}", motor + 1)
}

/// Keys, and those of the motors' own sections.
pub(crate) fn with_motors<'a>(keys: &[&'a str]) -> Vec<&'a str> {
    [keys, &MOTORS].concat()
}

/// The section of each motor within another one, whose keys are all known; none where it is not there.
pub(crate) fn own_sections<'a>(
    section: &Section<'a>,
    keys: &[&str],
) -> Result<[Option<Section<'a>>; 3], TomlError> {
    let [first, second, third] = MOTORS;
    Ok([
        section.optional(first, keys)?,
        section.optional(second, keys)?,
        section.optional(third, keys)?,
    ])
}
