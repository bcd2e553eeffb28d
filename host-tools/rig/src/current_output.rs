//! What the current outputs of the motors' drivers show, by the names that rig files give.

use crate::toml_error::TomlError;
use crate::toml_section::Section;
use leg_firmware::settings::{CURRENT_OUTPUTS, CurrentOutput};

/// The key in `[actuator]`.
pub const CURRENT_OUTPUT: &str = "current_output";

/// The name of what an output shows.
#[must_use]
pub const fn word(output: CurrentOutput) -> &'static str {
    match output {
        CurrentOutput::Bidirectional => "bidirectional",
        CurrentOutput::Magnitude => "magnitude",
        CurrentOutput::MagnitudeWhenDriven => "magnitude_when_driven",
    }
}

/// What a section gives, if it does.
pub(crate) fn read(section: &Section<'_>) -> Result<Option<CurrentOutput>, TomlError> {
    if !section.has(CURRENT_OUTPUT) {
        return Ok(None);
    }
    let given = section.word(CURRENT_OUTPUT)?;
    let named = |output: &CurrentOutput| word(*output) == *given.get_ref();
    let found = CURRENT_OUTPUTS.into_iter().find(named);
    found.map(Some).ok_or_else(|| {
        let names = CURRENT_OUTPUTS.map(|output| format!("\"{}\"", word(output)));
        TomlError::new(
            given.span(),
            format!("`{CURRENT_OUTPUT}` cannot be `{}`", given.get_ref()),
            format!("write one of {}", names.join(", ")),
        )
    })
}
