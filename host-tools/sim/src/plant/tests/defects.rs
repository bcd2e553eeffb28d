//! Each defect does what its name says.

use super::{HELD, OFF, PlantSettings, driven, plant, ready, run};
use crate::action::Action;
use crate::plant::{Defect, Plant};
use leg_firmware::sensors::{CODE_MAX, Sensors};

const N_PER_CODE: f64 = 250.0 / CODE_MAX as f64;

fn held() -> Plant {
    plant(&ready("table1"), &PlantSettings::default(), HELD)
}

/// A leg after ticks of its motors, with a defect or without.
fn driven_leg(defect: Option<Defect>, ticks: u32) -> (Plant, Sensors) {
    let mut plant = held();
    plant.sense();
    if let Some(defect) = defect {
        plant.set_defect(defect, true);
    }
    run(&mut plant, ticks, &driven([0.3; 3]));
    let sensors = plant.sense();
    (plant, sensors)
}

fn defective(defect: Defect, ticks: u32) -> (Plant, Sensors) {
    driven_leg(Some(defect), ticks)
}

fn sound(ticks: u32) -> Sensors {
    driven_leg(None, ticks).1
}

#[test]
fn a_cut_tendon_does_not_pull() {
    let tensions = defective(Defect::TendonCut(1), 40).0.truth().tensions_n;
    assert_eq!(tensions.map(|tension| tension > 0.0), [true, false, true]);
}

#[test]
fn cells() {
    let (first, sound) = (held().sense(), sound(400));
    for (defect, cell, code) in [
        (Defect::CellStuck(0), 0, first.cell_codes[0]),
        (Defect::CellStale(1), 1, first.cell_codes[1]),
        (Defect::CellSaturated(2), 2, CODE_MAX),
        (Defect::CellDead(1), 1, 0),
    ] {
        let (_, sensors) = defective(defect, 400);
        let mut expected = sound;
        expected.cell_codes[cell] = code;
        expected.cell_fresh[cell] = defect != Defect::CellStale(cell);
        assert_eq!(sensors.cell_codes, expected.cell_codes, "{defect:?}");
        assert_eq!(sensors.cell_fresh, expected.cell_fresh, "{defect:?}");
    }
    let (_, drifting) = defective(Defect::CellDrifting(2), 400);
    let drift = f64::from(drifting.cell_codes[2]) - f64::from(sound.cell_codes[2]);
    assert!((drift * N_PER_CODE - 0.25).abs() < 0.01, "{drift} codes");
    assert_eq!(drifting.cell_codes[..2], sound.cell_codes[..2]);
}

#[test]
fn encoders() {
    let sound = sound(400).encoder_counts;
    let counts = sound[1];
    assert!(counts > 1000, "{counts}");
    for (defect, expected) in [
        (Defect::EncoderLost(1), 0),
        (Defect::EncoderSlipping(1), counts - counts / 10),
        (Defect::EncoderReversed(1), 0_u16.wrapping_sub(counts)),
    ] {
        let found = defective(defect, 400).1.encoder_counts;
        assert_eq!(found, [sound[0], expected, sound[2]], "{defect:?}");
    }
}

#[test]
fn motors() {
    let (jammed, sensors) = defective(Defect::MotorJammed(0), 400);
    assert_eq!(sensors.encoder_counts[0], 0);
    assert!(sensors.encoder_counts[1] > 0);
    let truth = jammed.truth();
    let stalled_a = f64::from(0.3_f32) * truth.supply_v / 2.32;
    assert!(
        (truth.currents_a[0] / stalled_a - 1.0).abs() < 1e-3,
        "{truth:?}"
    );
    let (failed, sensors) = defective(Defect::DriverFault(2), 400);
    assert_eq!(sensors.driver_fault, [false, false, true]);
    assert_eq!(sensors.encoder_counts[2], 0);
    assert_eq!(failed.truth().currents_a[2], 0.0);
    let part = |sensors: Sensors| f64::from(sensors.current_codes[1]) / f64::from(CODE_MAX);
    let (_, offset) = defective(Defect::CurrentOffset(1), 0);
    let range_a = 2.0 * ready("table1").actuator.current_range_a;
    let off_a = (part(offset) - part(sound(0))) * range_a;
    assert!((off_a - 10.0).abs() < 2e-3, "{off_a} A");
}

#[test]
fn supply_clock_and_settings() {
    let volts = |sensors: Sensors| f64::from(sensors.supply_code) / f64::from(CODE_MAX) * 36.0;
    for (defect, range_v) in [
        (Defect::SupplySag, 9.0..11.0),
        (Defect::SupplySurge, 29.0..32.0),
    ] {
        let (plant, sensors) = defective(defect, 40);
        let found_v = volts(sensors);
        assert!((found_v - plant.truth().supply_v).abs() < 1e-3);
        assert!(range_v.contains(&found_v), "{defect:?}: {found_v} V");
    }
    let celsius =
        |sensors: Sensors| f64::from(sensors.temperature_code) / f64::from(CODE_MAX) * 200.0 - 40.0;
    let (mut hot, sensors) = defective(Defect::Overheating, 8000);
    assert!((celsius(sensors) - 45.0).abs() < 0.01);
    hot.set_defect(Defect::Overheating, false);
    run(&mut hot, 16_000, &OFF);
    assert!((celsius(hot.sense()) - 25.0).abs() < 0.01);
    assert!(defective(Defect::LateTicks, 1).1.late && !sound(1).late);
    let corrupt = defective(Defect::SettingsCorrupt, 1).1.settings_corrupt;
    assert!(corrupt && !sound(1).settings_corrupt);
}

#[test]
fn the_emergency_stop_is_seen() {
    let mut plant = held();
    for pressed in [false, true, false] {
        plant.press_emergency_stop(pressed);
        assert_eq!(plant.sense().emergency_stop, pressed);
    }
}

/// As a user writes it: counted from 1.
#[test]
fn every_defect_has_a_name_of_its_own() {
    let mut names = Vec::new();
    for defect in Defect::all() {
        let name = serde_json::to_string(&defect).unwrap();
        let action = Action::parse(&format!(r#"{{"fault":{name}}}"#));
        assert_eq!(action, Ok(Action::Fault(defect)), "{name}");
        names.push(name);
    }
    assert!(names.contains(&r#"{"tendon_cut":1}"#.into()));
    assert!(names.contains(&r#""supply_sag""#.into()));
    names.sort();
    names.dedup();
    assert_eq!(names.len(), 41);
    for number in [0, 4] {
        let line = format!(r#"{{"fault":{{"tendon_cut":{number}}}}}"#);
        assert!(Action::parse(&line).is_err());
    }
}
