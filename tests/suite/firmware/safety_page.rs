//! The page on safety: what it promises quotes a test that is there, and its numbers are those of the built-in settings.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use crate::common::quoted_tests::{require_test, test_sources};
use leg_boards::image::workspace_root;
use leg_firmware::jog::JOG_TRAVEL_MAX_M;
use leg_firmware::sensors::CURRENT_ZERO_PART;
use leg_rig::control_settings;
use leg_rig::ready_rigs::READY_RIGS;
use leg_rig::rig_file::RigFile;
use leg_sim::ready_scenarios;
use std::fs;

/// What the page names between backticks beside tests and scenarios: keys of a rig file. Any other name has to be one of those.
const KEYS: [&str; 12] = [
    "command_time_s",
    "current_output",
    "damping_ratio",
    "elongation_factor",
    "f_max_n",
    "jump_n",
    "over_tension_part",
    "ramp_m_per_s",
    "relax_travel_m",
    "resistance_ohm",
    "tare_max_n",
    "taut_time_s",
];

/// What the page calls any of them.
const ANY: &str = "this_type";

fn page() -> String {
    fs::read_to_string(workspace_root().join("firmware/SAFETY.md")).unwrap()
}

/// The tests and ready scenarios between backticks.
fn quotes(text: &str) -> Vec<&str> {
    let quoted = text.split('`').skip(1).step_by(2);
    let is_name = |text: &&str| {
        let mut letters = text.chars();
        letters
            .all(|letter| letter.is_ascii_lowercase() || letter.is_ascii_digit() || letter == '_')
    };
    let is_quote = |text: &&str| {
        let other = text == &ANY || KEYS.contains(text);
        text.contains('_') && !other || ready_scenarios::named(text).is_some()
    };
    quoted.filter(is_name).filter(is_quote).collect()
}

/// What stands between two headings.
fn section<'a>(page: &'a str, heading: &str) -> &'a str {
    let (_, rest) = page.split_once(&format!("\n## {heading}\n")).unwrap();
    rest.split_once("\n## ")
        .map_or(rest, |(section, _)| section)
}

#[test]
fn every_test_that_the_page_quotes_is_there() {
    let (page, tests) = (page(), test_sources());
    let quoted = quotes(&page);
    assert!(quoted.len() > 80, "{}", quoted.len());
    for name in quoted {
        if ready_scenarios::named(name).is_some() {
            continue;
        }
        require_test(&tests, name);
    }
}

/// What a browser shows is quoted with its file: CI runs that, and it runs what is quoted.
#[test]
fn what_the_page_quotes_of_a_browser_is_run() {
    let page = page();
    let (_, name) = page.split_once("a hidden page: `").unwrap();
    let (name, rest) = name.split_once("` in `").unwrap();
    let (file, _) = rest.split_once('`').unwrap();
    let source = fs::read_to_string(workspace_root().join(file)).unwrap();
    let (_, main) = source.split_once("\ndef main():\n").unwrap();
    assert!(source.contains(&format!("\ndef {name}(page):\n")));
    assert!(main.contains(&format!("\n        {name}(page)\n")));
    let runs = fs::read_to_string(workspace_root().join("host-tools/window/test.sh")).unwrap();
    let (_, file) = file.split_once("window/").unwrap();
    assert!(runs.contains(&format!("\npython3 {file} ")));
}

/// Each row of the tables, each point and each paragraph that says what the leg does.
#[test]
fn every_promise_of_the_page_quotes_what_shows_it() {
    let page = page();
    let mut promises = Vec::new();
    for heading in ["States", "What happens when"] {
        let rows = section(&page, heading)
            .lines()
            .filter(|line| line.starts_with("| "));
        // From the one after the table's head.
        for row in rows.skip(1) {
            let shown = row.trim_end_matches([' ', '|']).rsplit(" | ").next();
            promises.push(shown.unwrap());
        }
    }
    for heading in [
        "States",
        "Reactions, from the mildest to the most severe",
        "The maximum tension",
    ] {
        let text = section(&page, heading);
        let points = text
            .split("\n\n")
            .filter(|part| !part.trim().starts_with('|'));
        let points = points.flat_map(|part| part.split("\n- "));
        promises.extend(
            points.filter(|point| !EXEMPT.iter().any(|words| point.trim().starts_with(words))),
        );
    }
    assert!(promises.len() > 40, "{}", promises.len());
    for promise in promises {
        assert!(!quotes(promise).is_empty(), "nothing shows: {promise}");
    }
}

/// Paragraphs that promise nothing, and points that stand under a sentence that quotes.
const EXEMPT: [&str; 9] = [
    "The numbers are the built-in settings",
    "Choose tendons",
    "1. limit:",
    "while the drivers are off",
    "while somebody pulls",
    "in held, once it has braked",
    "while one of these faults comes",
    "where a load cell reads too little",
    "- while the drivers are off",
];

/// Numbers of the page that are settings.
#[test]
fn the_settings_that_the_page_names_are_the_built_in_ones() {
    let rig = RigFile::load(None).unwrap();
    let settings = control_settings::settings(&rig, &rig.gains, None);
    let (limits, homing) = (settings.limits, settings.homing);
    let page: Vec<String> = page().split_whitespace().map(String::from).collect();
    let page = page.join(" ");
    for words in [
        format!("with a low maximum tension ({} N;", homing.f_max_n),
        format!(
            "by {:.0} mm (`relax_travel_m`)",
            1e3 * limits.relax_travel_m
        ),
        format!(
            "the farthest at {:.0} mm/s (`ramp_m_per_s`)",
            1e3 * limits.ramp_m_per_s
        ),
        format!(
            "after {} s (`command_time_s`) of silence",
            limits.command_time_s
        ),
        format!("within {} s (`taut_time_s`)", limits.taut_time_s),
        format!("an offset of up to {} N (`tare_max_n`)", homing.tare_max_n),
        // Test `a_tendon_gives_way_by_the_square_of_what_is_beyond_the_maximum`: 2.5 bands.
        format!(
            "slowly at first, {} N beyond it by the whole speed",
            2.5 * settings.greatest(|servo| servo.f_max_band_n)
        ),
        format!(
            "whose zero is off by {:.0} % of its range at the start",
            100.0 * CURRENT_ZERO_PART
        ),
        format!("no more than {} N (half of `jump_n`)", 0.5 * limits.jump_n),
        format!(
            "{} N above what its tendons pull at the start",
            homing.touch_n
        ),
        format!(
            "turns at a low voltage by {} mm of tendon at the most",
            1e3 * JOG_TRAVEL_MAX_M
        ),
    ] {
        assert!(page.contains(&words), "{words}");
    }
    assert!((limits.over_tension_part - 0.1).abs() < 1e-6);
    assert!(page.contains("Above the maximum tension by a tenth (`over_tension_part`)"));
}

/// A pull turns no screw that a rig file may have.
#[test]
fn no_screw_that_a_pull_could_turn_is_accepted() {
    let text = |efficiency: &str| {
        format!(
            "{}[actuator]\nscrew_efficiency = {efficiency}\n",
            READY_RIGS[0].text
        )
    };
    assert!(RigFile::parse("screw", &text("0.49")).is_ok());
    for efficiency in ["0.5", "0.55", "0.9", "1"] {
        let refused = RigFile::parse("screw", &text(efficiency)).unwrap_err();
        assert!(
            refused.render(false).contains("screw_efficiency"),
            "{efficiency}"
        );
    }
}
