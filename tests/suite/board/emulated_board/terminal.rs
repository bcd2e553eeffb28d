//! The screen of `leg monitor` and its terminal.

use super::board::{BoardUnderTest, move_to, signal};
use crate::common::stalls::{PATIENCE, wait_for};
use leg_host::pseudo_terminal::PseudoTerminal;
use serde_json::Value;
use std::fs::{File, OpenOptions};
use std::process::{Child, Command, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

/// The end of a terminal that a program has.
fn end(terminal: &PseudoTerminal) -> File {
    let mut options = OpenOptions::new();
    let options = options.read(true).write(true);
    options.open(terminal.path()).unwrap()
}

/// A monitor on a terminal, once it shows its screen.
fn monitor(board: &BoardUnderTest) -> (Child, PseudoTerminal) {
    let terminal = PseudoTerminal::open().unwrap();
    let end = || end(&terminal);
    let mut command = board.command(&["monitor"]);
    command.stdin(end()).stdout(end()).stderr(Stdio::null());
    let monitor = command.spawn().unwrap();
    wait_for("a screen", || {
        (terminal.read(&mut [0; 4096]).unwrap() > 0).then_some(())
    });
    (monitor, terminal)
}

/// Waits until it has ended, and reads what it shows meanwhile; its exit code.
fn ended(mut monitor: Child, terminal: Option<&PseudoTerminal>) -> Option<i32> {
    let begun = Instant::now();
    loop {
        if let Some(status) = monitor.try_wait().unwrap() {
            return status.code();
        }
        if begun.elapsed() > PATIENCE {
            monitor.kill().unwrap();
            monitor.wait().unwrap();
            panic!("it has not ended");
        }
        if let Some(terminal) = terminal {
            terminal.read(&mut [0; 4096]).unwrap();
        }
        sleep(Duration::from_millis(10));
    }
}

#[test]
fn a_monitor_ends_with_its_terminal_a_key_or_a_signal_and_lets_the_port_go() {
    let board = BoardUnderTest::new(&[]);
    // Nobody sends it a signal: all that it has is the end of its input.
    let (running, terminal) = monitor(&board);
    drop(terminal);
    assert!(ended(running, None).is_some());
    let (running, terminal) = monitor(&board);
    assert_eq!(terminal.write(b"\x1b[A").unwrap(), 3);
    sleep(Duration::from_millis(300));
    assert_eq!(terminal.write(b"q").unwrap(), 1);
    assert_eq!(ended(running, Some(&terminal)), Some(0));
    for name in ["-TERM", "-HUP", "-INT"] {
        let (running, terminal) = monitor(&board);
        // Half a key.
        assert_eq!(terminal.write(b"\x1b[").unwrap(), 2);
        sleep(Duration::from_millis(300));
        signal(&running, name);
        assert_eq!(ended(running, Some(&terminal)), Some(0), "{name}");
    }
    assert_eq!(board.json(&["stop"])["state"], "disarmed");
}

#[test]
fn a_move_whose_terminal_goes_leaves_the_leg_in_hold_without_a_fault() {
    let board = BoardUnderTest::slow();
    let terminal = PseudoTerminal::open().unwrap();
    let mut command = board.command(&move_to("29"));
    for stream in [Command::stdin, Command::stdout, Command::stderr] {
        stream(&mut command, end(&terminal));
    }
    let moving = board.wait_until_moving(command.spawn().unwrap());
    drop(terminal);
    // As the system tells those whom a terminal controls. They can say nothing any more.
    signal(&moving, "-HUP");
    assert_eq!(ended(moving, None), Some(1));
    let state = board.state();
    assert_eq!(state["state"], "held");
    assert_eq!(state["faults"], Value::Array(vec![]));
    assert!(state["tilt_deg"].as_f64().unwrap() < 28.0, "{state}");
}
