//! The sections `[control.…]` of rig files and scenarios: gains and limits, key by key.

use crate::fields::Field;
use crate::gains::GainChange;
use crate::toml_problem::Fault;
use crate::toml_section::Section;
use leg_firmware::settings::SECTIONS;

/// Their common beginning.
pub const CONTROL: &str = "control";

/// The gains that a file gives; none where it has no such section.
///
/// # Errors
/// An unknown section or key, a value of another type or outside its range.
pub fn read(root: &Section<'_>) -> Result<Vec<GainChange>, Fault> {
    let names = SECTIONS.map(|(name, _)| name);
    let mut changes = Vec::new();
    let Some(control) = root.optional(CONTROL, &names)? else {
        return Ok(changes);
    };
    for (number, (name, fields)) in SECTIONS.into_iter().enumerate() {
        let fields: Vec<Field> = fields.iter().map(Field::from).collect();
        let keys: Vec<_> = fields.iter().map(|field| field.name).collect();
        if let Some(section) = control.optional(name, &keys)? {
            changes.extend(read_section(&section, number, &fields)?);
        }
    }
    Ok(changes)
}

fn read_section(
    section: &Section<'_>,
    number: usize,
    fields: &[Field],
) -> Result<Vec<GainChange>, Fault> {
    let change = |(index, field)| {
        let given = section.field(field).transpose()?;
        Some(given.map(|value| GainChange {
            section: number,
            field: index,
            value: value as f32,
        }))
    };
    fields.iter().enumerate().filter_map(change).collect()
}
