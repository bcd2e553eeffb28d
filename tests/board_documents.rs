//! What the pages about the board say of pins, faults and messages is what the sources say.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use leg_firmware::supervisor::TABLE;
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

fn pins_of_the_image() -> BTreeSet<String> {
    let folder = Path::new(FIRMWARE).join("src/bin/leg-stm32g474");
    let mut found = BTreeSet::new();
    for entry in fs::read_dir(folder).unwrap() {
        found.append(&mut pins(
            &fs::read_to_string(entry.unwrap().path()).unwrap(),
        ));
    }
    found
}

#[test]
fn the_wiring_table_has_the_pins_of_the_image() {
    let text = page("BOARD.md");
    let rows = text.lines().filter(|line| line.starts_with("| P"));
    let first_column: String = rows
        .map(|row| row.split('|').nth(1).unwrap().to_owned() + "\n")
        .collect();
    let image = pins_of_the_image();
    assert!(image.len() > 30, "{image:?}");
    assert_eq!(pins(&first_column), image);
    assert!(pins(&text).is_subset(&image));
}

#[test]
fn the_picture_has_the_pins_of_the_image() {
    assert_eq!(pins(&page("wiring.svg")), pins_of_the_image());
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
            let known = TABLE.iter().any(|entry| entry.name == words);
            assert!(known, "{name}: no fault is called {words}");
        }
    }
}

/// Every Rust source below a folder.
fn sources(folder: &Path, text: &mut String) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            sources(&path, text);
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            text.push_str(&fs::read_to_string(path).unwrap());
        }
    }
}

/// The sources of firmware and host, string literals in one line.
fn all_sources() -> String {
    let mut text = String::new();
    for folder in ["src", "../host-tools/src"] {
        sources(&Path::new(FIRMWARE).join(folder), &mut text);
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
