//! The screen of `leg monitor` and its terminal.

use super::board::{BoardUnderTest, signal};
use crate::common::stalls::{PATIENCE, wait_for};
use leg_host::pseudo_terminal::PseudoTerminal;
use std::fs::OpenOptions;
use std::process::{Child, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

/// A monitor on a terminal, once it shows its screen.
fn monitor(board: &BoardUnderTest) -> (Child, PseudoTerminal) {
    let terminal = PseudoTerminal::open().unwrap();
    let end = || {
        let path = terminal.path();
        OpenOptions::new()
            .read(true)
            .write(true)
            .open(path)
            .unwrap()
    };
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
