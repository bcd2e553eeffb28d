//! Calibrations, with what a user does by hand.

use super::board::{Board, errors};
use serde_json::Value;
use std::io::{BufRead, BufReader, Write};
use std::process::{Output, Stdio};

/// Runs a calibration, with what is done by hand at each of its questions.
fn calibrate(board: &mut Board, arguments: &[&str], hand: &[&str], leg_time_s: f64) -> Output {
    let mut command = board.command(arguments);
    command
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped());
    let mut calibrating = command.spawn().unwrap();
    let mut enter = calibrating.stdin.take().unwrap();
    let mut questions = BufReader::new(calibrating.stderr.take().unwrap()).lines();
    for touch in hand {
        let question = questions.next().unwrap().unwrap();
        assert!(question.ends_with("then press Enter"), "{question}");
        board.touch(touch);
        board.wait(leg_time_s);
        writeln!(enter).unwrap();
    }
    let output = calibrating.wait_with_output().unwrap();
    // What else it says.
    let stderr = questions.map_while(Result::ok).collect::<String>().into();
    Output { stderr, ..output }
}

#[test]
fn motors_are_checked_by_hand() {
    let mut board = Board::new(&["--slack"]);
    let turns = [
        r#"{"turn":{"motor":1,"turns":1}}"#,
        r#"{"turn":{"motor":2,"turns":-1}}"#,
        r#"{"turn":{"motor":3,"turns":0.5}}"#,
    ];
    let output = calibrate(&mut board, &["calibrate", "motors", "--json"], &turns, 1.2);
    assert_eq!(output.status.code(), Some(1));
    let turned: Value = serde_json::from_slice(&output.stdout).unwrap();
    let held = [0, 1, 2].map(|motor| turned[motor]["held"].as_bool().unwrap());
    assert_eq!(held, [true, false, false]);
    assert_eq!(turned[1]["sign"], -1);
}

#[test]
fn a_load_cell_is_calibrated_with_weights_and_the_board_is_set_to_it() {
    let mut board = Board::new(&["--slack"]);
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
    let output = calibrate(&mut board, &arguments, &hangs, 0.0);
    assert!(output.status.success(), "{}", errors(&output));
    let found: Value = serde_json::from_slice(&output.stdout).unwrap();
    let settings = board.told(&["settings", "get"]);
    let cell = &settings["axes"][1];
    for key in ["cell_n_per_code", "cell_zero_code"] {
        assert_eq!(
            cell[key].as_f64().unwrap() as f32,
            found[key][1].as_f64().unwrap() as f32
        );
    }
    // The cell reads 0.8 N too little; its range is 250 N in 65 520 codes.
    let zero = found["zero_code"].as_f64().unwrap();
    assert!(
        (zero - (20.0 - 0.8) / 250.0 * 65_520.0).abs() < 2.0,
        "{zero}"
    );
}

#[test]
fn a_calibration_ends_with_its_standard_input() {
    let board = Board::new(&[]);
    let mut command = board.command(&["calibrate", "motors"]);
    let output = command.stdin(Stdio::null()).output().unwrap();
    assert_eq!(output.status.code(), Some(2));
    assert!(errors(&output).contains("standard input has ended"));
}

#[test]
fn a_driven_leg_is_not_calibrated() {
    let board = Board::new(&[]);
    assert_eq!(board.told(&["hold"])["state"], "held");
    let (code, told) = board.refused(&["calibrate", "motors"]);
    assert_eq!(code, Some(2));
    assert!(told.contains("run `leg disarm` first"), "{told}");
    let (code, told) = board.refused(&["settings", "set", "--rig", "universal"]);
    assert_eq!(code, Some(2));
    assert!(told.contains("run `leg disarm` first"), "{told}");
}
