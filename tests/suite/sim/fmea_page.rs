//! The page of single faults: a row for each fault of the simulated leg, and what each row says shows it is there.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use crate::common::sources::sources;
use leg_boards::image::workspace_root;
use leg_firmware::supervisor::{FAULT_TABLE, Reaction};
use leg_sim::plant::Defect;
use leg_sim::ready_scenarios;
use std::fs;

const PARTS: [&str; 15] = [
    "Load cell",
    "Wire",
    "Amplifier",
    "Encoder",
    "Driver",
    "Motor",
    "Screw",
    "Tendon",
    "Supply",
    "Clock",
    "Memory",
    "Processor",
    "Link",
    "Host",
    "User",
];

fn page() -> String {
    fs::read_to_string(workspace_root().join("host-tools/docs/fmea.md")).unwrap()
}

/// The cells of each row.
fn rows(page: &str) -> Vec<Vec<&str>> {
    let rows = page.lines().filter(|line| line.starts_with("| "));
    let rows = rows.filter(|line| !line.starts_with("| fault |"));
    rows.map(|row| row.trim_matches('|').split('|').map(str::trim).collect())
        .collect()
}

/// The words between backticks.
fn quoted(text: &str) -> impl Iterator<Item = &str> {
    text.split('`').skip(1).step_by(2)
}

#[test]
fn every_fault_of_the_simulated_leg_has_a_row_and_every_part_a_table() {
    let page = page();
    let named: Vec<&str> = rows(&page).iter().flat_map(|row| quoted(row[0])).collect();
    for (name, _) in Defect::descriptions() {
        let count = named.iter().filter(|named| **named == name).count();
        assert_eq!(count, 1, "rows of {name}");
    }
    for part in PARTS {
        assert!(
            page.contains(&format!("\n## {part}\n\n| fault |")),
            "{part}"
        );
    }
}

#[test]
fn what_shows_a_row_is_there() {
    let page = page();
    let mut tests = String::new();
    for directory in ["tests/suite", "firmware/library/src", "host-tools/host/src"] {
        sources(&workspace_root().join(directory), &mut tests);
    }
    for row in rows(&page) {
        assert_eq!(row.len(), 6, "{row:?}");
        assert!(row.iter().all(|cell| !cell.is_empty()), "{row:?}");
        let defects: Vec<&str> = quoted(row[0]).collect();
        for name in &defects {
            assert!(
                row[5].contains(&format!("strike `{name}`")),
                "{name}: {}",
                row[5]
            );
        }
        if row[5] == "not shown" {
            continue;
        }
        for shown in row[5].split(", ") {
            let (kind, name) = shown.split_once(' ').unwrap();
            let name = name.trim_matches('`');
            let known = match kind {
                "scenario" => ready_scenarios::named(name).is_some(),
                "strike" => Defect::descriptions().any(|(defect, _)| defect == name),
                "test" | "calculation" => tests.contains(&format!("fn {name}(")),
                _ => false,
            };
            assert!(known, "{row:?}: {shown}");
        }
    }
}

/// The words between pairs of asterisks.
fn bold(text: &str) -> impl Iterator<Item = &str> {
    text.split("**").skip(1).step_by(2)
}

/// Bold words are faults, and every fault is in the page.
#[test]
fn every_fault_is_named_by_its_name() {
    let page = page();
    let named: Vec<&str> = bold(&page).collect();
    for words in &named {
        let known = FAULT_TABLE.iter().any(|entry| entry.name == *words);
        assert!(known, "no fault is called {words}");
    }
    for entry in FAULT_TABLE {
        assert!(named.contains(&entry.name), "no row names {}", entry.name);
    }
}

/// A row whose faults stop the leg says how.
#[test]
fn the_leg_does_what_its_faults_lead_to() {
    for row in rows(&page()) {
        let found = FAULT_TABLE
            .iter()
            .filter(|entry| bold(row[1]).any(|words| words == entry.name));
        for entry in found {
            let words = match entry.reaction {
                Reaction::Limit => continue,
                Reaction::Hold => "held",
                Reaction::RampDown => "ramps down",
                Reaction::GateOff => "off",
            };
            assert!(row[3].contains(words), "{}: {row:?}", entry.name);
        }
    }
}
