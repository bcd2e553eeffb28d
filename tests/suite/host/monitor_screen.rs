//! `leg monitor` on a terminal: a screen until a key ends it, and the terminal as before.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use crate::common::stalls::PATIENCE;
use leg_host::pseudo_terminal::PseudoTerminal;
use rustix::termios::{Winsize, tcsetwinsize};
use serde_json::Value;
use std::fs::OpenOptions;
use std::process::{Child, Command};
use std::thread::sleep;
use std::time::{Duration, Instant};

/// Time from one picture to the next in which an end shows that it waits for none.
const PERIOD: Duration = Duration::from_secs(10);

/// What enters the screen and leaves it.
const ENTERS: &str = "\x1b[?1049h";
const LEAVES: &str = "\x1b[?1049l";

/// A terminal of 80 × 24 with a monitor on it.
fn monitor(rate_hz: &str) -> (PseudoTerminal, Child) {
    let terminal = PseudoTerminal::open().unwrap();
    let open = || {
        OpenOptions::new()
            .read(true)
            .write(true)
            .open(terminal.path())
    };
    let side = open().unwrap();
    let size = Winsize {
        ws_row: 24,
        ws_col: 80,
        ws_xpixel: 0,
        ws_ypixel: 0,
    };
    tcsetwinsize(&side, size).unwrap();
    let monitor = Command::new(env!("CARGO_BIN_EXE_leg-under-test"))
        .args(["monitor", "--on", "sim", "--rate", rate_hz])
        .stdin(open().unwrap())
        .stdout(side)
        .spawn()
        .unwrap();
    (terminal, monitor)
}

/// Reads until a text has come.
fn read_until(terminal: &PseudoTerminal, shown: &mut String, text: &str) {
    let begun = Instant::now();
    while !shown.contains(text) {
        assert!(begun.elapsed() < PATIENCE, "no {text:?} in {shown:?}");
        let mut bytes = [0; 4096];
        let count = terminal.read(&mut bytes).unwrap();
        shown.push_str(&String::from_utf8_lossy(&bytes[..count]));
        sleep(Duration::from_millis(1));
    }
}

#[test]
fn a_key_ends_the_screen_and_the_terminal_is_as_before() {
    for key in [b"q".as_slice(), b"\x03"] {
        let (terminal, mut monitor) = monitor("20");
        let mut shown = String::new();
        read_until(&terminal, &mut shown, ENTERS);
        for text in ["disarmed", "Tensions", "Faults", "commands nothing"] {
            read_until(&terminal, &mut shown, text);
        }
        terminal.write(key).unwrap();
        read_until(&terminal, &mut shown, LEAVES);
        assert!(monitor.wait().unwrap().success());
    }
}

#[test]
fn a_key_does_not_wait_for_the_next_picture() {
    let (terminal, mut monitor) = monitor("0.1");
    let mut shown = String::new();
    read_until(&terminal, &mut shown, "commands nothing");
    let begun = Instant::now();
    terminal.write(b"q").unwrap();
    read_until(&terminal, &mut shown, LEAVES);
    assert!(monitor.wait().unwrap().success());
    // Nearly all of it: the machine may stall single processes for seconds.
    assert!(begun.elapsed() < PERIOD * 9 / 10);
}

/// In the leg's own time, which a leg in this process does not wait for.
#[test]
fn reports_come_at_their_rate() {
    for rate_hz in [0.5, 4.0, 100.0] {
        let reports = 5_u8;
        let length_s = (f64::from(reports) - 0.5) / rate_hz;
        let output = Command::new(env!("CARGO_BIN_EXE_leg-under-test"))
            .args(["monitor", "--on", "sim", "--json"])
            .args(["--rate", &rate_hz.to_string()])
            .args(["--for", &length_s.to_string()])
            .output()
            .unwrap();
        let printed = String::from_utf8(output.stdout).unwrap();
        let times_s: Vec<f64> = printed
            .lines()
            .map(|line| {
                serde_json::from_str::<Value>(line).unwrap()["time_s"]
                    .as_f64()
                    .unwrap()
            })
            .collect();
        assert_eq!(
            times_s.len(),
            usize::from(reports),
            "{rate_hz} Hz: {times_s:?}"
        );
        for pair in times_s.windows(2) {
            let period_s = pair[1] - pair[0];
            assert!(
                (period_s * rate_hz - 1.0).abs() < 0.1,
                "{rate_hz} Hz: {period_s} s"
            );
        }
    }
}
