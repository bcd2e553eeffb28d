//! Commands in processes of their own, on one emulated board behind a pseudo-terminal: the same serial code as for a board.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use leg_host_tools::ready_rigs::READY_RIGS;
use serde_json::Value;
use std::fs::File;
use std::io::{BufRead, BufReader, Write};
use std::process::{Child, ChildStdin, Command, Output, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

const LEG: &str = env!("CARGO_BIN_EXE_leg-under-test");

/// A board that waits longer for its host: the machine may have much else to do.
const PATIENT: &str = "\n[control.limits]\ncommand_time_s = 2\n";

/// A leg that takes five seconds for what others do in one.
const SLOW: &str = "\n[control.motion]\nspeed_rad_per_s = 0.1\n";

/// `leg emulate` in the background.
struct Board {
    process: Child,
    hand: ChildStdin,
    port: String,
}

impl Board {
    fn new(arguments: &[&str]) -> Self {
        Self::with("", arguments)
    }

    /// A leg that moves slowly.
    fn slow() -> Self {
        Self::with(SLOW, &[])
    }

    /// A leg of the default rig with more sections.
    fn with(sections: &str, arguments: &[&str]) -> Self {
        let folder = tempfile::tempdir().unwrap();
        let rig = folder.path().join("rig.toml");
        std::fs::write(&rig, [READY_RIGS[0].text, PATIENT, sections].concat()).unwrap();
        let mut process = Command::new(LEG)
            .args(["emulate", "--touch", "--for", "120", "--rig"])
            .arg(&rig)
            .args(arguments)
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()
            .unwrap();
        let mut port = String::new();
        let stdout = process.stdout.take().unwrap();
        BufReader::new(stdout).read_line(&mut port).unwrap();
        Self {
            hand: process.stdin.take().unwrap(),
            process,
            port: port.trim_end().into(),
        }
    }

    /// Begins a move and waits until the leg is on its way.
    fn begin_move(&self) -> Child {
        let moving = self.begin(&move_to("29"));
        let begun = Instant::now();
        while self.state()["moving"] != true {
            if begun.elapsed() > Duration::from_secs(20) {
                let told = errors(&moving.wait_with_output().unwrap());
                panic!("it does not move: {told} {}", self.state());
            }
        }
        moving
    }

    fn command(&self, arguments: &[&str]) -> Command {
        let mut command = Command::new(LEG);
        command.args(arguments).args(["--port", &self.port]);
        command
    }

    /// Runs a command to its end.
    fn run(&self, arguments: &[&str]) -> Output {
        self.command(arguments).output().unwrap()
    }

    /// Runs a command that succeeds, and what it tells machines.
    fn told(&self, arguments: &[&str]) -> Value {
        let output = self.run(&[arguments, &["--json"]].concat());
        assert!(
            output.status.success(),
            "{arguments:?}: {}",
            errors(&output)
        );
        serde_json::from_slice(&output.stdout).unwrap()
    }

    /// Runs a command that fails: its exit code and what it says.
    fn refused(&self, arguments: &[&str]) -> (Option<i32>, String) {
        let output = self.run(arguments);
        (output.status.code(), errors(&output))
    }

    fn begin(&self, arguments: &[&str]) -> Child {
        let mut command = self.command(arguments);
        command.stdout(Stdio::piped()).stderr(Stdio::piped());
        command.spawn().unwrap()
    }

    fn touch(&mut self, line: &str) {
        writeln!(self.hand, "{line}").unwrap();
        // The board looks every millisecond.
        sleep(Duration::from_millis(100));
    }

    /// Lets the leg's own time go on, which may be slower than the clock.
    fn wait(&self, seconds: f64) {
        let time = || self.state()["time_s"].as_f64().unwrap();
        let until = time() + seconds;
        while time() < until {}
    }

    /// Homes nothing, arms nothing: what the leg does now.
    fn state(&self) -> Value {
        let output = self.run(&["monitor", "--json", "--for", "0.01"]);
        let text = String::from_utf8(output.stdout).unwrap();
        serde_json::from_str(text.lines().next().unwrap()).unwrap()
    }
}

impl Drop for Board {
    fn drop(&mut self) {
        let _ = self.process.kill();
        let _ = self.process.wait();
    }
}

fn errors(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

fn move_to(tilt: &str) -> [&str; 5] {
    ["move", "--azimuth", "40", "--tilt", tilt]
}

fn signal(process: &Child, name: &str) {
    let id = process.id().to_string();
    let sent = Command::new("kill").args([name, &id]).status().unwrap();
    assert!(sent.success());
}

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
        "--axis",
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
