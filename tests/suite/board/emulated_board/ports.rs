//! The port, and who shares it.

use super::board::{BoardUnderTest, errors, signal};
use serde_json::Value;
use std::fs::File;
use std::io::{BufRead, BufReader};
use std::process::Child;

#[test]
fn a_monitor_goes_on_when_the_command_that_had_the_port_ends() {
    let board = BoardUnderTest::new(&[]);
    // The first to open the port passes it on to the others.
    let mut first = board.begin(&["monitor", "--json", "--for", "3600"]);
    let mut next_of_first = printed(&mut first);
    next_of_first();
    let mut second = board.begin(&["monitor", "--json", "--for", "3600"]);
    let mut next = printed(&mut second);
    next();
    signal(&first, "-INT");
    assert!(first.wait().unwrap().success());
    // More than what the first may have passed on before its end.
    let end_s = next();
    while next() < end_s + 2.0 {}
    signal(&second, "-INT");
    let output = second.wait_with_output().unwrap();
    assert!(output.status.success(), "{}", errors(&output));
}

/// Reads what a monitor prints, line by line: the leg's time in each.
fn printed(monitor: &mut Child) -> impl FnMut() -> f64 + use<> {
    let mut lines = BufReader::new(monitor.stdout.take().unwrap()).lines();
    move || {
        let line = lines.next().unwrap().unwrap();
        let line: Value = serde_json::from_str(&line).unwrap();
        line["time_s"].as_f64().unwrap()
    }
}

#[test]
fn a_port_that_goes_in_mid_command_is_named() {
    let mut board = BoardUnderTest::slow();
    let moving = board.begin_move();
    board.process.kill().unwrap();
    let output = moving.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(2));
    let told = errors(&output);
    assert!(
        told.contains("is lost") && told.contains("plug the board in again"),
        "{told}"
    );
}

#[test]
fn a_busy_port_is_named() {
    let board = BoardUnderTest::new(&[]);
    // Another program, which does not share.
    let other = File::open(&board.port).unwrap();
    other.lock().unwrap();
    let (code, told) = board.refused(&["stop"]);
    assert_eq!(code, Some(2));
    assert!(told.contains("is busy") && told.contains("fuser"), "{told}");
    other.unlock().unwrap();
    assert_eq!(board.json(&["stop"])["state"], "disarmed");
}

#[test]
fn a_suspended_command_that_has_the_port_is_named() {
    let board = BoardUnderTest::new(&[]);
    let mut first = board.begin(&["monitor", "--json", "--for", "3600"]);
    // It has the port once it prints.
    let mut next = printed(&mut first);
    next();
    signal(&first, "-STOP");
    let (code, told) = board.refused(&["stop"]);
    signal(&first, "-CONT");
    assert_eq!(code, Some(2));
    assert!(
        told.contains("another `leg` has the port") && told.contains("resume or end it"),
        "{told}"
    );
    // It is said early, too.
    assert!(told.contains("tried again"), "{told}");
    assert_eq!(board.json(&["stop"])["state"], "disarmed");
    first.kill().unwrap();
    first.wait().unwrap();
}

#[test]
fn a_port_that_cannot_be_shared_serves_one_command() {
    let board = BoardUnderTest::new(&[]);
    let mut stop = board.command(&["stop", "--json"]);
    let output = stop
        .env("TMPDIR", "/dev/null/no-directory")
        .output()
        .unwrap();
    assert!(output.status.success(), "{}", errors(&output));
    assert!(
        errors(&output).contains("other commands cannot use this port meanwhile"),
        "{}",
        errors(&output)
    );
}
