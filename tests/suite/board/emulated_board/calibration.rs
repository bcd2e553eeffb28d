//! Calibrations, with what a user does by hand.

use super::board::{BoardUnderTest, errors};
use serde_json::Value;
use std::io::Write as _;
use std::process::Stdio;

#[test]
fn motors_are_checked_by_hand() {
    let mut board = BoardUnderTest::new(&["--slack"]);
    let turns = [
        r#"{"turn":{"motor":1,"turns":1}}"#,
        r#"{"turn":{"motor":2,"turns":-1}}"#,
        r#"{"turn":{"motor":3,"turns":0.5}}"#,
    ];
    let output = board.run_by_hand(
        board.command(&["calibrate", "motors", "--json"]),
        &turns,
        1.2,
    );
    assert_eq!(output.status.code(), Some(1));
    let turned: Value = serde_json::from_slice(&output.stdout).unwrap();
    let passed = [0, 1, 2].map(|motor| turned[motor]["passed"].as_bool().unwrap());
    assert_eq!(passed, [true, false, false]);
    assert_eq!(turned[1]["sign"], -1);
}

#[test]
fn a_load_cell_is_calibrated_with_weights_and_the_board_is_set_to_it() {
    let mut board = BoardUnderTest::new(&["--slack"]);
    let hangs = [0.0, 20.0 * 9.81]
        .map(|newtons: f64| format!("{{\"hang\":{{\"cell\":2,\"newtons\":{newtons}}}}}"));
    let hangs = hangs.each_ref().map(String::as_str);
    let arguments = [
        "calibrate",
        "cells",
        "--cell",
        "2",
        "--weights",
        "0,20",
        "--set",
        "--json",
    ];
    let output = board.run_by_hand(board.command(&arguments), &hangs, 0.5);
    assert!(output.status.success(), "{}", errors(&output));
    let found: Value = serde_json::from_slice(&output.stdout).unwrap();
    let settings = board.json(&["settings", "get"]);
    let cell = &settings["axes"][1];
    for key in ["cell_n_per_code", "cell_zero_code"] {
        assert_eq!(
            cell[key].as_f64().unwrap() as f32,
            found[key][1].as_f64().unwrap() as f32
        );
    }
    // The cell reads 0.8 N too little; its range is 250 N in 65 520 codes. The mean has a standard deviation of 0.4 codes.
    let zero = found["zero_code"].as_f64().unwrap();
    assert!(
        (zero - (20.0 - 0.8) / 250.0 * 65_520.0).abs() < 2.0,
        "{zero}"
    );
}

#[test]
fn a_calibration_ends_with_its_standard_input() {
    let board = BoardUnderTest::new(&[]);
    let mut command = board.command(&["calibrate", "motors"]);
    let output = command.stdin(Stdio::null()).output().unwrap();
    assert_eq!(output.status.code(), Some(2));
    assert!(errors(&output).contains("standard input has ended"));
}

#[test]
fn a_driven_leg_is_not_calibrated() {
    let board = BoardUnderTest::new(&[]);
    assert_eq!(board.json(&["hold"])["state"], "held");
    let (code, told) = board.refused(&["calibrate", "motors"]);
    assert_eq!(code, Some(2));
    assert!(told.contains("run `leg disarm` first"), "{told}");
    let (code, told) = board.refused(&["settings", "set", "--rig", "universal"]);
    assert_eq!(code, Some(2));
    assert!(told.contains("run `leg disarm` first"), "{told}");
}

/// `leg tune` says what it will do, and does nothing before Enter is pressed, or where it is declined.
#[test]
fn a_tuning_that_nobody_confirms_moves_nothing() {
    let board = BoardUnderTest::new(&["--slack"]);
    for (answer, end) in [("", "standard input has ended"), ("n\n", "declined")] {
        let mut command = board.command(&["tune", "1"]);
        let piped = command.stdin(Stdio::piped()).stdout(Stdio::piped());
        let mut running = piped.stderr(Stdio::piped()).spawn().unwrap();
        let mut input = running.stdin.take().unwrap();
        input.write_all(answer.as_bytes()).unwrap();
        drop(input);
        let output = running.wait_with_output().unwrap();
        let told = errors(&output);
        assert_eq!(output.status.code(), Some(2), "{told}");
        let question = "your hand at the emergency stop, then press Enter";
        assert!(told.contains(question) && told.contains(end), "{told}");
        let plan = String::from_utf8(output.stdout).unwrap();
        assert!(plan.contains("jog") && plan.contains("swing"), "{plan}");
    }
    let state = board.state();
    assert_eq!(state["state"], "disarmed");
    for motor in 0..3 {
        let pulled_mm = state["pulled_m"][motor].as_f64().unwrap() * 1e3;
        assert!(pulled_mm.abs() < 1e-3, "{state}");
    }
}
