//! Gains and limits of the control law: the sections `[control.…]` of rig files and scenarios.

use crate::motor_sections::{MOTORS, own_sections, with_motors};
use crate::number::decimal;
use crate::recorded_signals::{self, RECORDED};
use crate::toml_error::TomlError;
use crate::toml_section::Section;
use leg_firmware::settings::{Field, Gains, SECTIONS, SERVO, SignalSet};
use toml::de::DeTable;

/// The common beginning of the sections.
pub const CONTROL: &str = "control";

/// The key beside them of rig files alone: whether the leg may keep station after a command.
pub const KEEPS_STATION: &str = "keeps_station";

/// One gain that is given.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GainChange {
    /// Which one, in the order of [`Gains::values`].
    index: usize,
    value: f32,
}

impl GainChange {
    /// Which one, in the order of [`Gains::values`].
    pub(crate) fn index(&self) -> usize {
        self.index
    }

    /// The key.
    #[must_use]
    pub fn name(&self) -> &'static str {
        let mut all = groups().flat_map(|group| group.fields);
        all.nth(self.index).map_or("", |field| field.name)
    }
}

/// The gains of a section: of the whole leg, or of one motor.
pub(crate) struct GainGroup {
    pub section: &'static str,
    /// The motor, from 0; none where all have it together.
    pub motor: Option<usize>,
    pub fields: &'static [Field],
}

/// All of them, in the order of [`Gains::values`].
pub(crate) fn groups() -> impl Iterator<Item = GainGroup> {
    SECTIONS.into_iter().flat_map(|(section, fields)| {
        let motors = if section == SERVO { MOTORS.len() } else { 1 };
        (0..motors).map(move |motor| GainGroup {
            section,
            motor: (section == SERVO).then_some(motor),
            fields,
        })
    })
}

/// The place of a gain in the order of [`Gains::values`]; the motor, from 0, matters where each has its own.
pub(crate) fn index_of(section: &str, motor: usize, key: &str) -> Option<usize> {
    let all = groups().flat_map(|group| {
        let fields = group.fields.iter();
        fields.map(move |field| (group.section, group.motor.unwrap_or(motor), field.name))
    });
    all.into_iter()
        .position(|place| place == (section, motor, key))
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

/// The range of a key among fields; not a number where there is none.
pub(crate) fn range_of(fields: &[Field], name: &str) -> [f64; 2] {
    let field = fields.iter().find(|field| field.name == name);
    field.map_or([f64::NAN; 2], |field| widened(field).range)
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
    for group in groups() {
        let keys: Vec<_> = group.fields.iter().map(|field| field.name).collect();
        if let Some((section, own)) = sections(control, &group, &keys)? {
            for (index, field) in (first..).zip(group.fields) {
                let field = widened(field);
                let own = own.as_ref().map(|own| own.values([&field])).transpose()?;
                let given = own
                    .flatten()
                    .map_or_else(|| section.values([&field]), |own| Ok(Some(own)))?;
                if let Some([value]) = given {
                    let value = value as f32;
                    changes.push(GainChange { index, value });
                }
            }
        }
        first += group.fields.len();
    }
    Ok(changes)
}

/// The section of a group, and the one that its motor has for itself.
fn sections<'a>(
    control: &Section<'a>,
    group: &GainGroup,
    keys: &[&str],
) -> Result<Option<(Section<'a>, Option<Section<'a>>)>, TomlError> {
    let Some(motor) = group.motor else {
        let section = control.optional(group.section, keys)?;
        return Ok(section.map(|section| (section, None)));
    };
    let Some(section) = control.optional(group.section, &with_motors(keys))? else {
        return Ok(None);
    };
    let own = own_sections(&section, keys)?.into_iter().nth(motor);
    Ok(Some((section, own.flatten())))
}

#[cfg(test)]
mod tests {
    use super::{GainChange, changed, groups};
    use leg_firmware::settings::Gains;

    #[test]
    fn every_gain_changes_alone() {
        let count = groups().map(|group| group.fields.len()).sum();
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
