//! Commands whose disk is full, whose input has no end, or that are killed.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use crate::common::stalls::{PATIENCE, wait_for};
use serde_json::Value;
use std::fs;
use std::path::Path;
use std::process::{Command, Output, Stdio};
use std::time::Instant;

const LEG: &str = env!("CARGO_BIN_EXE_leg-under-test");

/// `leg` by a shell, after the shell's own `before`, in a directory.
fn leg(before: &str, directory: &Path, arguments: &[&str]) -> Output {
    let mut shell = Command::new("sh");
    shell.args(["-c", &format!("{before}\nexec \"$@\""), "sh", LEG]);
    shell.args(arguments).current_dir(directory);
    shell.stdin(Stdio::null()).output().unwrap()
}

fn errors(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

/// No file may have more than so many blocks of 512 bytes: the same as a full disk, without one.
fn limit(blocks: u32) -> String {
    format!("ulimit -f {blocks}")
}

#[test]
fn the_error_of_a_full_disk_names_the_file_and_leaves_nothing_hidden() {
    let run = ["run", "--on", "sim", "--scenario", "hold"];
    let test = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/../host-tools/samples/tensile-test.csv"
    );
    let curve = ["curve", test, "--out", "c.toml"];
    for (blocks, arguments, named) in [
        (8, [&run[..], &["--plots", "p"]].concat(), "tip.svg"),
        (8, [&run[..], &["--record", "r.mcap"]].concat(), "r.mcap"),
        (8, [&run[..], &["--record", "r.csv"]].concat(), "r.csv"),
        (
            8,
            vec!["map", "--azimuths", "9", "--tilts", "3", "--out", "m"],
            "deviation_contour.svg",
        ),
        (
            1,
            vec!["map", "--azimuths", "9", "--tilts", "3", "--csv", "m.csv"],
            "m.csv",
        ),
        (1, vec!["export", "mjcf", "--out", "e.xml"], "e.xml"),
        (1, vec!["rig", "draw", "table1", "--out", "d.svg"], "d.svg"),
        (
            1,
            vec!["settings", "get", "--on", "sim", "--out", "s.toml"],
            "s.toml",
        ),
        (
            1,
            vec!["log", "--on", "sim", "--for", "2", "--out", "l.mcap"],
            "l.mcap",
        ),
        (
            1,
            vec!["log", "--on", "sim", "--for", "2", "--out", "l.csv"],
            "l.csv",
        ),
        (0, curve.to_vec(), "c.toml"),
        (
            8,
            [&curve[..], &["--plots", "p"]].concat(),
            "curve_elongation.svg",
        ),
    ] {
        let directory = tempfile::tempdir().unwrap();
        let output = leg(&limit(blocks), directory.path(), &arguments);
        let told = errors(&output);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {told}");
        let names = told.contains(named) && told.contains("File too large");
        assert!(names && !told.contains("panicked"), "{arguments:?}: {told}");
        let hidden = fs::read_dir(directory.path()).unwrap().any(|entry| {
            let name = entry.unwrap().file_name();
            name.to_string_lossy().starts_with('.')
        });
        assert!(!hidden, "{arguments:?}");
    }
}

#[test]
fn standard_streams_that_take_nothing_end_a_command_without_a_panic() {
    let directory = tempfile::tempdir().unwrap();
    let output = leg("exec >/dev/full", directory.path(), &["faults"]);
    let told = errors(&output);
    assert_eq!(output.status.code(), Some(2), "{told}");
    assert!(
        told.contains("standard output: No space left") && told.contains("make room"),
        "{told}"
    );
    for arguments in [
        &["faults"][..],
        &["rig", "show", "none"],
        &["--json", "rig", "show", "none"],
    ] {
        let output = leg("exec >/dev/full 2>/dev/full", directory.path(), arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
    }
}

#[test]
fn an_input_without_an_end_is_refused_at_once() {
    let directory = tempfile::tempdir().unwrap();
    let title = format!("title = \"{}\"\nsteps = [\"arm\"]\n", "x".repeat(900_000));
    fs::write(directory.path().join("title.toml"), title).unwrap();
    // A gigabyte, had it to be read.
    let memory = "ulimit -v 1000000";
    let begun = Instant::now();
    for (arguments, code, said) in [
        (
            &["run", "--on", "sim", "--scenario", "/dev/zero"][..],
            2,
            "cannot read the scenario /dev/zero: it is larger than 1 MiB",
        ),
        (
            &["run", "--on", "sim", "--scenario", "title.toml"],
            2,
            "title has more than 200 letters",
        ),
        (
            &["rig", "validate", "/dev/zero"],
            2,
            "cannot read the rig file /dev/zero: it is larger than 1 MiB",
        ),
        (
            &["settings", "diff", "--on", "sim", "--rig", "/dev/zero"],
            2,
            "it is larger than 1 MiB",
        ),
        (&["curve", "/dev/zero"], 2, "it is larger than 32 MiB"),
        (
            &["eval", "/dev/zero"],
            2,
            "cannot read line 1 of /dev/zero: it is longer than 64 MiB",
        ),
        (
            &["follow", "--on", "sim", "/dev/zero"],
            2,
            "cannot read line 1 of /dev/zero: it is longer than 64 MiB",
        ),
        (&["replay", "/dev/zero"], 2, "is no whole MCAP file"),
    ] {
        let output = leg(memory, directory.path(), arguments);
        let told = errors(&output);
        assert_eq!(output.status.code(), Some(code), "{arguments:?}: {told}");
        assert!(
            told.contains(said) && told.contains("help: "),
            "{arguments:?}: {told}"
        );
        assert!(told.len() < 10_000, "{arguments:?}: {} bytes", told.len());
    }
    let lines = format!(
        "{}\n{{\"azimuth_deg\":0,\"tilt_deg\":0,\"payload_kg\":0}}\n",
        "x".repeat(100_000)
    );
    fs::write(directory.path().join("poses.jsonl"), lines).unwrap();
    let output = leg(memory, directory.path(), &["eval", "poses.jsonl"]);
    let answers = String::from_utf8(output.stdout).unwrap();
    let answers: Vec<Value> = answers
        .lines()
        .map(|line| serde_json::from_str(line).unwrap())
        .collect();
    assert_eq!((output.status.code(), answers.len()), (Some(1), 2));
    assert!(
        answers[0]["error"]
            .as_str()
            .unwrap()
            .starts_with("the line is longer than 64 KiB")
    );
    assert!(answers[1]["feasible"].as_bool().unwrap());
    assert!(begun.elapsed() < PATIENCE, "{:?}", begun.elapsed());
}

#[test]
fn a_recording_of_a_command_that_is_killed_is_replayed_as_far_as_it_goes() {
    let directory = tempfile::tempdir().unwrap();
    let mut recording = Command::new(LEG)
        .args([
            "run",
            "--on",
            "sim",
            "--scenario",
            "tour",
            "--record",
            "leg.mcap",
        ])
        .current_dir(directory.path())
        .spawn()
        .unwrap();
    let part = directory.path().join("leg.part.mcap");
    wait_for("some of the recording", || {
        let recorded = fs::metadata(&part).map_or(0, |part| part.len());
        (recorded >= 4_000_000).then_some(())
    });
    recording.kill().unwrap();
    recording.wait().unwrap();
    let output = leg("", directory.path(), &["replay", "leg.part.mcap"]);
    let told = String::from_utf8_lossy(&output.stdout);
    assert!(output.status.success(), "{}", errors(&output));
    assert!(
        told.starts_with("The recording did not come to its end"),
        "{told}"
    );
    let output = leg("", directory.path(), &["replay", "leg.part.mcap", "--json"]);
    let replayed: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(replayed["finished"], false);
    assert!(replayed["ticks"].as_u64().unwrap() > 8000, "{replayed}");
    // The next one leaves it and says so.
    let output = leg(
        "",
        directory.path(),
        &["log", "--on", "sim", "--for", "0.1", "--out", "leg.mcap"],
    );
    assert!(output.status.success());
    assert!(errors(&output).contains("leg.part.mcap is a recording that has not come to its end"));
    assert!(part.exists());
}
