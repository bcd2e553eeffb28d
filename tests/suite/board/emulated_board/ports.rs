//! The port, and who shares it.

use super::board::{BoardUnderTest, IMPATIENT, SLOW, errors, signal};
use serde_json::Value;
use std::fs::File;
use std::io::{BufRead, BufReader};
use std::process::Child;
use std::thread::sleep;
use std::time::{Duration, Instant};

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
    let begun = Instant::now();
    let (code, told) = board.refused(&["stop"]);
    let took = begun.elapsed();
    signal(&first, "-CONT");
    assert_eq!(code, Some(2));
    assert!(
        told.contains("another `leg` has the port") && told.contains("resume or end it"),
        "{told}"
    );
    // It is said every two seconds, and given up after ten; a busy machine takes longer.
    let notices = told.matches("tried again").count();
    assert!((3..=5).contains(&notices), "{told}");
    let given_up = Duration::from_secs(10);
    assert!((given_up..2 * given_up).contains(&took), "{took:?}");
    assert_eq!(board.json(&["stop"])["state"], "disarmed");
    first.kill().unwrap();
    first.wait().unwrap();
}

#[test]
fn a_move_that_is_suspended_leaves_the_leg_in_hold() {
    let board = BoardUnderTest::with_sections(&[IMPATIENT, SLOW].concat(), &[]);
    let moving = board.begin_move();
    signal(&moving, "-STOP");
    // It has the port, so that nobody sees the leg before it goes on: by then the leg has waited for a command for too long.
    // The emulator leaves out the time for which it is kept from running: by the clock the leg's 6 s take longer. The move takes 50 s.
    sleep(Duration::from_secs(30));
    signal(&moving, "-CONT");
    let output = moving.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(1));
    let told = errors(&output);
    assert!(told.contains("fault 20, no command"), "{told}");
    let state = board.state();
    assert_eq!(state["state"], "held");
    assert!(state["tilt_deg"].as_f64().unwrap() < 28.0, "{state}");
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
