//! Read-only commands: logs, monitors, datagrams.

use super::board::{BoardUnderTest, errors, move_to, signal};
use leg_host::recording;
use leg_host::transport::Transport;
use leg_host::transport::serial::Serial;
use serde_json::Value;
use std::io::ErrorKind;
use std::thread::sleep;
use std::time::{Duration, Instant};

/// More than a command takes to start.
const PATIENCE: Duration = Duration::from_secs(20);

#[test]
fn monitor_and_log_run_beside_a_move() {
    let directory = tempfile::tempdir().unwrap();
    let file = directory.path().join("leg.csv");
    let board = BoardUnderTest::new(&[]);
    let name = file.display().to_string();
    let log = board.begin(&[
        "log", "--out", &name, "--rate", "200", "--for", "4", "--json",
    ]);
    // The log is the one that has the port: what is on its way is lost where the one that has it ends, as the move does.
    let begun = Instant::now();
    while recording::unfinished(&file).is_none() {
        assert!(begun.elapsed() < PATIENCE, "nothing is recorded");
        sleep(Duration::from_millis(10));
    }
    let monitor = board.begin(&["monitor", "--json", "--rate", "50", "--for", "3"]);
    assert_eq!(board.json(&move_to("15"))["state"], "keeping_station");
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
    assert_eq!(logged["lost"], 0, "{logged}");
    assert!(logged["longest_s"].as_f64().unwrap() < 0.15, "{logged}");
}

#[test]
fn two_logs_share_a_rate_and_not_two() {
    let directory = tempfile::tempdir().unwrap();
    let board = BoardUnderTest::new(&[]);
    let log = |name: &str, rate: &str| {
        let file = directory.path().join(name).display().to_string();
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
        told.contains("another host has asked the leg to report every")
            && told.contains("end the other `leg log`"),
        "{told}"
    );
}

#[test]
fn a_log_that_is_ended_lets_the_line_go() {
    let directory = tempfile::tempdir().unwrap();
    let file = directory.path().join("leg.csv").display().to_string();
    let board = BoardUnderTest::new(&[]);
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
    let directory = tempfile::tempdir().unwrap();
    let file = directory.path().join("leg.csv");
    let board = BoardUnderTest::new(&[]);
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
fn datagrams_reach_whoever_listens() {
    let listener = std::net::UdpSocket::bind("127.0.0.1:0").unwrap();
    listener
        .set_read_timeout(Some(Duration::from_secs(10)))
        .unwrap();
    let address = listener.local_addr().unwrap().to_string();
    let board = BoardUnderTest::new(&[]);
    let mut monitor = board.begin(&["monitor", "--udp", &address, "--for", "1"]);
    let mut bytes = [0; 4096];
    let count = listener.recv(&mut bytes).unwrap();
    let line: Value = serde_json::from_slice(&bytes[..count]).unwrap();
    assert_eq!(line["state"], "disarmed");
    assert!(monitor.wait().unwrap().success());
}
