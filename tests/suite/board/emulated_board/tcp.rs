//! An emulated board on TCP.

use super::board::{BoardUnderTest, PATIENT, SLOW, errors, move_to};
use std::process::Command;

const LEG: &str = env!("CARGO_BIN_EXE_leg-under-test");

#[test]
fn a_leg_on_tcp_moves_and_is_stopped_beside() {
    let board = BoardUnderTest::with_sections(&[PATIENT, SLOW].concat(), &["--tcp"]);
    assert!(board.port.starts_with("tcp://127.0.0.1:"), "{}", board.port);
    let moving = board.begin_move();
    let stopped = board.json(&["stop"]);
    assert_eq!(stopped["state"], "held");
    assert!(stopped["tilt_deg"].as_f64().unwrap() < 28.0);
    let output = moving.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(1));
    let told = errors(&output);
    assert!(told.contains("another host stopped it"), "{told}");
}

#[test]
fn a_leg_on_tcp_that_goes_in_mid_move_is_named() {
    let mut board = BoardUnderTest::with_sections(&[PATIENT, SLOW].concat(), &["--tcp"]);
    let moving = board.begin_move();
    board.process.kill().unwrap();
    board.process.wait().unwrap();
    let output = moving.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(2));
    let told = errors(&output);
    assert!(told.contains(&board.port), "{told}");
    let (code, told) = board.refused(&move_to("5"));
    assert_eq!(code, Some(2));
    assert!(told.contains("start `leg emulate --tcp`"), "{told}");
}

#[test]
fn an_address_of_another_machine_is_refused() {
    // An address for documentation: no machine has it.
    let emulate = Command::new(LEG)
        .args(["emulate", "--tcp", "192.0.2.1:5000"])
        .output()
        .unwrap();
    assert_eq!(emulate.status.code(), Some(2));
    let told = errors(&emulate);
    assert!(
        told.contains("cannot listen on 192.0.2.1:5000") && told.contains("127.0.0.1:5000"),
        "{told}"
    );
}
