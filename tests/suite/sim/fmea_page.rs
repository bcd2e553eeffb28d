//! The page of single faults: a row for each fault of the simulated leg, and what each row says shows it is there.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use super::ready_runs::scenario;
use crate::common::quoted_tests::{require_test, test_sources};
use leg_bench::strikes::{Activity, StrikeBars};
use leg_boards::image::workspace_root;
use leg_firmware::supervisor::{FAULT_TABLE, Fault, Reaction, State};
use leg_sim::plant::Defect;
use leg_sim::ready_scenarios;
use leg_sim::scenario::{Measurand, Step, TestStep};
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

/// The rows' tables, without that of the strikes' bars.
fn page() -> String {
    let page = fs::read_to_string(workspace_root().join("host-tools/docs/fmea.md")).unwrap();
    page.split("\n## Bars of the strikes")
        .next()
        .unwrap()
        .into()
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
    let tests = test_sources();
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
                "test" | "calculation" => {
                    require_test(&tests, name);
                    true
                }
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

/// What shows a row: of one kind, by name.
fn shown<'a>(row: &'a [&str], kind: &'a str) -> impl Iterator<Item = &'a str> {
    let shown = row[5].split(", ").filter_map(|one| one.split_once(' '));
    shown
        .filter(move |(other, _)| *other == kind)
        .map(|(_, name)| name.trim_matches('`'))
}

/// The reactions that the scenarios of a row wait for, with the time of each, s.
fn reactions(row: &[&str]) -> Vec<(Fault, State, f64)> {
    let steps = shown(row, "scenario").flat_map(|name| scenario(name).steps);
    let reactions = steps.filter_map(|step| match step {
        Step::Test(TestStep::Reaction {
            fault,
            state,
            within_ms,
        }) => Some((fault, state, 1e-3 * within_ms)),
        _ => None,
    });
    reactions.collect()
}

/// The bars of the strikes of a row, with their states.
fn bars_by_state(row: &[&str]) -> Vec<(Activity, StrikeBars)> {
    let kinds = shown(row, "strike").map(|name| {
        let mut names = Defect::descriptions().map(|(defect, _)| defect);
        Defect::numbered(names.position(|defect| defect == name).unwrap(), 0).unwrap()
    });
    let bars = kinds.flat_map(|defect| {
        let all = (0..Activity::count()).map(Activity::nth);
        all.flat_map(move |activity| {
            let bars = |near| StrikeBars::widest(defect, activity, F_MAX_N, near);
            [false, true].map(|near| (activity, bars(near)))
        })
    });
    bars.collect()
}

/// The bars of the strikes of a row.
fn bars(row: &[&str]) -> Vec<StrikeBars> {
    let bars = bars_by_state(row).into_iter();
    bars.map(|(_, bars)| bars).collect()
}

/// Any maximum tension: the bars are parts of it, N.
const F_MAX_N: f64 = 100.0;

/// The numbers of a cell that stand before a word.
fn numbers(cell: &str, unit: &str) -> Vec<f64> {
    let words: Vec<&str> = cell.split([' ', ',', ';', ':']).collect();
    let pairs = words.windows(2).filter(|pair| pair[1] == unit);
    pairs.filter_map(|pair| pair[0].parse().ok()).collect()
}

fn times_s(cell: &str) -> Vec<f64> {
    let ms = numbers(cell, "ms")
        .into_iter()
        .map(|time_ms| 1e-3 * time_ms);
    ms.chain(numbers(cell, "s")).collect()
}

fn has(numbers: &[f64], number: f64) -> bool {
    numbers.iter().any(|other| (other - number).abs() < 1e-9)
}

/// "How soon" is what the scenarios of a row assert, or where it has none, its strikes.
#[test]
fn a_row_says_how_soon_its_fault_is_named() {
    let page = page();
    let (mut by_scenario, mut by_strike, mut wrong) = (0, 0, Vec::new());
    for row in rows(&page) {
        let claimed_s = times_s(row[2]);
        let scenarios_s: Vec<f64> = reactions(&row).iter().map(|reaction| reaction.2).collect();
        let strikes_s: Vec<f64> = bars(&row).iter().filter_map(|bars| bars.named_s).collect();
        let mut others = ["test", "calculation"].iter();
        let by_run = scenarios_s.is_empty() && strikes_s.is_empty();
        if by_run && others.any(|kind| shown(&row, kind).next().is_some()) {
            // What a test asserts stands in it.
            continue;
        }
        let told = scenarios_s.iter().all(|time_s| has(&claimed_s, *time_s));
        let asserted = |time_s: &f64| has(&scenarios_s, *time_s) || has(&strikes_s, *time_s);
        let none = row[2].starts_with("none") && strikes_s.is_empty() || row[5] == "not shown";
        if !told || !claimed_s.iter().all(asserted) || claimed_s.is_empty() && !none {
            wrong.push(format!(
                "{row:?}: scenarios {scenarios_s:?} s, strikes {strikes_s:?} s"
            ));
        }
        by_scenario += usize::from(!scenarios_s.is_empty());
        by_strike += usize::from(scenarios_s.is_empty() && !claimed_s.is_empty());
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    assert!(
        by_scenario > 25 && by_strike > 5,
        "{by_scenario} {by_strike}"
    );
}

/// The scenarios of a row wait for a fault of the row, and for the state that the row says.
#[test]
fn a_row_says_what_its_scenarios_show_of_the_leg() {
    for row in rows(&page()) {
        for (fault, state, _) in reactions(&row) {
            let name = fault.entry().name;
            assert!(bold(row[1]).any(|words| words == name), "{name}: {row:?}");
            let words: &[&str] = match state {
                State::Held => &["held"],
                State::Off => &["off"],
                State::RampingDown => &["ramps down"],
                State::Active => &["goes on", "stays", "goes to", "comes to rest"],
                _ => &[],
            };
            let said = words.iter().any(|words| row[3].contains(words));
            assert!(said, "{state:?}: {row:?}");
        }
    }
}

/// How far the tip goes and how high a tension, where a row says it, is a bar of its strikes; of a row without strikes, what its
/// scenarios let pass.
#[test]
fn a_row_says_how_far_its_strikes_may_go() {
    let page = page();
    let (mut checked, mut wrong) = (0, Vec::new());
    for row in rows(&page) {
        let bars = bars(&row);
        let mut allowed_mm: Vec<f64> = bars.iter().map(|bars| bars.tip_mm).collect();
        if bars.is_empty() {
            let steps = shown(&row, "scenario").flat_map(|name| scenario(name).steps);
            allowed_mm = steps.filter_map(|step| tip_moved_mm(&step)).collect();
        }
        for claimed_mm in tips_mm(&row) {
            if !has(&allowed_mm, claimed_mm) {
                wrong.push(format!("{claimed_mm} mm of {allowed_mm:?}: {row:?}"));
            }
            checked += 1;
        }
        if bars.is_empty() {
            continue;
        }
        let beyond: Vec<f64> = bars.iter().map(|bars| bars.tension_n - F_MAX_N).collect();
        for percent in numbers(row[4], "%") {
            if !has(&beyond, percent) {
                wrong.push(format!("{percent} % of {beyond:?}: {row:?}"));
            }
            checked += 1;
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    assert!(checked > 15, "{checked}");
}

/// How far the tip goes by what is left of a row, mm.
fn tips_mm(row: &[&str]) -> Vec<f64> {
    let tips = row[4].split("tip ").skip(1);
    tips.flat_map(|words| numbers(words, "mm").into_iter().take(1))
        .collect()
}

/// What any strike may do in a state, as the page says above its rows: how far the tip may go, mm.
const fn usual_mm(activity: Activity) -> f64 {
    match activity {
        Activity::Following | Activity::Held | Activity::Disarmed => 0.5,
        Activity::Moving | Activity::Arming => 3.0,
        Activity::Rearmed => 2.0,
        Activity::RampingDown => 10.0,
        Activity::Homing => 90.0,
    }
}

/// The same of the tension, N: of one of 100 N, and while homing.
const USUAL_N: f64 = 110.0;
const USUAL_HOMING_N: f64 = 25.0;

/// A row says how far the tip goes, and how high a tension, wherever that is more than what any strike may do in that state.
#[test]
fn a_row_says_what_its_strikes_may_do_beyond_the_usual() {
    let page = page();
    let words: Vec<&str> = page.split_whitespace().collect();
    let [rest, way, again, out, homing] = [
        Activity::Held,
        Activity::Moving,
        Activity::Rearmed,
        Activity::RampingDown,
        Activity::Homing,
    ]
    .map(usual_mm);
    let said = format!(
        "tension {:.0} % above the maximum, {USUAL_HOMING_N} N while homing; tip {rest} mm at rest, {way} mm off its way, {again} mm where it is armed \
         again with its fault, {out} mm while it is paid out, {homing} mm while homing",
        USUAL_N - F_MAX_N
    );
    assert!(words.join(" ").contains(&said), "{said}");
    let mut wrong = Vec::new();
    for row in rows(&page) {
        let (tips_mm, percents) = (tips_mm(&row), numbers(row[4], "%"));
        let tensions_n = numbers(row[4], "N");
        let mut highest_n = USUAL_N;
        for (activity, bars) in bars_by_state(&row) {
            let homing = bars.homing_n <= USUAL_HOMING_N || has(&tensions_n, bars.homing_n);
            assert!(homing, "{row:?}");
            highest_n = highest_n.max(bars.tension_n);
            if bars.tip_mm > usual_mm(activity) && !has(&tips_mm, bars.tip_mm) {
                let state = activity.name();
                wrong.push(format!("{} mm in {state}: {row:?}", bars.tip_mm));
            }
        }
        if highest_n > USUAL_N + 1e-9 && !has(&percents, highest_n - F_MAX_N) {
            wrong.push(format!("{} %: {row:?}", highest_n - F_MAX_N));
        }
    }
    wrong.dedup();
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// The highest motion of the tip that a step lets pass, mm.
fn tip_moved_mm(step: &Step) -> Option<f64> {
    match step {
        Step::Test(TestStep::Measure {
            quantity: Measurand::TipMovedMm,
            between,
            ..
        }) => Some(between[1]),
        _ => None,
    }
}
