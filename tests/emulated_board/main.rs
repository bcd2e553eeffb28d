//! Commands in processes of their own, on one emulated board behind a pseudo-terminal: the same serial code as for a board.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

mod board;
mod calibration;

use board::{Board, errors, move_to, signal};
use leg_host_tools::transport::Transport;
use leg_host_tools::transport::serial::Serial;
use serde_json::Value;
use std::fs::File;
use std::io::{BufRead, BufReader, ErrorKind};
use std::thread::sleep;
use std::time::{Duration, Instant};

#[test]
fn a_board_keeps_its_state_from_command_to_command() {
    let board = Board::new(&["--slack"]);
    let (code, told) = board.refused(&move_to("10"));
    assert_eq!(code, Some(2));
    assert!(told.contains("does not know its zero"), "{told}");
    assert_eq!(board.told(&["home"])["state"], "held");
    let moved = board.told(&move_to("10"));
    assert_eq!(moved["state"], "held");
    assert!((moved["tilt_deg"].as_f64().unwrap() - 10.0).abs() < 0.05);
    let stiff = board.told(&["stiffness", "95"]);
    assert!((stiff["stiffness_nm_per_rad"].as_f64().unwrap() - 95.0).abs() < 0.3);
    assert!((stiff["tilt_deg"].as_f64().unwrap() - 10.0).abs() < 0.05);
    assert_eq!(board.told(&["stop"])["state"], "held");
    assert_eq!(board.told(&["disarm"])["state"], "disarmed");
}

#[test]
fn stop_is_obeyed_while_another_command_drives() {
    let board = Board::slow();
    let moving = board.begin_move();
    let (code, told) = board.refused(&move_to("5"));
    assert_eq!(code, Some(2), "{told}");
    assert!(told.contains("another host drives the leg"), "{told}");
    let stopped = board.told(&["stop"]);
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

#[test]
fn monitor_and_log_run_beside_a_move() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("leg.csv");
    let board = Board::new(&[]);
    let monitor = board.begin(&["monitor", "--json", "--rate", "50", "--for", "3"]);
    let name = file.display().to_string();
    let log = board.begin(&[
        "log", "--out", &name, "--rate", "200", "--for", "2", "--json",
    ]);
    assert_eq!(board.told(&move_to("15"))["state"], "held");
    let seen = String::from_utf8(monitor.wait_with_output().unwrap().stdout).unwrap();
    let states: Vec<Value> = seen
        .lines()
        .map(|line| serde_json::from_str::<Value>(line).unwrap()["state"].clone())
        .collect();
    assert!(states.contains(&Value::from("active")), "{states:?}");
    assert!(!states.contains(&Value::from("off")), "{states:?}");
    let output = log.wait_with_output().unwrap();
    assert!(output.status.success(), "{}", errors(&output));
    let logged: Value = serde_json::from_slice(&output.stdout).unwrap();
    let rows = std::fs::read_to_string(&file).unwrap().lines().count() as u64;
    assert_eq!(logged["count"].as_u64().unwrap() + 1, rows);
    // The introductions of the other two end the telemetry; it was asked for again before it was missed.
    assert_eq!(logged["lost"], 0);
    assert!(logged["longest_s"].as_f64().unwrap() < 0.15, "{logged}");
}

#[test]
fn two_logs_share_a_rate_and_not_two() {
    let folder = tempfile::tempdir().unwrap();
    let board = Board::new(&[]);
    let log = |name: &str, rate: &str| {
        let file = folder.path().join(name).display().to_string();
        let log = board.begin(&["log", "--out", &file, "--rate", rate, "--for", "3"]);
        sleep(Duration::from_millis(700));
        log
    };
    let logs = [log("a.csv", "100"), log("b.csv", "100")];
    for log in logs {
        let output = log.wait_with_output().unwrap();
        assert!(output.status.success(), "{}", errors(&output));
    }
    let logs = [log("a.csv", "100"), log("b.csv", "40")];
    let outputs = logs.map(|log| log.wait_with_output().unwrap());
    let failed: Vec<_> = outputs
        .iter()
        .filter(|output| !output.status.success())
        .collect();
    let [failed] = failed.as_slice() else {
        panic!("{} of the logs fail", failed.len());
    };
    assert_eq!(failed.status.code(), Some(1));
    let told = errors(failed);
    assert!(
        told.contains("another host has asked the leg to tell of itself every")
            && told.contains("end the other `leg log`"),
        "{told}"
    );
}

#[test]
fn a_log_that_is_ended_lets_the_line_go() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("leg.csv").display().to_string();
    let board = Board::new(&[]);
    let log = board.begin(&["log", "--out", &file, "--for", "60"]);
    sleep(Duration::from_secs(1));
    signal(&log, "-INT");
    let output = log.wait_with_output().unwrap();
    assert!(output.status.success(), "{}", errors(&output));
    let mut line = Serial::open(&board.port).unwrap();
    let heard = line.receive(&mut [0; 99], Duration::from_millis(500));
    assert_eq!(heard.unwrap_err().kind(), ErrorKind::TimedOut);
}

#[test]
fn a_log_goes_on_over_new_settings() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("leg.csv");
    let board = Board::new(&[]);
    let name = file.display().to_string();
    let log = board.begin(&["log", "--out", &name, "--for", "3"]);
    sleep(Duration::from_millis(700));
    let set = board.run(&["settings", "set", "--rig", "table1"]);
    assert!(set.status.success(), "{}", errors(&set));
    let output = log.wait_with_output().unwrap();
    assert!(output.status.success(), "{}", errors(&output));
    let text = std::fs::read_to_string(&file).unwrap();
    let first_column = |row: &str| row.split(',').next().unwrap().parse::<f64>().unwrap();
    let times: Vec<f64> = text.lines().skip(1).map(first_column).collect();
    assert!(times.len() > 200, "{}", times.len());
    assert!(times.is_sorted_by(|a, b| a < b));
}

#[test]
fn a_monitor_goes_on_when_the_command_that_had_the_port_ends() {
    let board = Board::new(&[]);
    // The first to open the port passes it on to the others.
    let first = board.begin(&["monitor", "--json", "--for", "0.7"]);
    sleep(Duration::from_millis(300));
    let second = board.begin(&["monitor", "--json", "--for", "2"]);
    assert!(first.wait_with_output().unwrap().status.success());
    let output = second.wait_with_output().unwrap();
    assert!(output.status.success(), "{}", errors(&output));
    assert!(output.stdout.iter().filter(|byte| **byte == b'\n').count() > 5);
}

#[test]
fn a_port_that_goes_in_mid_command_is_named() {
    let mut board = Board::slow();
    let moving = board.begin_move();
    board.process.kill().unwrap();
    let output = moving.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(2));
    let told = errors(&output);
    assert!(
        told.contains("is gone") && told.contains("plug the board in again"),
        "{told}"
    );
}

#[test]
fn a_host_that_dies_in_mid_move_leaves_the_leg_in_hold() {
    let board = Board::slow();
    let mut moving = board.begin_move();
    moving.kill().unwrap();
    moving.wait().unwrap();
    let begun = Instant::now();
    while board.state()["state"] != "held" {
        assert!(begun.elapsed() < Duration::from_secs(20));
    }
    let state = board.state();
    assert_eq!(state["faults"][0]["fault"], "command_timeout");
    let (code, told) = board.refused(&move_to("5"));
    assert_eq!(code, Some(2));
    assert!(
        told.contains("fault 20, no command") && told.contains("leg clear"),
        "{told}"
    );
    assert_eq!(board.told(&["clear"])["state"], "held");
    assert_eq!(board.told(&move_to("5"))["state"], "held");
}

#[test]
fn ctrl_c_leaves_the_leg_in_hold_without_a_fault() {
    let board = Board::slow();
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
fn a_busy_port_is_named() {
    let board = Board::new(&[]);
    // Another program, which does not share.
    let other = File::open(&board.port).unwrap();
    other.lock().unwrap();
    let (code, told) = board.refused(&["stop"]);
    assert_eq!(code, Some(2));
    assert!(told.contains("is busy") && told.contains("fuser"), "{told}");
    other.unlock().unwrap();
    assert_eq!(board.told(&["stop"])["state"], "disarmed");
}

#[test]
fn a_suspended_command_that_has_the_port_is_named() {
    let board = Board::new(&[]);
    let mut first = board.begin(&["monitor", "--json", "--for", "60"]);
    // It has the port once it prints.
    let mut line = String::new();
    let stdout = first.stdout.take().unwrap();
    BufReader::new(stdout).read_line(&mut line).unwrap();
    signal(&first, "-STOP");
    let (code, told) = board.refused(&["stop"]);
    signal(&first, "-CONT");
    assert_eq!(code, Some(2));
    assert!(
        told.contains("another `leg` has the port") && told.contains("resume or end it"),
        "{told}"
    );
    assert_eq!(board.told(&["stop"])["state"], "disarmed");
    first.kill().unwrap();
    first.wait().unwrap();
}

#[test]
fn a_port_that_cannot_be_shared_serves_one_command() {
    let board = Board::new(&[]);
    let mut stop = board.command(&["stop", "--json"]);
    let output = stop.env("TMPDIR", "/dev/null/no-folder").output().unwrap();
    assert!(output.status.success(), "{}", errors(&output));
    assert!(
        errors(&output).contains("other commands cannot use this port meanwhile"),
        "{}",
        errors(&output)
    );
}

#[test]
fn a_fault_in_mid_move_is_told_with_its_cure() {
    let mut board = Board::slow();
    let moving = board.begin_move();
    board.touch(r#"{"emergency_stop":true}"#);
    let output = moving.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(1));
    assert!(
        errors(&output).contains("fault 23, emergency stop"),
        "{}",
        errors(&output)
    );
    let (code, told) = board.refused(&["clear"]);
    assert_eq!(code, Some(2));
    assert!(told.contains("release it when it is safe"), "{told}");
    board.touch(r#"{"emergency_stop":false}"#);
    assert_eq!(board.told(&["clear"])["state"], "disarmed");
}

#[test]
fn datagrams_reach_whoever_listens() {
    let listener = std::net::UdpSocket::bind("127.0.0.1:0").unwrap();
    listener
        .set_read_timeout(Some(Duration::from_secs(10)))
        .unwrap();
    let address = listener.local_addr().unwrap().to_string();
    let board = Board::new(&[]);
    let mut monitor = board.begin(&["monitor", "--udp", &address, "--for", "1"]);
    let mut bytes = [0; 4096];
    let count = listener.recv(&mut bytes).unwrap();
    let line: Value = serde_json::from_slice(&bytes[..count]).unwrap();
    assert_eq!(line["state"], "disarmed");
    assert!(monitor.wait().unwrap().success());
}

#[test]
fn an_emulated_board_ends_with_ctrl_c_and_keeps_real_time() {
    let mut board = Board::new(&[]);
    let before = (Instant::now(), board.state()["time_s"].as_f64().unwrap());
    sleep(Duration::from_secs(1));
    let after = board.state()["time_s"].as_f64().unwrap() - before.1;
    // Slower on a machine that has much else to do.
    assert!(after > 0.1 && after < before.0.elapsed().as_secs_f64() + 0.1);
    signal(&board.process, "-INT");
    assert!(board.process.wait().unwrap().success());
}
