//! `leg eval` against `golden/expected.jsonl`, which an independent f64 program wrote.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use crate::common::{difference, numbers};
use serde_json::{Map, Value};
use std::process::Command;

/// What `leg eval` answers to the golden cases.
fn answers(on: &str) -> String {
    let cases = concat!(env!("CARGO_MANIFEST_DIR"), "/golden/cases.jsonl");
    let leg = env!("CARGO_BIN_EXE_leg-under-test");
    let output = Command::new(leg)
        .args(["eval", "--on", on, cases])
        .output()
        .unwrap();
    assert!(
        output.status.success(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    String::from_utf8(output.stdout).unwrap()
}

fn objects(text: &str) -> Vec<Map<String, Value>> {
    text.lines()
        .map(|line| serde_json::from_str(line).unwrap())
        .collect()
}

fn assert_near(on: &str, bound: f64, left_out: &[&str]) {
    let expected = objects(include_str!("../../golden/expected.jsonl"));
    let answers = objects(&answers(on));
    assert_eq!(answers.len(), expected.len());
    for (case, (answer, expected)) in answers.iter().zip(&expected).enumerate() {
        for (key, expected) in expected
            .iter()
            .filter(|(key, _)| !left_out.contains(&key.as_str()))
        {
            let answer = answer
                .get(key)
                .unwrap_or_else(|| panic!("case {case}: no `{key}`"));
            if expected.is_boolean() {
                assert_eq!(answer, expected, "case {case}, `{key}`");
                continue;
            }
            let difference = difference(&numbers(answer), &numbers(expected));
            assert!(
                difference <= bound,
                "case {case}, `{key}` is off by {difference:e}"
            );
        }
    }
}

#[test]
fn f64_agrees_to_1e_6() {
    assert_near("f64", 1e-6, &[]);
}

#[test]
fn f32_agrees_to_1e_5() {
    assert_near("f32", 1e-5, &["deviation_nonlinear_m"]);
}

#[test]
fn the_emulated_core_gives_the_bits_of_the_host() {
    assert_eq!(answers("qemu"), answers("f32"));
}
