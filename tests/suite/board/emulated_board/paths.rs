//! `leg follow` on an emulated board: a file, a program that stops, a host that dies.

use super::board::{BoardUnderTest, errors};
use std::io::Write;
use std::process::{Child, Stdio};
use std::time::{Duration, Instant};

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
    // The machine may have much else to do.
    let state = board.json(&["follow", path, "--lead", "2"]);
    assert_eq!(state["state"], "keeping_station");
    assert_eq!(state["faults"].as_array().unwrap().len(), 0);
    let tilt = state["tilt_deg"].as_f64().unwrap();
    assert!((tilt - 20.0).abs() < 0.1, "{tilt}");
}

/// The program writes half of its rows, and then nothing.
#[test]
fn a_program_that_stops_writing_ends_in_rest() {
    let board = BoardUnderTest::new(&[]);
    let mut following = follow_program(&board);
    let mut rows_in = following.stdin.take().unwrap();
    rows_in.write_all(rows()[..80].concat().as_bytes()).unwrap();
    let begun = Instant::now();
    while board.state()["faults"][0]["fault"] != "point_missing" {
        assert!(
            begun.elapsed() < Duration::from_secs(60),
            "{}",
            board.state()
        );
    }
    // It does not wait for the next row to say so.
    let output = following.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(1));
    let told = errors(&output);
    assert!(told.contains("fault 28, set-point missing"), "{told}");
    drop(rows_in);
    assert_eq!(board.state()["state"], "held");
}

#[test]
fn a_program_whose_host_dies_leaves_the_leg_in_hold() {
    let board = BoardUnderTest::new(&[]);
    let mut following = follow_program(&board);
    let mut rows_in = following.stdin.take().unwrap();
    rows_in.write_all(rows().concat().as_bytes()).unwrap();
    let begun = Instant::now();
    while board.state()["tilt_deg"].as_f64().unwrap() < 5.0 {
        assert!(
            begun.elapsed() < Duration::from_secs(60),
            "{}",
            board.state()
        );
    }
    following.kill().unwrap();
    following.wait().unwrap();
    while board.state()["state"] != "held" {
        assert!(
            begun.elapsed() < Duration::from_secs(60),
            "{}",
            board.state()
        );
    }
    assert_eq!(board.state()["faults"][0]["fault"], "command_timeout");
}

fn follow_program(board: &BoardUnderTest) -> Child {
    let mut command = board.command(&["follow", "-", "--lead", "2"]);
    command
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped());
    command.spawn().unwrap()
}
