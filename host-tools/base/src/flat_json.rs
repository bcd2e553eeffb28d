//! The single values inside a JSON value, each by its place.

use serde_json::Value;

/// Every value that is no list or object, with the names on the way to it. Lists are counted from 1, as tendons are.
#[must_use]
pub fn flatten<'a>(value: &'a Value, separator: &str) -> Vec<(String, &'a Value)> {
    let mut found = Vec::new();
    collect(String::new(), value, separator, &mut found);
    found
}

fn collect<'a>(
    place: String,
    value: &'a Value,
    separator: &str,
    found: &mut Vec<(String, &'a Value)>,
) {
    let inside = |name: &str| match place.as_str() {
        "" => name.to_string(),
        place => format!("{place}{separator}{name}"),
    };
    match value {
        Value::Object(map) => map
            .iter()
            .for_each(|(key, value)| collect(inside(key), value, separator, found)),
        Value::Array(items) => (1..).zip(items).for_each(|(number, value): (u32, _)| {
            collect(inside(&number.to_string()), value, separator, found);
        }),
        value => found.push((place, value)),
    }
}
