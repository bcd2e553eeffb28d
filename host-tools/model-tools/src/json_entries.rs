//! A JSON object as its keys and the text of their values, in order, nothing lost.

use serde::de::{Deserialize, Deserializer, Error, MapAccess, Visitor};
use serde_json::value::RawValue;
use std::fmt;

/// The keys and the values' text. Unlike a map it keeps repeated keys, and numbers that no float can hold.
#[derive(Debug)]
pub struct Entries(pub Vec<(String, Box<RawValue>)>);

/// Reads one JSON object.
///
/// # Errors
/// What is wrong and at which column; within a value, its key as well.
pub fn parse(text: &[u8]) -> Result<Entries, String> {
    serde_json::from_slice(text).map_err(|error| {
        let sentence = error.to_string();
        let place = format!(" at line {} column {}", error.line(), error.column());
        match sentence.strip_suffix(&place) {
            // A value of another type is known by its first byte, before a column is counted.
            Some(reason) => format!("{reason} at column {}", error.column().max(1)),
            None => sentence,
        }
    })
}

impl<'de> Deserialize<'de> for Entries {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_map(EntriesVisitor)
    }
}

struct EntriesVisitor;

impl<'de> Visitor<'de> for EntriesVisitor {
    type Value = Entries;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("an object")
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Entries, A::Error> {
        let mut entries = Vec::new();
        while let Some(key) = map.next_key::<String>()? {
            let in_value = |error: A::Error| A::Error::custom(format!("in `{key}`: {error}"));
            let value = map.next_value().map_err(in_value)?;
            entries.push((key, value));
        }
        Ok(Entries(entries))
    }
}
