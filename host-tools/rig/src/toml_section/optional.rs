//! What a file may leave out.

use super::{Section, number, wrong_type};
use crate::fields::Field;
use crate::toml_problem::{Fault, Problem};
use toml::Spanned;
use toml::de::DeValue;

impl<'a> Section<'a> {
    /// A table within this one, whose keys are all known; none if it is not there.
    ///
    /// # Errors
    /// A value of another type or an unknown key within it.
    pub fn optional(
        &self,
        key: &'static str,
        known: &[&str],
    ) -> Result<Option<Section<'a>>, Fault> {
        if self.has(key) {
            self.section(key, known).map(Some)
        } else {
            Ok(None)
        }
    }

    /// A number in its field's range; none if it is not there.
    ///
    /// # Errors
    /// A value of another type, or one outside the range.
    pub fn field(&self, field: &Field) -> Result<Option<f64>, Fault> {
        if !self.has(field.name) {
            return Ok(None);
        }
        in_range(field, self.get(field.name)?).map(Some)
    }

    /// An array of as many numbers as fields, each in its field's range; none if it is not there. The fields have one
    /// name.
    ///
    /// # Errors
    /// A value of another type, another number of them, or one outside its range.
    pub fn array<const N: usize>(&self, fields: &[Field; N]) -> Result<Option<[f64; N]>, Fault> {
        let Some(key) = fields.first().map(|field| field.name) else {
            return Ok(None);
        };
        if !self.has(key) {
            return Ok(None);
        }
        let value = self.get(key)?;
        let DeValue::Array(entries) = value.get_ref() else {
            return Err(wrong_type(key, "an array of numbers", value));
        };
        let found = entries.len();
        if found != N {
            return Err(Fault {
                span: value.span(),
                problem: Problem::Entries {
                    key,
                    found,
                    wanted: N,
                },
            });
        }
        let mut numbers = [0.0; N];
        for ((number, field), entry) in numbers.iter_mut().zip(fields).zip(entries.iter()) {
            *number = in_range(field, entry)?;
        }
        Ok(Some(numbers))
    }
}

fn in_range(field: &Field, value: &Spanned<DeValue<'_>>) -> Result<f64, Fault> {
    let found = number(field.name, value)?;
    if field.takes(found) {
        return Ok(found);
    }
    Err(Fault {
        span: value.span(),
        problem: Problem::OutsideRange {
            key: field.name,
            range: field.range,
            meaning: field.meaning,
        },
    })
}
