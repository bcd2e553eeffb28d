//! Commands in processes of their own, on one emulated board behind a pseudo-terminal: the same serial code as for a board.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

pub mod board;
mod calibration;
mod first_power_up;
mod logs;
mod new_board;
mod page;
mod paths;
mod ports;
mod qemu;
mod recorder;
mod tcp;
mod terminal;

use crate::common::stalls::wait_for;
use board::{BoardUnderTest, IMPATIENT, SLOW, errors, move_to, signal};
use serde_json::Value;
use std::process::Command;
use std::time::Instant;

#[test]
fn a_board_keeps_its_state_from_command_to_command() {
    let board = BoardUnderTest::new(&["--slack"]);
    let (code, told) = board.refused(&move_to("10"));
    assert_eq!(code, Some(2));
    assert!(told.contains("does not know its zero"), "{told}");
    assert_eq!(board.state()["state"], "disarmed");
    assert_eq!(board.json(&["home"])["state"], "held");
    let moved = board.json(&move_to("10"));
    assert_eq!(moved["state"], "keeping station");
    assert!((moved["tilt_deg"].as_f64().unwrap() - 10.0).abs() < 0.05);
    let stiff = board.json(&["stiffness", "95"]);
    assert!((stiff["stiffness_nm_per_rad"].as_f64().unwrap() - 95.0).abs() < 0.3);
    assert!((stiff["tilt_deg"].as_f64().unwrap() - 10.0).abs() < 0.05);
    assert_eq!(board.json(&["stop"])["state"], "held");
    assert_eq!(board.json(&["disarm"])["state"], "disarmed");
}

#[test]
fn stop_is_obeyed_while_another_command_drives() {
    let board = BoardUnderTest::slow();
    let moving = board.begin_move();
    let (code, told) = board.refused(&move_to("5"));
    assert_eq!(code, Some(2), "{told}");
    assert!(told.contains("another host drives the leg"), "{told}");
    let stopped = board.json(&["stop"]);
    assert_eq!(stopped["state"], "held");
    let tilt = stopped["tilt_deg"].as_f64().unwrap();
    let output = moving.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(1));
    assert!(
        errors(&output).contains("another host stopped it"),
        "{}",
        errors(&output)
    );
    assert!(tilt < 28.0, "stopped on the way: {tilt}");
}

/// What opens a leg for a stop opens it for nothing else: on CAN that would be refused beside a program that drives it, and a chip
/// would be homed first.
#[test]
fn a_stop_is_all_that_a_stop_opens_a_leg_for() {
    let mut stop = Command::new(env!("CARGO_BIN_EXE_leg-under-test"));
    let output = stop.args(["stop", "--on", "chip", "--json"]).output();
    let output = output.unwrap();
    assert!(output.status.success(), "{}", errors(&output));
    let stopped: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(stopped["state"], "disarmed");
    assert_eq!(stopped["homed"], false);
}

#[test]
fn a_host_that_dies_in_mid_move_leaves_the_leg_in_hold() {
    let board = BoardUnderTest::with_sections(&[IMPATIENT, SLOW].concat(), &[]);
    let mut moving = board.begin_move();
    moving.kill().unwrap();
    moving.wait().unwrap();
    wait_for("a hold", || {
        (board.state()["state"] == "held").then_some(())
    });
    let state = board.state();
    assert_eq!(state["faults"][0], "no command");
    let (code, told) = board.refused(&move_to("5"));
    assert_eq!(code, Some(2));
    assert!(
        told.contains("fault 20, no command") && told.contains("leg clear"),
        "{told}"
    );
    assert_eq!(board.json(&["clear"])["state"], "held");
    assert_eq!(board.json(&move_to("5"))["state"], "keeping station");
}

#[test]
fn ctrl_c_leaves_the_leg_in_hold_without_a_fault() {
    let board = BoardUnderTest::slow();
    let moving = board.begin_move();
    signal(&moving, "-INT");
    let output = moving.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(1));
    assert!(
        errors(&output).contains("ended by Ctrl-C"),
        "{}",
        errors(&output)
    );
    let state = board.state();
    assert_eq!(state["state"], "held");
    assert_eq!(state["faults"], Value::Array(vec![]));
    assert!(state["tilt_deg"].as_f64().unwrap() < 28.0);
}

#[test]
fn ctrl_c_in_a_disarm_lets_the_leg_go_on_to_relax() {
    let board = BoardUnderTest::slow();
    // Half a minute on its way down, for what a busy machine takes meanwhile.
    assert_eq!(board.json(&move_to("15"))["state"], "keeping station");
    let disarming = board.wait_until_moving(board.begin(&["disarm"]));
    signal(&disarming, "-INT");
    let output = disarming.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(1));
    let told = errors(&output);
    assert!(told.contains("ended by Ctrl-C"), "{told}");
    assert_eq!(board.state()["state"], "active", "it is led down yet");
    wait_for("a relaxed leg", || {
        (board.state()["state"] == "disarmed").then_some(())
    });
    assert_eq!(board.state()["faults"], Value::Array(vec![]));
}

#[test]
fn ctrl_c_in_a_jog_leaves_the_leg_disarmed() {
    let board = BoardUnderTest::new(&["--slack"]);
    // A jog takes five seconds: on a busy machine it may be over before it is seen.
    let interrupted = || {
        let mut jogging = board.begin(&["jog", "1", "--travel=-10"]);
        wait_for("a jog", || {
            let over = jogging.try_wait().unwrap().is_some();
            (over || board.state()["state"] == "jogging").then_some(())
        });
        signal(&jogging, "-INT");
        let output = jogging.wait_with_output().unwrap();
        (!output.status.success()).then_some(output)
    };
    let output = wait_for("a jog that is interrupted", interrupted);
    assert_eq!(output.status.code(), Some(1));
    let told = errors(&output);
    assert!(told.contains("ended by Ctrl-C"), "{told}");
    let state = board.state();
    assert_eq!(state["state"], "disarmed");
    assert_eq!(state["faults"], Value::Array(vec![]));
}

#[test]
fn a_fault_in_mid_move_is_reported_with_its_remedy() {
    let mut board = BoardUnderTest::slow();
    let moving = board.begin_move();
    board.act(r#"{"emergency_stop":true}"#);
    let output = moving.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(1));
    assert!(
        errors(&output).contains("fault 23, emergency stop"),
        "{}",
        errors(&output)
    );
    let output = board.run_until_acknowledged(&["clear"]);
    assert_eq!(output.status.code(), Some(2));
    let told = errors(&output);
    assert!(told.contains("release it when it is safe"), "{told}");
    board.act(r#"{"emergency_stop":false}"#);
    let output = board.run_until_acknowledged(&["clear"]);
    assert!(output.status.success(), "{}", errors(&output));
    assert_eq!(board.state()["state"], "disarmed");
}

#[test]
fn an_emulated_board_ends_with_ctrl_c_and_does_not_run_ahead_of_the_clock() {
    let mut board = BoardUnderTest::new(&[]);
    let before = (Instant::now(), board.state()["time_s"].as_f64().unwrap());
    // Slower on a machine that has much else to do.
    board.wait(1.0);
    let after = board.state()["time_s"].as_f64().unwrap() - before.1;
    assert!(after < before.0.elapsed().as_secs_f64() + 0.1, "{after}");
    signal(&board.process, "-INT");
    assert!(board.process.wait().unwrap().success());
}
