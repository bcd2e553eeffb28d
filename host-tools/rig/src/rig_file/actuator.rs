//! The section `[actuator]`: motors, gears, screws and sensors by their data sheets.

use crate::actuator::{Actuator, CELL_RANGE, TEMPERATURE_RANGE};
use crate::fields::Field;
use crate::toml_problem::Fault;
use crate::toml_section::Section;

/// The name of the section.
pub(super) const ACTUATOR: &str = "actuator";

/// The actuator; whatever is left out is as by default.
pub(super) fn read(root: &Section<'_>) -> Result<Actuator, Fault> {
    let mut actuator = Actuator::DEFAULT;
    let fields = Actuator::fields();
    let mut keys: Vec<_> = fields.iter().map(|field| field.name).collect();
    keys.extend([CELL_RANGE[0].name, TEMPERATURE_RANGE[0].name]);
    let Some(section) = root.optional(ACTUATOR, &keys)? else {
        return Ok(actuator);
    };
    read_fields(&section, &fields, actuator.values_mut())?;
    if let Some(range) = section.array(&CELL_RANGE)? {
        actuator.cell_range_n = range;
    }
    if let Some(range) = section.array(&TEMPERATURE_RANGE)? {
        actuator.temperature_range_c = range;
    }
    Ok(actuator)
}

/// Puts what the section gives of the fields into their values.
pub(super) fn read_fields(
    section: &Section<'_>,
    fields: &[Field],
    values: Vec<&mut f64>,
) -> Result<(), Fault> {
    for (field, value) in fields.iter().zip(values) {
        if let Some(given) = section.field(field)? {
            *value = given;
        }
    }
    Ok(())
}
