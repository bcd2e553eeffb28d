//! `docs/telemetry.md` lists every signal.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use leg_boards::image::workspace_root;
use leg_host::signals::{RECORDER_SIGNALS, REPORT_SIGNALS, SIMULATED_SIGNALS, Signal, Values};
use std::fmt::Write;
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
