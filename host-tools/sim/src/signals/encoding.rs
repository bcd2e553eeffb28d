//! Signals as JSON and as rows of a table.

use super::{Signal, Values};
use leg_rig::number::decimal;
use serde_json::{Map, Value, json};

/// All signals as a JSON object. What is not known is null.
pub fn json_object<S>(signals: &[Signal<S>], of: &S) -> Map<String, Value> {
    let entry = |signal: &Signal<S>| (signal.name.to_string(), value(signal, of));
    signals.iter().map(entry).collect()
}

fn value<S>(signal: &Signal<S>, of: &S) -> Value {
    match signal.values {
        Values::Number(read) => read(of).into(),
        Values::Two(read) => read(of).map(Value::from).into(),
        Values::Three(read) => read(of).map(Value::from).into(),
        Values::Single(read) => single(read(of)),
        Values::SingleTwo(read) => read(of).map(single).into(),
        Values::SingleThree(read) => read(of).map(single).into(),
        Values::Count(read) => read(of).into(),
        Values::Flag(read) => read(of).into(),
        Values::Word(read) => read(of).into(),
        Values::Names(read) => read(of).into(),
    }
}

/// With the digits that it needs as an f32. What is no number is null, here as elsewhere.
fn single(number: f32) -> Value {
    decimal(number).into()
}

/// The JSON schema of that object: every property with its meaning.
pub fn json_schema<S>(title: &str, signals: &[Signal<S>]) -> Value {
    let number = json!({ "type": ["number", "null"] });
    let several = |count: usize| json!({ "type": "array", "items": number, "minItems": count, "maxItems": count });
    let property = |signal: &Signal<S>| {
        let mut schema = match signal.values {
            Values::Number(_) | Values::Single(_) => number.clone(),
            Values::Two(_) | Values::SingleTwo(_) => several(2),
            Values::Three(_) | Values::SingleThree(_) => several(3),
            Values::Count(_) => json!({ "type": ["integer", "null"], "minimum": 0 }),
            Values::Flag(_) => json!({ "type": "boolean" }),
            Values::Word(_) => json!({ "type": "string" }),
            Values::Names(_) => json!({ "type": "array", "items": { "type": "string" } }),
        };
        let words = format!("{}: {}", signal.origin.words(), signal.meaning);
        schema["description"] = words.into();
        (signal.name.to_string(), schema)
    };
    let properties: Map<String, Value> = signals.iter().map(property).collect();
    let names: Vec<_> = signals.iter().map(|signal| signal.name).collect();
    json!({
        "title": title,
        "type": "object",
        "properties": properties,
        "required": names,
        "additionalProperties": false,
    })
}

/// The names of the columns of a table: those of several numbers are counted from 1.
pub fn columns<S>(signals: &[Signal<S>]) -> impl Iterator<Item = String> {
    signals.iter().flat_map(|signal| match signal.width() {
        Some(width @ 2..) => (1..=width)
            .map(|i| format!("{}_{i}", signal.name))
            .collect(),
        _ => vec![signal.name.to_string()],
    })
}

/// A row of that table. What is not known is empty; names are separated by semicolons.
pub fn row<S>(signals: &[Signal<S>], of: &S) -> impl Iterator<Item = String> {
    signals.iter().flat_map(|signal| match value(signal, of) {
        Value::Array(names) if matches!(signal.values, Values::Names(_)) => {
            let names: Vec<_> = names.iter().filter_map(Value::as_str).collect();
            vec![names.join("; ")]
        }
        Value::Array(numbers) => numbers.iter().map(cell).collect(),
        value => vec![cell(&value)],
    })
}

fn cell(value: &Value) -> String {
    match value {
        Value::Null => String::new(),
        Value::String(text) => text.clone(),
        value => value.to_string(),
    }
}
