#![allow(clippy::unwrap_used, reason = "a test may panic")]

use super::{
    LegConstants, REPORT_SIGNALS, Report, SIMULATED_SIGNALS, columns, json_object, json_schema,
    row, telemetry,
};
use leg_firmware::settings::Settings;
use leg_firmware::supervisor::{Fault, FaultSet, State};
use leg_firmware::telemetry::Telemetry;
use serde_json::Value;
use std::collections::BTreeSet;

/// Something in every field.
fn reported(state: State, faults: FaultSet) -> Telemetry<f32> {
    Telemetry {
        tick: 4_000_000_001,
        state,
        faults,
        homed: true,
        failed_tendon: 2,
        moving: true,
        commanded: [0.3, -0.200_000_02],
        target: [0.1, -0.2],
        pose: [0.100_000_03, -0.3],
        residual_m: 1.234_567_9e-7,
        tensions_n: [70.064_1, 0.1, 1e-8],
        target_tensions_n: [f32::MIN_POSITIVE, 8.0, 149.999_98],
        pulled_m: [0.012_345_678, -1e-3, 3e-3],
        reference_m: [0.012_345_679, -1e-3, 3e-3],
        motor_currents_a: [0.3, -0.25, 1.5],
        supply_v: 23.9,
        temperature_c: -3.25,
        pretension_commanded_n: None,
        stiffness_commanded_nm_per_rad: Some(110.000_01),
        pretension_n: 70.1,
        stiffness_nm_per_rad: 84.300_02,
        load_nm: [-0.7, 1.0 / 3.0],
        payload_kg: 0.987_654_3,
        unstretched_at_zero_m: [0.033_149_127, 0.034, 0.035],
        elongation_factor: 1.199_999_9,
    }
}

fn report(telemetry: &Telemetry<f32>) -> Report {
    Report::new(telemetry, &LegConstants::new(&Settings::table_1().unwrap()))
}

#[test]
fn every_name_is_there_once_and_ends_with_its_unit_where_it_has_one() {
    let names = REPORT_SIGNALS.iter().map(|signal| signal.name);
    let names: Vec<_> = names
        .chain(SIMULATED_SIGNALS.iter().map(|signal| signal.name))
        .collect();
    let once: BTreeSet<_> = names.iter().collect();
    assert_eq!(once.len(), names.len());
    let units = [
        "_s",
        "_deg",
        "_mm",
        "_m",
        "_n",
        "_nm",
        "_kg",
        "_nm_per_rad",
        "_rad_per_s",
        "_a",
        "_v",
        "_c",
    ];
    let plain = [
        "tick",
        "damaged_frames",
        "state",
        "state_index",
        "faults",
        "homed",
        "failed_tendon",
        "moving",
        "direction",
        "direction_commanded",
        "direction_reference",
        "duties",
        "elongation_factor",
    ];
    for name in names {
        let has_unit = units.iter().any(|unit| name.ends_with(unit));
        assert!(has_unit != plain.contains(&name), "{name}");
    }
}

#[test]
fn telemetry_comes_back_from_json_as_it_was() {
    let mut faults = FaultSet::single(Fault::Slack);
    faults.add(Fault::LateTick, true);
    for state in State::ALL {
        for faults in [FaultSet::NONE, faults] {
            let written = reported(state, faults);
            let json = Value::Object(json_object(REPORT_SIGNALS, &report(&written))).to_string();
            assert_eq!(telemetry(json.as_bytes()), Ok(written));
        }
    }
}

#[test]
fn what_is_missing_or_unknown_is_named() {
    let json = |key: &str, value: Value| {
        let mut object = json_object(
            REPORT_SIGNALS,
            &report(&reported(State::Held, FaultSet::NONE)),
        );
        object.insert(key.into(), value);
        telemetry(Value::Object(object).to_string().as_bytes()).unwrap_err()
    };
    assert!(json("state", "asleep".into()).contains("asleep"));
    assert!(json("faults", vec!["no such fault"].into()).contains("no such fault"));
    assert!(
        json("tick", "one".into()).contains("tick") || json("tick", "one".into()).contains("u32")
    );
    assert!(telemetry(b"{}").unwrap_err().contains("missing field"));
}

#[test]
fn a_number_has_the_digits_of_an_f32_and_what_is_not_known_is_null() {
    let report = report(&reported(State::Held, FaultSet::NONE));
    let object = json_object(REPORT_SIGNALS, &report);
    assert_eq!(object["tensions_n"].to_string(), "[70.0641,0.1,1e-8]");
    assert_eq!(object["wall_time_s"], Value::Null);
    assert_eq!(object["damaged_frames"], Value::Null);
    let received = json_object(REPORT_SIGNALS, &report.received(1.7e9, 3));
    assert_eq!(
        (&received["wall_time_s"], &received["damaged_frames"]),
        (&1.7e9.into(), &3.into())
    );
}

#[test]
fn a_table_has_as_many_cells_as_columns_and_names_of_faults() {
    let report = report(&reported(State::Held, {
        let mut faults = FaultSet::single(Fault::Slack);
        faults.add(Fault::LateTick, true);
        faults
    }));
    let (names, cells): (Vec<_>, Vec<_>) = (
        columns(REPORT_SIGNALS).collect(),
        row(REPORT_SIGNALS, &report).collect(),
    );
    assert_eq!(names.len(), cells.len());
    let cell = |name: &str| cells[names.iter().position(|found| found == name).unwrap()].as_str();
    assert_eq!(cell("faults"), "slack tendon; late tick");
    assert_eq!((cell("state"), cell("homed")), ("held", "true"));
    assert_eq!((cell("tensions_n_1"), cell("wall_time_s")), ("70.0641", ""));
}

/// Every property of the schema has a meaning, and every message all of them.
#[test]
fn the_schema_describes_the_message() {
    let schema = json_schema("/leg", REPORT_SIGNALS);
    let properties = schema["properties"].as_object().unwrap();
    let object = json_object(
        REPORT_SIGNALS,
        &report(&reported(State::Held, FaultSet::NONE)),
    );
    assert!(properties.keys().eq(object.keys()));
    let declared = REPORT_SIGNALS.iter().map(|signal| signal.name);
    assert!(object.keys().eq(declared), "in the order of the table");
    assert_eq!(
        schema["required"].as_array().unwrap().len(),
        properties.len()
    );
    for (name, property) in properties {
        let words = property["description"].as_str().unwrap();
        assert!(words.ends_with('.'), "{name}: {words}");
        let is_array = property["type"] == "array";
        assert_eq!(object[name].is_array(), is_array, "{name}");
    }
}
