//! Recordings as Python's `mcap` reads them, by their own schemas: `tests/python/read_recording.py`. The Foxglove layouts show signals
//! that there are.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use crate::board::emulated_board::board::{BoardUnderTest, LOG_STALL};
use crate::common::stalls::{StallWatch, longest_stall, unless_stalled};
use crate::common::{numbers, python};
use leg_boards::image::workspace_root;
use leg_host::recording;
use serde_json::{Value, json};
use std::path::Path;
use std::process::Command;
use std::time::UNIX_EPOCH;

fn leg(arguments: &[&str], directory: &Path) {
    let mut command = Command::new(env!("CARGO_BIN_EXE_leg-under-test"));
    let output = command
        .args(arguments)
        .current_dir(directory)
        .output()
        .unwrap();
    let told = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{arguments:?}: {told}");
}

/// Of a simulation and of a leg: every message is what its channel's schema says, and every part of the layout is a signal.
#[test]
#[ignore = "needs Python 3.11"]
fn python_reads_every_channel_by_its_own_schema_and_the_layout_shows_what_is_there() {
    let directory = tempfile::tempdir().unwrap();
    let begin_s = UNIX_EPOCH.elapsed().unwrap().as_secs_f64();
    let plots = ["--plots", "plots"];
    let run = [
        "run",
        "--on",
        "sim",
        "--scenario",
        "payload",
        "--record",
        "run.mcap",
    ];
    leg(&[run.as_slice(), &plots].concat(), directory.path());
    leg(
        &["log", "--on", "sim", "--for", "0.5", "--out", "log.mcap"],
        directory.path(),
    );
    leg(
        &["scope", "--on", "sim", "--out", "scope.mcap"],
        directory.path(),
    );
    let layouts = workspace_root().join("host-tools/foxglove");
    let jobs = [
        ("run.mcap", "leg.json"),
        ("log.mcap", "leg.json"),
        ("scope.mcap", "recorder.json"),
    ]
    .map(|(name, layout)| {
        json!({ "recording": directory.path().join(name), "layout": layouts.join(layout) })
    });
    let [run, log, scope] = &python::answers("read_recording.py", &jobs)[..] else {
        panic!("three recordings, three answers");
    };
    let counts = |found: &Value, topics: &[&str]| {
        let channels = found["channels"].as_object().unwrap();
        let mut names: Vec<_> = channels.keys().map(String::as_str).collect();
        names.sort_unstable();
        assert_eq!(names, topics, "{found}");
        for (topic, channel) in channels {
            assert!(channel["count"].as_u64().unwrap() > 0, "{topic}");
            // By the clock of this machine, simulated legs, too; it may be set meanwhile.
            let since_s = channel["begin_s"].as_f64().unwrap() - begin_s;
            assert!((-1.0..600.0).contains(&since_s), "{topic}: {since_s} s");
            // For `leg replay` alone.
            let encoding = if topic == "/ticks" {
                "postcard"
            } else {
                "json"
            };
            assert_eq!(channel["encoding"], encoding, "{topic}");
        }
    };
    counts(
        run,
        &["/about", "/leg", "/settings", "/simulation", "/ticks"],
    );
    counts(log, &["/about", "/leg", "/settings"]);
    counts(scope, &["/about", "/recorder", "/settings"]);
    assert_eq!(run["metadata"]["scenario"], "payload");
    for key in ["version", "rig", "seed", "settings"] {
        assert!(run["metadata"][key].is_string(), "{key}: {run}");
    }
    // What a layout shows of a simulation is not all there in a log.
    for (recording, paths) in [(run, 12), (scope, 10)] {
        assert_eq!(recording["layout_unknown"], json!([]));
        let shown = recording["layout_paths"].as_array().unwrap();
        assert!(shown.len() >= paths, "{recording}");
    }
}

/// Up to the last second.
#[test]
#[ignore = "needs Python 3.11"]
fn a_log_that_is_killed_is_read_by_another_program() {
    unless_stalled(LOG_STALL, || {
        let directory = tempfile::tempdir().unwrap();
        let file = directory.path().join("leg.mcap");
        let board = BoardUnderTest::new(&[]);
        let mut log = board.begin_log(&file, &["--rate", "100"]);
        let watches = [&board.process, &log].map(StallWatch::begin);
        board.wait(2.5);
        let time_s = board.state()["time_s"].as_f64().unwrap();
        log.kill().unwrap();
        log.wait().unwrap();
        let stall = longest_stall(watches);
        let job = json!({ "unfinished": recording::unfinished(&file).unwrap() });
        let read = numbers(&python::answers("read_recording.py", &[job])[0]);
        let newest_s = read.last().copied().unwrap_or(0.0);
        // A second, and what the log may be late.
        let whole = read.is_sorted() && time_s - newest_s < 1.2;
        let wrong = || format!("{} reports up to {newest_s} s of {time_s} s", read.len());
        (whole.then_some(()).ok_or_else(wrong), stall)
    });
}
