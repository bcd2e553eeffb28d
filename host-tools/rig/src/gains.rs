//! Gains and limits of the control law: the sections `[control.…]` of rig files and scenarios.

use crate::number::decimal;
use crate::recorded_signals::{self, RECORDED};
use crate::toml_error::TomlError;
use crate::toml_section::Section;
use leg_firmware::settings::SignalSet;
use leg_firmware::settings::{Field, Gains, SECTIONS};
use toml::de::DeTable;

/// The common beginning of the sections.
pub const CONTROL: &str = "control";

/// The key beside them of rig files alone: whether the leg may keep station after a command.
pub const KEEPS_STATION: &str = "keeps_station";

/// One gain that is given.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GainChange {
    /// Which one, counted through the sections.
    index: usize,
    value: f32,
}

impl GainChange {
    /// Which one, counted through the sections.
    pub(crate) fn index(&self) -> usize {
        self.index
    }

    /// The key.
    #[must_use]
    pub fn name(&self) -> &'static str {
        let fields = SECTIONS.iter().flat_map(|(_, fields)| *fields);
        fields.map(|field| field.name).nth(self.index).unwrap_or("")
    }
}

/// The place of a gain, counted through the sections.
pub(crate) fn index_of(section: &str, key: &str) -> Option<usize> {
    let keys = SECTIONS
        .iter()
        .flat_map(|(name, fields)| fields.iter().map(move |field| (*name, field.name)));
    keys.into_iter().position(|path| path == (section, key))
}

/// The gains with other values where any are given.
#[must_use]
pub fn changed(mut gains: Gains, changes: &[GainChange]) -> Gains {
    for (index, value) in gains.values_mut().enumerate() {
        if let Some(change) = changes.iter().find(|change| change.index == index) {
            *value = change.value;
        }
    }
    gains
}

/// The same field in f64: its numbers as they are written, 0.05 not 0.05000000074505806.
pub(crate) fn widened(field: &Field) -> Field<f64> {
    Field {
        name: field.name,
        unit: field.unit,
        meaning: field.meaning,
        range: field.range.map(decimal),
        signed: field.signed,
        default: decimal(field.default),
    }
}

/// The gains that a file gives; none where it has no such section.
///
/// # Errors
/// An unknown section or key, a value of another type or outside its range.
pub fn read(file: &DeTable<'_>) -> Result<Vec<GainChange>, TomlError> {
    let control = Section::whole(file).optional(CONTROL, &SECTIONS.map(|(name, _)| name))?;
    control.map_or(Ok(Vec::new()), |control| read_sections(&control))
}

/// What `[control]` of a rig file gives.
#[derive(Default)]
pub(crate) struct GivenControl {
    pub changes: Vec<GainChange>,
    /// Whether the leg may keep station, if that is given.
    pub keeps_station: Option<bool>,
    pub recorded: SignalSet,
}

/// The same of a rig file, with the keys beside the sections.
pub(crate) fn read_rig(file: &Section<'_>) -> Result<GivenControl, TomlError> {
    let mut known = vec![KEEPS_STATION, RECORDED];
    known.extend(SECTIONS.iter().map(|(name, _)| *name));
    let Some(control) = file.optional(CONTROL, &known)? else {
        return Ok(GivenControl::default());
    };
    let given = control.has(KEEPS_STATION);
    Ok(GivenControl {
        changes: read_sections(&control)?,
        keeps_station: given.then(|| control.truth(KEEPS_STATION)).transpose()?,
        recorded: recorded_signals::read(&control)?,
    })
}

fn read_sections(control: &Section<'_>) -> Result<Vec<GainChange>, TomlError> {
    let mut changes = Vec::new();
    let mut first = 0;
    for (name, fields) in SECTIONS {
        let keys: Vec<_> = fields.iter().map(|field| field.name).collect();
        if let Some(section) = control.optional(name, &keys)? {
            for (index, field) in (first..).zip(fields) {
                if let Some([value]) = section.values([&widened(field)])? {
                    let value = value as f32;
                    changes.push(GainChange { index, value });
                }
            }
        }
        first += fields.len();
    }
    Ok(changes)
}

#[cfg(test)]
mod tests {
    use super::{GainChange, changed};
    use leg_firmware::settings::{Gains, SECTIONS};

    #[test]
    fn every_gain_changes_alone() {
        let count = SECTIONS.iter().map(|(_, fields)| fields.len()).sum();
        let default: Vec<f32> = Gains::default().values().collect();
        assert_eq!(default.len(), count);
        for index in 0..count {
            let mut expected = default.clone();
            expected[index] = -1.0;
            let value = -1.0;
            let found = changed(Gains::default(), &[GainChange { index, value }]);
            assert!(found.values().eq(expected), "{index}");
        }
    }
}
