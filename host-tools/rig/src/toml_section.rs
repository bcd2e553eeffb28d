//! Reading a TOML file section by section, each refusal with its place in the text.

use crate::number::plain;
use crate::toml_error::TomlError;
use leg_base::suggest;
use leg_firmware::settings::Field;
use leg_model::Reason;
use std::ops::Range;
use toml::Spanned;
use toml::de::{DeArray, DeTable, DeValue};

const ADD: &str = "add it; the ready rigs in host-tools/rigs show all keys of each support";

/// A table of the file, with the place of its heading.
pub(crate) struct Section<'a> {
    pub table: &'a DeTable<'a>,
    span: Range<usize>,
}

impl<'a> Section<'a> {
    /// The table of a whole file, whose keys are not yet checked.
    pub fn whole(table: &'a DeTable<'a>) -> Self {
        Self { table, span: 0..0 }
    }

    /// The same, if all its keys are known; else the first that is not is refused.
    pub fn checked(self, known: &[&str]) -> Result<Self, TomlError> {
        let unknown = |key: &&Spanned<_>| !known.contains(&AsRef::<str>::as_ref(key.get_ref()));
        let unknown = self.table.keys().filter(unknown);
        match unknown.min_by_key(|key| key.span().start) {
            None => Ok(self),
            Some(key) => Err(TomlError::new(
                key.span(),
                format!("unknown key `{}`", key.get_ref()),
                suggest::key_remedy(key.get_ref(), known),
            )),
        }
    }

    /// The place of the section.
    pub fn span(&self) -> Range<usize> {
        self.span.clone()
    }

    /// The place of the value at a path of keys, if it is there.
    pub fn place(&self, path: &[&str]) -> Option<Range<usize>> {
        let (last, sections) = path.split_last()?;
        let inner = |table: &'a DeTable<'a>, key: &&str| table.get(*key)?.get_ref().as_table();
        let table = sections.iter().try_fold(self.table, inner)?;
        table.get(*last).map(Spanned::span)
    }

    /// Whether the key is there.
    pub fn has(&self, key: &str) -> bool {
        self.table.contains_key(key)
    }

    /// A table within this one, whose keys are all known.
    pub fn section(&self, key: &str, known: &[&str]) -> Result<Section<'a>, TomlError> {
        self.any_section(key)?.checked(known)
    }

    /// A table within this one, whose keys are all known; none if it is not there.
    pub fn optional(&self, key: &str, known: &[&str]) -> Result<Option<Section<'a>>, TomlError> {
        let given = self.has(key).then(|| self.section(key, known));
        given.transpose()
    }

    /// A table within this one, whose keys are not yet checked: for a first look at the one that says which are known.
    pub fn any_section(&self, key: &str) -> Result<Section<'a>, TomlError> {
        let missing = || TomlError::new(self.span(), format!("missing section `[{key}]`"), ADD);
        let value = self.table.get(key).ok_or_else(missing)?;
        match value.get_ref() {
            DeValue::Table(table) => Ok(Section {
                table,
                span: value.span(),
            }),
            _ => Err(wrong_type(key, "a section, `[name]`", value)),
        }
    }

    /// A finite number.
    pub fn number(&self, key: &str) -> Result<f64, TomlError> {
        number(key, self.get(key)?)
    }

    /// A length in millimetres, in m.
    pub fn metres(&self, key: &str) -> Result<f64, TomlError> {
        Ok(self.number(key)? / 1000.0)
    }

    /// A finite number above zero.
    pub fn positive(&self, key: &str) -> Result<f64, TomlError> {
        let value = self.get(key)?;
        match number(key, value)? {
            number if number > 0.0 => Ok(number),
            _ => Err(TomlError::refused(value.span(), key, Reason::NotPositive)),
        }
    }

    /// The numbers of one key, each in its field's range: one number for one field, else an array of them. None if the
    /// key is not there. The fields have one name.
    pub fn values<const N: usize>(
        &self,
        fields: [&Field<f64>; N],
    ) -> Result<Option<[f64; N]>, TomlError> {
        let Some(key) = fields.first().map(|field| field.name) else {
            return Ok(None);
        };
        if !self.has(key) {
            return Ok(None);
        }
        let value = self.get(key)?;
        let entries = match N {
            1 => vec![value],
            _ => array(key, "an array of numbers", value)?.iter().collect(),
        };
        if entries.len() != N {
            let sentence = format!("`{key}` has {} entries, it takes {N}", entries.len());
            let help = format!("give {N} numbers, [a, b, …]");
            return Err(TomlError::new(value.span(), sentence, help));
        }
        let mut numbers = [0.0; N];
        for ((number, field), entry) in numbers.iter_mut().zip(fields).zip(entries) {
            *number = number_in_range(field, entry)?;
        }
        Ok(Some(numbers))
    }

    /// Puts what is given of the fields into their values.
    pub fn read<'v>(
        &self,
        fields: &[Field<f64>],
        values: impl IntoIterator<Item = &'v mut f64>,
    ) -> Result<(), TomlError> {
        for (field, value) in fields.iter().zip(values) {
            if let Some([given]) = self.values([field])? {
                *value = given;
            }
        }
        Ok(())
    }

    /// An array of finite numbers, each with its place, and the place of the whole.
    pub fn numbers(&self, key: &str) -> Result<Spanned<Vec<Spanned<f64>>>, TomlError> {
        let value = self.get(key)?;
        let entry = |entry| Ok(Spanned::new(Spanned::span(entry), number(key, entry)?));
        let entries = array(key, "an array of numbers", value)?.iter().map(entry);
        let numbers: Result<_, TomlError> = entries.collect();
        Ok(Spanned::new(value.span(), numbers?))
    }

    /// A word, for example one of several choices, and its place.
    pub fn word(&self, key: &str) -> Result<Spanned<&'a str>, TomlError> {
        let value = self.get(key)?;
        match value.get_ref() {
            DeValue::String(word) => Ok(Spanned::new(value.span(), word)),
            _ => Err(wrong_type(key, "a string in quotes", value)),
        }
    }

    /// An array of words, each with its place.
    pub fn words(&self, key: &str) -> Result<Vec<Spanned<&'a str>>, TomlError> {
        let wanted = "an array of strings in quotes";
        let entries = array(key, wanted, self.get(key)?)?.iter();
        let word = |entry: &'a Spanned<DeValue<'a>>| match entry.get_ref() {
            DeValue::String(word) => Ok(Spanned::new(entry.span(), word.as_ref())),
            _ => Err(wrong_type(key, wanted, entry)),
        };
        entries.map(word).collect()
    }

    /// `true` or `false`.
    pub fn truth(&self, key: &str) -> Result<bool, TomlError> {
        let value = self.get(key)?;
        match value.get_ref() {
            DeValue::Boolean(truth) => Ok(*truth),
            _ => Err(wrong_type(key, "true or false", value)),
        }
    }

    /// Three points in a plane in millimetres, as `[[x, y], [x, y], [x, y]]`, in m.
    pub fn points_m(&self, key: &str) -> Result<[[f64; 2]; 3], TomlError> {
        let value = self.get(key)?;
        let wanted = "an array of points [x, y]";
        let points = array(key, wanted, value)?;
        let [a, b, c] = &points[..] else {
            let found = points.len();
            let sentence = format!("`{key}` has {found} anchors: the leg has three tendons");
            let help = "give three anchors, [[x, y], [x, y], [x, y]]";
            return Err(TomlError::new(value.span(), sentence, help));
        };
        let metres = |value| number(key, value).map(|length_mm| length_mm / 1000.0);
        let point = |point| match &array(key, wanted, point)?[..] {
            [x, y] => Ok([metres(x)?, metres(y)?]),
            _ => Err(wrong_type(key, wanted, point)),
        };
        Ok([point(a)?, point(b)?, point(c)?])
    }

    fn get(&self, key: &str) -> Result<&'a Spanned<DeValue<'a>>, TomlError> {
        let missing = || TomlError::new(self.span(), format!("missing key `{key}`"), ADD);
        self.table.get(key).ok_or_else(missing)
    }
}

fn array<'a>(
    key: &str,
    wanted: &str,
    value: &'a Spanned<DeValue<'a>>,
) -> Result<&'a DeArray<'a>, TomlError> {
    let array = value.get_ref().as_array();
    array.ok_or_else(|| wrong_type(key, wanted, value))
}

fn number(key: &str, value: &Spanned<DeValue<'_>>) -> Result<f64, TomlError> {
    let parsed = match value.get_ref() {
        DeValue::Integer(integer) if integer.radix() == 10 => integer.as_str().parse().ok(),
        DeValue::Float(float) => float.as_str().parse::<f64>().ok(),
        _ => None,
    };
    match parsed {
        None => Err(wrong_type(key, "a decimal number", value)),
        Some(number) if number.is_finite() => Ok(number),
        Some(_) => {
            let sentence = format!("`{key}` must be a finite number");
            let help = "write a number such as 29 or 1.5e3";
            Err(TomlError::new(value.span(), sentence, help))
        }
    }
}

fn number_in_range(field: &Field<f64>, value: &Spanned<DeValue<'_>>) -> Result<f64, TomlError> {
    let found = number(field.name, value)?;
    if field.contains(found) {
        return Ok(found);
    }
    let (key, [low, high]) = (field.name, field.range.map(plain));
    let unit = match field.unit {
        "1" => String::new(),
        unit => format!(", in {unit},"),
    };
    Err(TomlError::new(
        value.span(),
        format!("`{key}` is outside {low} to {high}"),
        format!("`{key}`{unit} is this: {}", field.meaning.trim()),
    ))
}

fn wrong_type(key: &str, wanted: &str, value: &Spanned<DeValue<'_>>) -> TomlError {
    let found = value.get_ref().type_str();
    let sentence = format!("`{key}` has to be {wanted}, this is a TOML {found}");
    TomlError::new(value.span(), sentence, format!("write {wanted}"))
}
