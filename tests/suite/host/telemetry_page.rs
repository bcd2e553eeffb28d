//! `docs/telemetry.md` lists every signal; recordings are read by `mcap` of Python, by their own schemas; the Foxglove layout shows
//! signals that there are.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use crate::common::python;
use leg_boards::image::workspace_root;
use leg_host::signals::{RECORDER_SIGNALS, REPORT_SIGNALS, SIMULATED_SIGNALS, Signal, Values};
use serde_json::{Value, json};
use std::fmt::Write;
use std::path::Path;
use std::process::Command;
use std::time::UNIX_EPOCH;
use std::{env, fs};

/// Before and after a table of the page.
const MARKS: [&str; 2] = ["<!-- signals of ", "<!-- end -->"];

fn table<S>(signals: &[Signal<S>]) -> String {
    let mut rows = String::from("| signal | kind | values | meaning |\n|---|---|---|---|\n");
    for signal in signals {
        let values = match signal.values {
            Values::Number(_) | Values::Single(_) => "number",
            Values::Two(_) | Values::SingleTwo(_) => "2 numbers",
            Values::Three(_) | Values::SingleThree(_) => "3 numbers",
            Values::Count(_) => "integer",
            Values::Flag(_) => "true or false",
            Values::Word(_) => "text",
            Values::Names(_) => "texts",
        };
        let (name, kind) = (signal.name, signal.origin.words());
        writeln!(
            rows,
            "| `{name}` | {kind} | {values} | {} |",
            signal.meaning
        )
        .unwrap();
    }
    rows
}

/// The page with its tables made anew.
fn page(text: &str) -> String {
    let mut parts = text.split(MARKS[0]);
    let mut page = parts.next().unwrap().to_string();
    for part in parts {
        let (topic, rest) = part.split_once(" -->").unwrap();
        let (_, rest) = rest.split_once(MARKS[1]).unwrap();
        let table = match topic {
            "/leg" => table(REPORT_SIGNALS),
            "/simulation" => table(SIMULATED_SIGNALS),
            "/recorder" => table(RECORDER_SIGNALS),
            other => panic!("no topic is called {other}"),
        };
        write!(page, "{}{topic} -->\n{table}{}{rest}", MARKS[0], MARKS[1]).unwrap();
    }
    page
}

#[test]
fn the_page_of_telemetry_lists_every_signal() {
    let path = workspace_root().join("host-tools/docs/telemetry.md");
    let text = fs::read_to_string(&path).unwrap();
    let made = page(&text);
    if env::var_os("LEG_OVERWRITE").is_some() {
        fs::write(&path, &made).unwrap();
    } else {
        assert!(text == made, "make it anew with LEG_OVERWRITE=1");
    }
    assert_eq!(made.matches(MARKS[1]).count(), 3);
}

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
        let exact = ["/settings", "/ticks"];
        for (topic, channel) in channels {
            assert!(channel["count"].as_u64().unwrap() > 0, "{topic}");
            // By the clock of this machine, simulated legs, too; it may be set meanwhile.
            let since_s = channel["begin_s"].as_f64().unwrap() - begin_s;
            assert!((-1.0..600.0).contains(&since_s), "{topic}: {since_s} s");
            let encoding = if exact.contains(&topic.as_str()) {
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
