//! A JSON object as its keys and the text of their values.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use leg_model_tools::json_entries::parse;

#[test]
fn a_faulty_value_is_named_by_key_and_column() {
    let error = parse(br#"{"payload_kg": NaN}"#).unwrap_err();
    assert_eq!(error, "in `payload_kg`: expected value at column 16");
}

#[test]
fn what_is_no_object_is_named() {
    assert_eq!(
        parse(b"3").unwrap_err(),
        "invalid type: integer `3`, expected an object at column 1"
    );
}

#[test]
fn repeated_keys_and_huge_numbers_are_kept() {
    let entries = parse(br#"{"a":1e999,"a":2}"#).unwrap().0;
    let text: Vec<_> = entries
        .iter()
        .map(|(key, value)| (key.as_str(), value.get()))
        .collect();
    assert_eq!(text, [("a", "1e999"), ("a", "2")]);
}
