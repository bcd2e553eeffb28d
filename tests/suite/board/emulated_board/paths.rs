//! `leg follow` on an emulated board: a file, a program that stops, a host that dies.

use super::board::{BoardUnderTest, IMPATIENT, errors};
use crate::common::stalls::{StallWatch, longest_stall, unless_stalled, wait_for};
use std::io::Write;
use std::process::{Child, Output, Stdio};
use std::time::Duration;

/// For longer the host must not be stalled: about half of what the leg has of the path beforehand.
const HOST_STALL: Duration = Duration::from_millis(300);

/// Rows of a lean to 20° in 4 s, and back again.
fn rows() -> Vec<String> {
    let row = |i: u32| {
        let time_s = f64::from(i) * 0.04;
        let part = time_s / 8.0;
        // At rest at both ends.
        let swing = (part * (1.0 - part)).powi(3) * 64.0;
        format!("{time_s:.2},40,{:.6}\n", 20.0 * swing)
    };
    let mut rows = vec!["time_s,azimuth_deg,tilt_deg\n".into()];
    rows.extend((0..=200).map(row));
    rows
}

#[test]
fn a_file_is_followed_to_its_end() {
    let board = BoardUnderTest::new(&[]);
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("path.csv");
    let rows = rows();
    std::fs::write(&path, rows[..101].concat()).unwrap();
    let path = path.to_str().unwrap();
    unless_stalled(HOST_STALL, || {
        // The machine may have much else to do.
        let following = board.begin(&["follow", path, "--lead", "2"]);
        let watches = [&board.process, &following].map(StallWatch::begin);
        let output = following.wait_with_output().unwrap();
        let stall = longest_stall(watches);
        if !output.status.success() {
            let _ = board.run(&["clear"]);
            return (Err(errors(&output)), stall);
        }
        let state = board.state();
        assert_eq!(state["state"], "keeping station");
        assert_eq!(state["faults"].as_array().unwrap().len(), 0);
        let tilt = state["tilt_deg"].as_f64().unwrap();
        assert!((tilt - 20.0).abs() < 0.1, "{tilt}");
        (Ok(()), stall)
    });
}

/// The program writes half of its rows, and then nothing.
#[test]
fn a_program_that_stops_writing_ends_in_rest() {
    unless_stalled(HOST_STALL, || {
        let board = BoardUnderTest::new(&[]);
        let mut following = follow_program(&board);
        let watches = [&board.process, &following].map(StallWatch::begin);
        let mut rows_in = following.stdin.take().unwrap();
        rows_in.write_all(rows()[..80].concat().as_bytes()).unwrap();
        // It does not wait for the next row to say so.
        let output = wait_for_end(following);
        let stall = longest_stall(watches);
        drop(rows_in);
        let told = errors(&output);
        if !told.contains("fault 28, set-point missing") {
            return (Err(told), stall);
        }
        assert_eq!(output.status.code(), Some(1));
        assert_eq!(board.state()["state"], "held");
        (Ok(()), stall)
    });
}

/// Waits for the end of a command that prints little.
fn wait_for_end(mut command: Child) -> Output {
    wait_for("the end", || command.try_wait().unwrap());
    command.wait_with_output().unwrap()
}

#[test]
fn a_program_whose_host_dies_leaves_the_leg_in_hold() {
    unless_stalled(HOST_STALL, || {
        let board = BoardUnderTest::with_sections(IMPATIENT, &[]);
        let mut following = follow_program(&board);
        let watches = [&board.process, &following].map(StallWatch::begin);
        board.wait_for_port(&following);
        let mut rows_in = following.stdin.take().unwrap();
        rows_in.write_all(rows().concat().as_bytes()).unwrap();
        let on_its_way = wait_for("a tilt of 5°, or the end", || {
            let there = board.state()["tilt_deg"].as_f64().unwrap() > 5.0;
            let ended = following.try_wait().unwrap().is_some();
            (there || ended).then_some(!ended)
        });
        let _ = following.kill();
        let output = following.wait_with_output().unwrap();
        let stall = longest_stall(watches);
        if !on_its_way {
            return (Err(errors(&output)), stall);
        }
        wait_for("a hold", || {
            (board.state()["state"] == "held").then_some(())
        });
        assert_eq!(board.state()["faults"][0], "no command");
        (Ok(()), stall)
    });
}

fn follow_program(board: &BoardUnderTest) -> Child {
    let mut command = board.command(&["follow", "-", "--lead", "2"]);
    command
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped());
    command.spawn().unwrap()
}
