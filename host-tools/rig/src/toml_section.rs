//! Reading a TOML file section by section, each refusal with its place in the text.

mod optional;

use crate::toml_problem::{Fault, Problem};
use leg_base::suggest;
use leg_model::Reason;
use std::ops::Range;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// A table of the file, with the place of its heading.
pub struct Section<'a> {
    table: &'a DeTable<'a>,
    span: Range<usize>,
}

impl<'a> Section<'a> {
    /// A table whose keys are all known.
    ///
    /// # Errors
    /// [`Problem::UnknownKey`] at the first key that is not in `known`.
    pub fn new(table: &'a DeTable<'a>, span: Range<usize>, known: &[&str]) -> Result<Self, Fault> {
        let unknown = |key: &&Spanned<_>| !known.contains(&AsRef::<str>::as_ref(key.get_ref()));
        match table
            .keys()
            .filter(unknown)
            .min_by_key(|key| key.span().start)
        {
            None => Ok(Self { table, span }),
            Some(key) => Err(Fault {
                span: key.span(),
                problem: Problem::UnknownKey {
                    key: key.get_ref().to_string(),
                    fix: suggest::for_key(key.get_ref(), known),
                },
            }),
        }
    }

    /// The table of a whole file whose keys others check.
    #[must_use]
    pub fn unchecked(table: &'a DeTable<'a>) -> Self {
        Self { table, span: 0..0 }
    }

    /// The place of the value of a key in a section, if both are there.
    #[must_use]
    pub fn span_of(&self, section: &str, key: &str) -> Option<Range<usize>> {
        let section = self.table.get(section)?.get_ref().as_table()?;
        section.get(key).map(Spanned::span)
    }

    /// A table within this one, whose keys are all known.
    ///
    /// # Errors
    /// A missing key, a value of another type or an unknown key within it.
    pub fn section(&self, key: &'static str, known: &[&str]) -> Result<Section<'a>, Fault> {
        let Section { table, span } = self.any_section(key)?;
        Section::new(table, span, known)
    }

    /// A table within this one, whose keys are not yet checked: for a first look at the one that says which are known.
    ///
    /// # Errors
    /// A missing key or a value of another type.
    pub fn any_section(&self, key: &'static str) -> Result<Section<'a>, Fault> {
        let value = self
            .table
            .get(key)
            .ok_or_else(|| self.missing(Problem::MissingSection(key)))?;
        match value.get_ref() {
            DeValue::Table(table) => Ok(Section {
                table,
                span: value.span(),
            }),
            _ => Err(wrong_type(key, "a section, `[name]`", value)),
        }
    }

    /// The place of the value of a key, if it is there.
    #[must_use]
    pub fn span_of_key(&self, key: &str) -> Option<Range<usize>> {
        self.table.get(key).map(Spanned::span)
    }

    /// A finite number above zero.
    ///
    /// # Errors
    /// As [`Self::number`]; [`Problem::Refused`].
    pub fn positive(&self, key: &'static str) -> Result<f64, Fault> {
        let number = self.spanned_number(key)?;
        if *number.get_ref() > 0.0 {
            return Ok(*number.get_ref());
        }
        Err(Fault {
            span: number.span(),
            problem: Problem::Refused {
                key,
                reason: Reason::NotPositive,
            },
        })
    }

    /// A finite number.
    ///
    /// # Errors
    /// A missing key, a value of another type, an infinite number or NaN.
    pub fn number(&self, key: &'static str) -> Result<f64, Fault> {
        number(key, self.get(key)?)
    }

    /// Whether the key is there.
    #[must_use]
    pub fn has(&self, key: &str) -> bool {
        self.table.contains_key(key)
    }

    /// The place of the section.
    #[must_use]
    pub fn span(&self) -> Range<usize> {
        self.span.clone()
    }

    /// A finite number and its place.
    ///
    /// # Errors
    /// As [`Self::number`].
    pub fn spanned_number(&self, key: &'static str) -> Result<Spanned<f64>, Fault> {
        let value = self.get(key)?;
        Ok(Spanned::new(value.span(), number(key, value)?))
    }

    /// An array of finite numbers, each with its place, and the place of the whole.
    ///
    /// # Errors
    /// A missing key, a value of another type, an entry that is no finite number.
    pub fn numbers(&self, key: &'static str) -> Result<Spanned<Vec<Spanned<f64>>>, Fault> {
        let value = self.get(key)?;
        let DeValue::Array(entries) = value.get_ref() else {
            return Err(wrong_type(key, "an array of numbers", value));
        };
        let entry =
            |entry: &Spanned<DeValue<'_>>| Ok(Spanned::new(entry.span(), number(key, entry)?));
        let numbers: Result<_, Fault> = entries.iter().map(entry).collect();
        Ok(Spanned::new(value.span(), numbers?))
    }

    /// A word, for example one of several choices, and its place.
    ///
    /// # Errors
    /// A missing key or a value of another type.
    pub fn word(&self, key: &'static str) -> Result<Spanned<&'a str>, Fault> {
        let value = self.get(key)?;
        match value.get_ref() {
            DeValue::String(word) => Ok(Spanned::new(value.span(), word)),
            _ => Err(wrong_type(key, "a string in quotes", value)),
        }
    }

    /// Three points in a plane, as `[[x, y], [x, y], [x, y]]`.
    ///
    /// # Errors
    /// A missing key, a value of another shape or another count, a number that is not finite.
    pub fn points(&self, key: &'static str) -> Result<[[f64; 2]; 3], Fault> {
        let value = self.get(key)?;
        let wanted = "an array of points [x, y]";
        let DeValue::Array(points) = value.get_ref() else {
            return Err(wrong_type(key, wanted, value));
        };
        let found = points.len();
        let [a, b, c] = &points[..] else {
            let problem = Problem::AnchorCount { key, found };
            return Err(Fault {
                span: value.span(),
                problem,
            });
        };
        let point = |point: &Spanned<DeValue<'_>>| match point.get_ref() {
            DeValue::Array(pair) => match &pair[..] {
                [x, y] => Ok([number(key, x)?, number(key, y)?]),
                _ => Err(wrong_type(key, wanted, point)),
            },
            _ => Err(wrong_type(key, wanted, point)),
        };
        Ok([point(a)?, point(b)?, point(c)?])
    }

    fn get(&self, key: &'static str) -> Result<&'a Spanned<DeValue<'a>>, Fault> {
        self.table
            .get(key)
            .ok_or_else(|| self.missing(Problem::MissingKey(key)))
    }

    fn missing(&self, problem: Problem) -> Fault {
        Fault {
            span: self.span.clone(),
            problem,
        }
    }
}

fn number(key: &'static str, value: &Spanned<DeValue<'_>>) -> Result<f64, Fault> {
    let parsed = match value.get_ref() {
        DeValue::Integer(integer) if integer.radix() == 10 => integer.as_str().parse().ok(),
        DeValue::Float(float) => float.as_str().parse::<f64>().ok(),
        _ => None,
    };
    match parsed {
        None => Err(wrong_type(key, "a decimal number", value)),
        Some(number) if number.is_finite() => Ok(number),
        Some(_) => Err(Fault {
            span: value.span(),
            problem: Problem::NotFinite(key),
        }),
    }
}

fn wrong_type(key: &'static str, wanted: &'static str, value: &Spanned<DeValue<'_>>) -> Fault {
    let found = value.get_ref().type_str();
    Fault {
        span: value.span(),
        problem: Problem::WrongType { key, wanted, found },
    }
}
