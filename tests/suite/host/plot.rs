//! `leg plot`: the charts of a run from its recording, and of a leg from a log.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use mcap::Writer;
use std::collections::{BTreeMap, BTreeSet};
use std::fs::{self, File};
use std::path::Path;
use std::process::{Command, Output};

fn leg(arguments: &[&str], directory: &Path) -> Output {
    Command::new(env!("CARGO_BIN_EXE_leg-under-test"))
        .args(arguments)
        .current_dir(directory)
        .output()
        .unwrap()
}

fn succeeds(arguments: &[&str], directory: &Path) -> String {
    let output = leg(arguments, directory);
    let told = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{arguments:?}: {told}");
    String::from_utf8(output.stdout).unwrap()
}

/// Every file of a directory by its name.
fn files(directory: &Path) -> BTreeMap<String, Vec<u8>> {
    let entries = fs::read_dir(directory).unwrap().map(Result::unwrap);
    entries
        .map(|entry| {
            let name = entry.file_name().into_string().unwrap();
            (name, fs::read(entry.path()).unwrap())
        })
        .collect()
}

/// A step of payload; a path that is followed, whose charts have a curve more; homing; a fault, after which the leg is held.
#[test]
fn the_charts_of_a_run_are_drawn_again_to_the_pixel() {
    for scenario in ["payload", "circle", "homing", "fault_tension_jump"] {
        let directory = tempfile::tempdir().unwrap();
        let run = ["run", "--on", "sim", "--scenario", scenario];
        let record = ["--record", "run.mcap", "--plots", "run"];
        succeeds(&[run.as_slice(), &record].concat(), directory.path());
        let plot = ["plot", "run.mcap", "--plots", "again"];
        succeeds(&plot, directory.path());
        let [run, again] = ["run", "again"].map(|name| files(&directory.path().join(name)));
        assert_eq!(run.len(), 15, "five charts as SVG, PNG and PDF");
        let names = |all: &BTreeMap<String, Vec<u8>>| all.keys().cloned().collect::<Vec<_>>();
        assert_eq!(names(&run), names(&again));
        for (name, picture) in &run {
            assert!(again[name] == *picture, "{scenario}: {name} differs");
        }
        let tip = String::from_utf8_lossy(&run["tip.svg"]);
        // Each in its own shade, the same in all charts.
        let [homing, active] = [("homing", "#E6F5EF"), ("active", "#E6F0FA")];
        let [moving, held] = [("moving", "#FAE9E2"), ("held", "#F7ECF3")];
        let phases = match scenario {
            "homing" => [homing, active],
            "circle" | "payload" => [moving, active],
            _ => [active, held],
        };
        for (phase, shade) in phases {
            assert!(tip.lines().any(|line| line == phase), "{scenario}: {phase}");
            assert!(tip.contains(shade), "{scenario}: {phase}");
        }
        // Named by the kind that the signal has in `docs/telemetry.md`.
        let stiffness = String::from_utf8_lossy(&run["stiffness.svg"]);
        assert!(stiffness.contains("\nreference\n") && !stiffness.contains("\nestimated\n"));
    }
}

#[test]
fn a_log_of_a_leg_is_drawn() {
    let directory = tempfile::tempdir().unwrap();
    let log = ["log", "--on", "sim", "--for", "0.5", "--out", "leg.mcap"];
    succeeds(&log, directory.path());
    succeeds(&["plot", "leg.mcap", "--plots", "charts"], directory.path());
    let charts = files(&directory.path().join("charts"));
    let names: Vec<_> = charts
        .keys()
        .filter(|name| name.ends_with(".svg"))
        .collect();
    // There is no stiffness of a leg that is disarmed.
    assert_eq!(
        names,
        ["payload.svg", "supply.svg", "tensions.svg", "tilt.svg"]
    );
    let tensions = String::from_utf8_lossy(&charts["tensions.svg"]);
    assert!(tensions.contains("measured tension (N)"), "{tensions}");
}

#[test]
fn every_figure_of_the_paper_has_its_own_title() {
    let directory = tempfile::tempdir().unwrap();
    succeeds(&["paper", "--out", "paper"], directory.path());
    let figures = files(&directory.path().join("paper"));
    let figures = figures.iter().filter(|(name, _)| name.ends_with(".svg"));
    let titles: Vec<String> = figures
        .map(|(_, picture)| {
            let text = String::from_utf8_lossy(picture);
            let title = text.lines().find(|line| line.starts_with("Fig. "));
            title.unwrap().to_string()
        })
        .collect();
    let different: BTreeSet<_> = titles.iter().collect();
    assert!(titles.len() >= 8, "{titles:?}");
    assert_eq!(different.len(), titles.len(), "{titles:?}");
}

#[test]
fn what_is_no_recording_is_refused() {
    let directory = tempfile::tempdir().unwrap();
    fs::write(directory.path().join("text.mcap"), "time_s\n").unwrap();
    let other = File::create(directory.path().join("other.mcap")).unwrap();
    Writer::new(other).unwrap().finish().unwrap();
    for (file, told) in [
        ("text.mcap", "is no whole MCAP file"),
        ("missing.mcap", "cannot be read"),
        ("other.mcap", "holds no telemetry of a leg"),
    ] {
        let output = leg(&["plot", file], directory.path());
        let error = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{error}");
        assert!(
            error.contains(told) && error.contains("leg run --record"),
            "{error}"
        );
    }
}
