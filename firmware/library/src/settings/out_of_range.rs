//! A value outside its range.

use super::sections::UNSTRETCHED;
use super::{AxisCalibration, BoardCalibration, Field, SECTIONS};
use core::fmt;
use postcard_schema::Schema;
use serde::{Deserialize, Serialize};

/// The sections of the calibration, numbered after those of gains.
const CALIBRATION: [(&str, &[Field]); 3] = [
    ("calibration", AxisCalibration::FIELDS),
    ("calibration", &[UNSTRETCHED]),
    ("sensors", BoardCalibration::FIELDS),
];

/// A field outside its range.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, Schema)]
pub struct OutOfRange {
    /// The section's number: as in [`SECTIONS`], then the calibration of an axis, its zero, and what the axes share.
    pub section: u8,
    /// The field's number in the section.
    pub field: u8,
    /// The axis, from 1; 0 for what belongs to none.
    pub axis: u8,
}

impl OutOfRange {
    /// The section's name and the field; none for numbers that no section has.
    #[must_use]
    pub fn field(&self) -> Option<(&'static str, &'static Field)> {
        let section = usize::from(self.section);
        let (name, fields) = SECTIONS.iter().chain(&CALIBRATION).nth(section)?;
        Some((name, fields.get(usize::from(self.field))?))
    }

    /// Checks the values of a section against its fields.
    pub(super) fn check(
        section: u8,
        axis: u8,
        fields: &[Field],
        values: &[f32],
    ) -> Result<(), Self> {
        for ((number, field), &value) in (0..).zip(fields).zip(values) {
            if !field.contains(value) {
                return Err(Self {
                    section,
                    field: number,
                    axis,
                });
            }
        }
        Ok(())
    }
}

impl fmt::Display for OutOfRange {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Some((section, field)) = self.field() else {
            return f.write_str("a setting is outside its range");
        };
        write!(f, "{section}.{}", field.name)?;
        if self.axis != 0 {
            write!(f, " of axis {}", self.axis)?;
        }
        let [low, high] = field.range;
        let sign = if field.signed { "±" } else { "" };
        write!(f, " is outside {sign}{low} to {high}")
    }
}
