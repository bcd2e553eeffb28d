//! What the board has recorded of the ticks before a fault.

use super::board::{BoardUnderTest, move_to};
use leg_host::recording::{self, Samples};
use serde_json::Value;
use std::collections::HashMap;
use std::fs;
use std::path::Path;
use std::process::Command;

/// Rows of a table by the names of its columns.
fn table(file: &Path) -> Vec<HashMap<String, String>> {
    let mut reader = csv::Reader::from_path(file).unwrap();
    reader.deserialize().map(Result::unwrap).collect()
}

fn number(row: &HashMap<String, String>, name: &str) -> f64 {
    row[name].parse().unwrap()
}

#[test]
fn what_happened_before_a_fault_can_be_read_after_it() {
    let directory = tempfile::tempdir().unwrap();
    let file = |name: &str| directory.path().join(name).display().to_string();
    let mut board = BoardUnderTest::new(&[]);
    board.json(&move_to("10"));
    board.json(&["hold"]);
    board.act(r#"{"fault":{"tendon_cut":2}}"#);
    let state = board.state();
    let (mcap, csv, plots) = (file("fault.mcap"), file("fault.csv"), file("plots"));
    let read = board.json(&["scope", "--out", &mcap, "--plots", &plots]);
    assert_eq!(
        read["signals"],
        serde_json::json!(["tensions", "pulled", "duties"])
    );
    assert_eq!(read["ticks"], 1600);
    assert_eq!(read["faults"], state["faults"], "{state}");
    assert_ne!(read["faults"], Value::Array(vec![]));
    let side = |name: &str| read[name].as_f64().unwrap();
    assert!((side("before_s") - 0.15).abs() < 0.001 && (side("after_s") - 0.05).abs() < 0.001);
    assert_eq!(read["plots"].as_array().unwrap().len(), 3);
    // A second reading finds the same.
    board.json(&["scope", "--out", &csv]);
    let rows = table(csv.as_ref());
    let first = number(&rows[0], "tick");
    for (index, row) in rows.iter().enumerate() {
        assert_eq!(number(row, "tick"), first + index as f64);
        assert_eq!(row["supply_v"], "", "it is not among the signals");
    }
    let at = |since_s: f64| {
        let is_there = |row: &&HashMap<String, String>| number(row, "since_fault_s") >= since_s;
        rows.iter().find(is_there).unwrap()
    };
    // The tendon that is cut had its tension, and has lost it when the fault is named.
    assert!(number(at(-0.14), "tensions_n_2") > 40.0, "{:?}", at(-0.14));
    assert!(number(at(0.0), "tensions_n_2") < 8.0, "{:?}", at(0.0));
    // The recording has the same numbers, to the last digit that an f64 has in a table.
    let recorded = recording::read_samples(mcap.as_ref()).unwrap();
    let Samples::Recorder(kept) = recorded.samples else {
        panic!("another kind of recording");
    };
    assert_eq!(kept.len(), rows.len());
    let tensions = |row: usize| kept[row].get(leg_firmware::settings::RecordedSignal::Tensions);
    assert_eq!(tensions(0).unwrap()[1].to_string(), rows[0]["tensions_n_2"],);
    // Drawn again they are the same charts.
    let again = file("again");
    let plot = Command::new(env!("CARGO_BIN_EXE_leg-under-test"))
        .args(["plot", &mcap, "--plots", &again])
        .output()
        .unwrap();
    assert!(plot.status.success(), "{plot:?}");
    let svg = |directory: &str| {
        fs::read_to_string(Path::new(directory).join("recorded_tensions.svg")).unwrap()
    };
    assert_eq!(svg(&plots), svg(&again));
}

#[test]
fn a_leg_without_a_fault_goes_on_recording() {
    let board = BoardUnderTest::new(&[]);
    board.json(&move_to("10"));
    let directory = tempfile::tempdir().unwrap();
    let file = directory.path().join("now.csv");
    let mut newest = 0.0;
    for _ in 0..2 {
        let read = board.json(&["scope", "--out", &file.display().to_string()]);
        let last = number(table(&file).last().unwrap(), "tick");
        assert!(last > newest, "{last}");
        newest = last;
        assert_eq!(read["faults"], Value::Array(vec![]));
        assert_eq!(read["after_s"], 0.0);
        assert!(read["ticks"].as_u64().unwrap() > 0);
    }
    assert_eq!(board.state()["state"], "keeping station");
}

#[test]
fn signals_are_chosen_by_the_rig_file_and_nothing_is_an_answer() {
    let chosen = "[control]\nrecorded = [\"currents\", \"pose\", \"board\", \"references\", \"target_tensions\"]\n";
    let board = BoardUnderTest::with_sections(chosen, &[]);
    let directory = tempfile::tempdir().unwrap();
    let file = directory.path().join("some.csv");
    board.json(&move_to("10"));
    let read = board.json(&["scope", "--out", &file.display().to_string()]);
    assert_eq!(read["ticks"], 960);
    let rows = table(&file);
    let last = rows.last().unwrap();
    assert_eq!(last["state"], "keeping station");
    assert!((number(last, "supply_v") - 24.0).abs() < 0.5, "{last:?}");
    assert!(
        (number(last, "temperature_c") - 30.0).abs() < 10.0,
        "{last:?}"
    );
    let leans = number(last, "direction_1").hypot(number(last, "direction_2"));
    assert!((leans.asin().to_degrees() - 10.0).abs() < 0.1, "{last:?}");
    assert!(number(last, "target_tensions_n_1") > 8.0, "{last:?}");
    assert_eq!(last["tensions_n_1"], "");
    let none = BoardUnderTest::with_sections("[control]\nrecorded = []\n", &[]);
    let (code, told) = none.refused(&["scope"]);
    assert_eq!(code, Some(2));
    assert!(
        told.contains("record nothing") && told.contains("`recorded`"),
        "{told}"
    );
}
