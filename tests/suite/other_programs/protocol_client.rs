//! The client of `firmware/PROTOCOL.md` commands a leg.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use crate::board::emulated_board::board::{BoardUnderTest, errors};
use crate::common::python;
use leg_boards::image::workspace_root;
use std::{fs, process};

/// Lines of the client, at most.
const CLIENT_LINES_MAX: usize = 60;

/// The client of the page, as it stands there.
#[test]
#[ignore = "needs Python 3.11"]
fn the_client_of_the_page_leans_a_leg() {
    let text = fs::read_to_string(workspace_root().join("firmware/PROTOCOL.md")).unwrap();
    let (_, rest) = text.split_once("```python\n").unwrap();
    let (client, _) = rest.split_once("```\n").unwrap();
    let lines = client.lines().count();
    assert!(lines <= CLIENT_LINES_MAX, "{lines} lines");
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("client.py");
    fs::write(&path, client).unwrap();

    let board = BoardUnderTest::new(&[]);
    let output = process::Command::new(python::python().unwrap())
        .arg(&path)
        .arg(&board.port)
        .output()
        .unwrap();
    assert!(output.status.success(), "{}", errors(&output));
    let told = String::from_utf8(output.stdout).unwrap();
    assert!(told.starts_with("x 0.200, y"), "{told}");
    let state = board.state();
    assert_eq!(state["state"], "held");
    let tilt = state["tilt_deg"].as_f64().unwrap();
    assert!((tilt - 0.2_f64.asin().to_degrees()).abs() < 0.05, "{tilt}");
}
