//! Read-only commands: logs, monitors, datagrams.

use super::board::{BoardUnderTest, LOG_STALL, PATIENT, SLOW, errors, move_to, signal};
use crate::common::stalls::{PATIENCE, StallWatch, longest_stall, unless_stalled, wait_for};
use leg_host::recording;
use leg_host::transport::Transport;
use leg_host::transport::serial::Serial;
use serde_json::Value;
use std::fs;
use std::io::ErrorKind;
use std::path::Path;
use std::process::{Child, Output};
use std::time::Duration;

#[test]
fn monitor_and_log_run_beside_a_move() {
    unless_stalled(LOG_STALL, || {
        let directory = tempfile::tempdir().unwrap();
        log_beside_a_move(directory.path())
    });
}

/// What is wrong with a log beside a monitor and a move, and for how long log or monitor were stalled.
fn log_beside_a_move(directory: &Path) -> (Result<(), String>, Duration) {
    let (file, seen) = (directory.join("leg.csv"), directory.join("seen.jsonl"));
    let board = BoardUnderTest::with_sections(&[PATIENT, SLOW].concat(), &[]);
    let board_watch = StallWatch::begin(&board.process);
    let name = file.display().to_string();
    let log = board.begin(&[
        "log", "--out", &name, "--rate", "200", "--for", "3600", "--json",
    ]);
    // The log is the one that has the port: what is on its way is lost where the one that has it ends, as the move does.
    wait_for("a recording", || recording::unfinished(&file));
    let log_watch = StallWatch::begin(&log);
    let monitor = ["monitor", "--json", "--rate", "50", "--for", "3600"];
    let monitor = board.begin_into(&seen, &monitor);
    let monitor_watch = StallWatch::begin(&monitor);
    let mut moving = board.begin(&move_to("2"));
    while moving.try_wait().unwrap().is_none() {
        // Each of these introduces itself, too.
        board.state();
    }
    let moved = moving.wait_with_output().unwrap();
    assert!(moved.status.success(), "{}", errors(&moved));
    let stall = longest_stall([log_watch, monitor_watch, board_watch]);
    assert!(interrupted(monitor).status.success());
    let output = interrupted(log);
    assert!(output.status.success(), "{}", errors(&output));
    let seen = fs::read_to_string(seen).unwrap();
    let states: Vec<Value> = seen
        .lines()
        .map(|line| serde_json::from_str::<Value>(line).unwrap()["state"].clone())
        .collect();
    assert!(!states.contains(&Value::from("off")), "{states:?}");
    let logged: Value = serde_json::from_slice(&output.stdout).unwrap();
    let rows = fs::read_to_string(&file).unwrap().lines().count() as u64;
    assert_eq!(logged["count"].as_u64().unwrap() + 1, rows);
    // The introductions of the others end the telemetry; it was asked for again before it was missed.
    let whole = logged["lost"] == 0 && logged["longest_s"].as_f64().unwrap() < 0.15;
    let right = whole && states.contains(&Value::from("active"));
    let wrong = || format!("{logged}, {states:?}");
    (right.then_some(()).ok_or_else(wrong), stall)
}

/// Ends a command that runs yet, as Ctrl-C does.
fn interrupted(command: Child) -> Output {
    unless_ended(command).unwrap()
}

/// The same; the errors of one that has ended by itself.
fn unless_ended(mut command: Child) -> Result<Output, String> {
    let runs = command.try_wait().unwrap().is_none();
    if runs {
        signal(&command, "-INT");
    }
    let output = command.wait_with_output().unwrap();
    if runs {
        Ok(output)
    } else {
        Err(format!("it has ended: {}", errors(&output)))
    }
}

/// Each gets its own rate, whoever asked last, and goes on when the other has ended.
#[test]
fn two_logs_record_at_their_own_rates() {
    unless_stalled(LOG_STALL, || {
        let directory = tempfile::tempdir().unwrap();
        let board = BoardUnderTest::new(&[]);
        let mut watches = vec![];
        let mut outcome = Ok(());
        for rates_hz in [[100.0, 100.0], [100.0, 40.0], [40.0, 100.0]] {
            watches.push(StallWatch::begin(&board.process));
            let begin = |name: &str, rate_hz: f64| {
                let file = directory.path().join(format!("{name} {rates_hz:?}.csv"));
                board.begin_log(&file, &["--rate", &rate_hz.to_string(), "--json"])
            };
            let [a, b] = [begin("a", rates_hz[0]), begin("b", rates_hz[1])];
            watches.extend([&a, &b].map(StallWatch::begin));
            // No other command introduces itself meanwhile: that ends the telemetry for a moment.
            std::thread::sleep(Duration::from_secs(2));
            let logged = unless_ended(a);
            std::thread::sleep(Duration::from_secs(1));
            for (ended, rate_hz) in [logged, unless_ended(b)].into_iter().zip(rates_hz) {
                let recorded = ended.and_then(|output| recorded_at(&output, rate_hz));
                outcome = outcome.and(recorded);
            }
        }
        let stall = longest_stall(watches);
        (outcome, stall)
    });
}

/// Nothing is lost and nothing comes late where another log begins and ends beside it.
#[test]
fn a_log_goes_on_where_another_one_ends() {
    unless_stalled(LOG_STALL, || {
        let directory = tempfile::tempdir().unwrap();
        let board = BoardUnderTest::new(&[]);
        let log = board.begin_log(&directory.path().join("first.csv"), &["--json"]);
        let watches = [&board.process, &log].map(StallWatch::begin);
        for name in ["second.csv", "third.csv"] {
            let second = board.begin_log(&directory.path().join(name), &[]);
            std::thread::sleep(Duration::from_millis(500));
            assert!(interrupted(second).status.success());
            std::thread::sleep(Duration::from_millis(500));
        }
        let ended = unless_ended(log);
        let stall = longest_stall(watches);
        let outcome = ended.and_then(|output| {
            let logged: Value = serde_json::from_slice(&output.stdout).unwrap();
            let whole = logged["lost"] == 0 && logged["longest_s"].as_f64().unwrap() < 0.1;
            whole.then_some(()).ok_or_else(|| logged.to_string())
        });
        (outcome, stall)
    });
}

/// A stream that comes more often than the system's shortest wait does not keep a monitor from asking.
#[test]
fn a_monitor_keeps_its_rate_beside_a_fast_log() {
    unless_stalled(LOG_STALL, || {
        let directory = tempfile::tempdir().unwrap();
        let board = BoardUnderTest::new(&[]);
        let log = board.begin_log(&directory.path().join("leg.csv"), &["--rate", "400"]);
        let watches = [&board.process, &log].map(StallWatch::begin);
        let monitor = board.begin(&["monitor", "--json", "--rate", "50", "--for", "2"]);
        let monitor_watch = StallWatch::begin(&monitor);
        let shown = monitor.wait_with_output().unwrap();
        let lines = shown.stdout.iter().filter(|byte| **byte == b'\n').count();
        let ended = unless_ended(log).map(|_| ());
        let stall = longest_stall(watches.into_iter().chain([monitor_watch]));
        let enough = (lines > 50).then_some(());
        let outcome = ended.and(enough.ok_or_else(|| format!("{lines} lines in 2 s")));
        (outcome, stall)
    });
}

/// Whether a log had a rate, but for the moments in which another host came or went.
fn recorded_at(output: &Output, rate_hz: f64) -> Result<(), String> {
    let logged: Value = serde_json::from_slice(&output.stdout)
        .map_err(|error| format!("{error}: {}", errors(output)))?;
    let number = |name: &str| logged[name].as_f64().unwrap();
    let off = number("every_s") * rate_hz - 1.0;
    let right = output.status.success() && off.abs() < 0.2 && number("longest_s") < 0.4;
    right
        .then_some(())
        .ok_or_else(|| format!("{rate_hz} Hz: {logged}"))
}

#[test]
fn a_log_that_is_ended_lets_the_line_go() {
    let directory = tempfile::tempdir().unwrap();
    let board = BoardUnderTest::new(&[]);
    let log = board.begin_log(&directory.path().join("leg.csv"), &[]);
    let output = interrupted(log);
    assert!(output.status.success(), "{}", errors(&output));
    let mut line = Serial::open(&board.port).unwrap();
    // Where it had to ask more than once to be let go, answers may still come.
    wait_for("silence", || {
        let heard = line.receive(&mut [0; 99], Duration::from_millis(500));
        let error = heard.err()?.kind();
        // A process that goes on after a stop is interrupted.
        let known = [ErrorKind::TimedOut, ErrorKind::Interrupted];
        assert!(known.contains(&error), "{error}");
        (error == ErrorKind::TimedOut).then_some(())
    });
}

#[test]
fn a_log_goes_on_over_new_settings() {
    let directory = tempfile::tempdir().unwrap();
    let file = directory.path().join("leg.csv");
    let board = BoardUnderTest::new(&[]);
    let log = board.begin_log(&file, &[]);
    let time_s = || board.state()["time_s"].as_f64().unwrap();
    board.wait(0.5);
    let before_s = time_s();
    let set = board.run(&["settings", "set", "--rig", "table1"]);
    assert!(set.status.success(), "{}", errors(&set));
    let after_s = time_s();
    board.wait(2.0);
    let output = interrupted(log);
    assert!(output.status.success(), "{}", errors(&output));
    let text = fs::read_to_string(&file).unwrap();
    let first_column = |row: &str| row.split(',').next().unwrap().parse::<f64>().unwrap();
    let times: Vec<f64> = text.lines().skip(1).map(first_column).collect();
    assert!(times.is_sorted_by(|a, b| a < b));
    for there in [times[0] < before_s, times[times.len() - 1] > after_s] {
        assert!(there, "{before_s} to {after_s}: {} rows", times.len());
    }
}

#[test]
fn datagrams_reach_whoever_listens() {
    let listener = std::net::UdpSocket::bind("127.0.0.1:0").unwrap();
    listener.set_read_timeout(Some(PATIENCE)).unwrap();
    let address = listener.local_addr().unwrap().to_string();
    let board = BoardUnderTest::new(&[]);
    let mut monitor = board.begin(&["monitor", "--udp", &address, "--for", "1"]);
    let mut bytes = [0; 4096];
    let count = listener.recv(&mut bytes).unwrap();
    let line: Value = serde_json::from_slice(&bytes[..count]).unwrap();
    assert_eq!(line["state"], "disarmed");
    assert!(monitor.wait().unwrap().success());
}
