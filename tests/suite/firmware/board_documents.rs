//! What the pages about the board say of pins, faults and messages is what the sources say.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use crate::common::sources::sources;
use leg_firmware::board::{CheckIns, TaskWatchdog, WatchedTask};
use leg_firmware::recorder::TRIPLES_MAX;
use leg_firmware::sensors::TICK_HZ;
use leg_firmware::settings::{RECORDED_SIGNALS, SignalSet};
use leg_firmware::supervisor::FAULT_TABLE;
use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

const FIRMWARE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../firmware");

fn page(name: &str) -> String {
    fs::read_to_string(Path::new(FIRMWARE).join(name)).unwrap()
}

/// Every word such as `PB12`.
fn pins(text: &str) -> BTreeSet<String> {
    text.split(|c: char| !c.is_ascii_alphanumeric())
        .filter(|word| {
            let number = ["PA", "PB", "PC", "PD"]
                .iter()
                .find_map(|port| word.strip_prefix(port));
            number.is_some_and(|number| number.parse::<u8>().is_ok_and(|pin| pin < 16))
        })
        .map(String::from)
        .collect()
}

/// The code that hands each pin to its part, without the spaces.
fn start() -> String {
    let start = Path::new(FIRMWARE).join("stm32g474/src/start.rs");
    let mut text = fs::read_to_string(start).unwrap();
    text.retain(|c| !c.is_whitespace());
    text
}

/// What stands before each pin of a row of BOARD.md in the code that hands it to its part.
const PARTS: [(&str, &[&str]); 18] = [
    (
        "pulses of motors 1, 2, 3",
        &["pulse_1:p.", ",pulse_2:p.", ",pulse_3:p."],
    ),
    (
        "directions of motors 1, 2, 3",
        &["direction_1:p.", ",direction_2:p.", ",direction_3:p."],
    ),
    ("enable of all drivers", &["enable:p."]),
    (
        "fault lines of drivers 1, 2, 3",
        &["fault_1:p.", ",fault_2:p.", ",fault_3:p."],
    ),
    (
        "the three fault lines together, a diode from each: break 1",
        &["any_fault:p."],
    ),
    ("emergency stop: break 2", &["stop:p."]),
    ("encoder 1, tracks A and B", &["tracks_1:(p.", ",p."]),
    ("encoder 2, tracks A and B", &["tracks_2:(p.", ",p."]),
    ("encoder 3, tracks A and B", &["tracks_3:(p.", ",p."]),
    (
        "load cells 1, 2, 3",
        &["cell_1:p.", ",cell_2:p.", ",cell_3:p."],
    ),
    (
        "currents of motors 1, 2, 3",
        &["current_1:p.", ",current_2:p.", ",current_3:p."],
    ),
    ("motor supply", &["SlowSensors::new(p.ADC3,p."]),
    (
        "temperature of the drivers",
        &["SlowSensors::new(p.ADC3,p.PB1,p."],
    ),
    (
        "serial line to the ST-LINK",
        &["serial::open(p.LPUART1,p.PA3,p."],
    ),
    (
        "CAN FD: receive, transmit",
        &["can_bus::open(p.FDCAN2,p.", ",p."],
    ),
    (
        "address switches 1, 2, 4",
        &["switches::read(p.", ",p.", ",p."],
    ),
    ("LED", &["letled=Output::new(p."]),
    ("button", &[]),
];

/// The rows of the wiring table: pins in order, and what they are for.
fn wiring() -> Vec<(Vec<String>, String)> {
    let text = page("BOARD.md");
    let rows = text.lines().filter(|line| line.starts_with("| P"));
    let cells = rows.map(|row| row.split('|').map(str::trim).collect::<Vec<_>>());
    cells
        .map(|cells| {
            (
                cells[1].split(", ").map(String::from).collect(),
                cells[2].into(),
            )
        })
        .collect()
}

#[test]
fn every_pin_of_the_wiring_table_is_handed_to_its_part() {
    let (start, rows) = (start(), wiring());
    assert_eq!(rows.len(), PARTS.len());
    for (row_pins, function) in rows {
        let (_, before) = PARTS.iter().find(|(words, _)| *words == function).unwrap();
        let code: String = before
            .iter()
            .zip(&row_pins)
            .map(|(b, pin)| format!("{b}{pin}"))
            .collect();
        assert!(
            before.len() <= row_pins.len() && start.contains(&code),
            "{function}: {code}"
        );
    }
}

#[test]
fn the_picture_and_the_page_have_the_pins_of_the_wiring_table() {
    let table: BTreeSet<String> = wiring().into_iter().flat_map(|(pins, _)| pins).collect();
    assert_eq!(pins(&page("wiring.svg")), table);
    assert_eq!(pins(&page("BOARD.md")), table);
}

#[test]
fn the_image_uses_the_pins_of_the_wiring_table() {
    let start = fs::read_to_string(Path::new(FIRMWARE).join("stm32g474/src/start.rs"));
    let mut used = pins(&start.unwrap());
    // The button is named, so that nobody takes its pin.
    used.insert("PC13".into());
    let table: BTreeSet<String> = wiring().into_iter().flat_map(|(pins, _)| pins).collect();
    assert_eq!(used, table);
}

/// On these pages bold words are faults.
#[test]
fn every_fault_that_is_named_is_in_the_table() {
    for name in ["SAFETY.md", "TROUBLESHOOTING.md"] {
        let text = page(name);
        let bold: Vec<&str> = text.split("**").skip(1).step_by(2).collect();
        assert!(!bold.is_empty(), "{name}");
        for words in bold {
            let words = words.split_whitespace().collect::<Vec<_>>().join(" ");
            let known = FAULT_TABLE.iter().any(|entry| entry.name == words);
            assert!(known, "{name}: no fault is called {words}");
        }
    }
}

/// The sources of firmware and host, string literals in one line.
fn all_sources() -> String {
    let mut text = String::new();
    for directory in [".", "../host-tools"] {
        sources(&Path::new(FIRMWARE).join(directory), &mut text);
    }
    let lines = text.split("\\\n").map(str::trim_start);
    lines.collect::<Vec<_>>().concat()
}

/// What stands between single backticks and is more than a word.
fn quoted(text: &str) -> Vec<&str> {
    let text = text.split('`').skip(1).step_by(2);
    text.filter(|words| words.contains(' ')).collect()
}

/// In the first column of the tables stand sentences that `leg` or the firmware prints; an ellipsis is what varies.
#[test]
fn every_message_that_is_quoted_is_in_the_sources() {
    let (text, sources) = (page("TROUBLESHOOTING.md"), all_sources());
    let rows = text.lines().filter(|line| line.starts_with("| "));
    let first_column = rows.map(|row| row.split('|').nth(1).unwrap());
    let messages: Vec<&str> = first_column.flat_map(quoted).collect();
    assert!(messages.len() > 40, "{messages:?}");
    for message in messages {
        let parts = message
            .split('…')
            .map(|part| part.trim_matches([' ', '(', ')', ',', ':']));
        for part in parts.filter(|part| part.contains(' ')) {
            assert!(sources.contains(part), "{message}: {part}");
        }
    }
}

/// The longest time from the last check-in of a task to the round that finds it missing: one round counts it still, and it may
/// miss a number of them.
#[test]
fn the_page_says_when_a_task_is_missed_and_how_long_a_hasty_chip_waits() {
    let check_ins = CheckIns::new();
    let found_after_ms = |away: WatchedTask| {
        let mut watchdog = TaskWatchdog::default();
        check_ins.check_in(away);
        for round in 1_u64.. {
            for task in WatchedTask::ALL {
                if task != away {
                    check_ins.check_in(task);
                }
            }
            if watchdog.poll(&check_ins).is_some() {
                return round * CheckIns::PERIOD_MS;
            }
        }
        0
    };
    let [link_ms, settings_ms] = [WatchedTask::Link, WatchedTask::Settings].map(found_after_ms);
    let settings_s = settings_ms as f64 * 1e-3;
    let fatal = fs::read_to_string(Path::new(FIRMWARE).join("stm32g474/src/fatal.rs")).unwrap();
    let number = |name: &str| -> u32 {
        let (_, rest) = fatal.split_once(&format!("const {name}: u32 = ")).unwrap();
        let (number, _) = rest.split_once(';').unwrap();
        number.replace('_', "").parse().unwrap()
    };
    assert!(fatal.contains(
        // A round of the loop takes two to four cycles.
        "const REST_STEP_ROUNDS: u32 = CLOCK_HZ / 4_000;"
    ));
    assert!(fatal.contains("if failures >= HASTY_FAILURES {\n        rest();"));
    let (failures, rest_s) = (number("HASTY_FAILURES"), number("REST_STEPS") / 2_000);
    assert_eq!(failures, 3);
    let page = page("SAFETY.md");
    for words in [
        format!("within {link_ms} ms for the link, {settings_s} s for the settings"),
        format!(
            "After the third in a row the next start waits {rest_s} to {} s",
            2 * rest_s
        ),
    ] {
        assert!(page.contains(&words), "{words}");
    }
}

/// How long the recorder keeps so many signals, as the page about it says.
#[test]
fn the_page_tells_the_times_of_the_recorder() {
    let page = page("../host-tools/docs/commanding-a-leg.md").replace('\n', " ");
    let triples_s = TRIPLES_MAX as f64 / f64::from(TICK_HZ);
    let default = SignalSet::default().len();
    assert_eq!(default, 3, "the page names it");
    for sentence in [
        format!(
            "n signals for {triples_s} s / n, so up to three of them, as by default, for {:.1} s",
            triples_s / default as f64
        ),
        format!(
            "all eight for {} ms",
            1000.0 * triples_s / RECORDED_SIGNALS.len() as f64
        ),
    ] {
        assert!(page.contains(&sentence), "{sentence}");
    }
}
