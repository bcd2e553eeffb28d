//! Each fault does what its name says.

use super::{HELD, OFF, PlantSettings, driven, plant, ready, run};
use crate::plant::{Fault, Plant};
use leg_firmware::sensors::{CODE_MAX, Sensors};
use serde::{Deserialize, Serialize};

const N_PER_CODE: f64 = 250.0 / CODE_MAX as f64;

fn held() -> Plant {
    plant(&ready("table1"), &PlantSettings::default(), HELD)
}

/// A leg with a fault after a tick of its motors.
fn faulty(fault: Fault, ticks: u32) -> (Plant, Sensors) {
    let mut plant = held();
    plant.sense();
    plant.set_fault(fault, true);
    run(&mut plant, ticks, &driven([0.3; 3]));
    let sensors = plant.sense();
    (plant, sensors)
}

/// The same without it.
fn sound(ticks: u32) -> Sensors {
    let mut plant = held();
    plant.sense();
    run(&mut plant, ticks, &driven([0.3; 3]));
    plant.sense()
}

#[test]
fn a_cut_tendon_does_not_pull() {
    let (plant, _) = faulty(Fault::TendonCut(1), 40);
    let tensions = plant.truth().tensions_n;
    assert!(
        tensions[0] > 0.0 && tensions[1] == 0.0 && tensions[2] > 0.0,
        "{tensions:?}"
    );
}

#[test]
fn faults_of_cells() {
    let first = held().sense();
    let (_, stuck) = faulty(Fault::CellStuck(0), 400);
    assert_eq!(stuck.cell_codes[0], first.cell_codes[0]);
    assert_eq!(stuck.cell_fresh, [true; 3]);
    let (_, stale) = faulty(Fault::CellStale(1), 400);
    assert_eq!(stale.cell_codes[1], first.cell_codes[1]);
    assert_eq!(stale.cell_fresh, [true, false, true]);
    let (_, saturated) = faulty(Fault::CellSaturated(2), 400);
    assert_eq!(saturated.cell_codes[2], CODE_MAX);
    let (_, dead) = faulty(Fault::CellDead(1), 400);
    assert_eq!(dead.cell_codes[1], 0);
    let (_, drifting) = faulty(Fault::CellDrifting(2), 400);
    let drift = f64::from(drifting.cell_codes[2]) - f64::from(sound(400).cell_codes[2]);
    assert!((drift * N_PER_CODE - 0.25).abs() < 0.01, "{drift} codes");
    // The other cells show what they would have shown.
    assert_eq!(drifting.cell_codes[..2], sound(400).cell_codes[..2]);
    assert_eq!(stuck.cell_codes[1..], sound(400).cell_codes[1..]);
}

#[test]
fn faults_of_encoders() {
    let counts = sound(400).encoder_counts[1];
    assert!(counts > 1000, "{counts}");
    let (_, lost) = faulty(Fault::EncoderLost(1), 400);
    assert_eq!(lost.encoder_counts[1], 0);
    let (_, slipping) = faulty(Fault::EncoderSlipping(1), 400);
    assert_eq!(slipping.encoder_counts[1], counts - counts / 10);
    let (_, reversed) = faulty(Fault::EncoderReversed(1), 400);
    assert_eq!(reversed.encoder_counts[1], 0_u16.wrapping_sub(counts));
    assert_eq!(reversed.encoder_counts[0], sound(400).encoder_counts[0]);
}

#[test]
fn faults_of_motors() {
    let (jammed, sensors) = faulty(Fault::MotorJammed(0), 400);
    assert_eq!(sensors.encoder_counts[0], 0);
    assert!(sensors.encoder_counts[1] > 0);
    let truth = jammed.truth();
    let stalled = f64::from(0.3_f32) * truth.supply_v / 2.32;
    assert!(
        (truth.currents_a[0] / stalled - 1.0).abs() < 1e-3,
        "{truth:?}"
    );
    let (failed, sensors) = faulty(Fault::DriverFault(2), 400);
    assert_eq!(sensors.driver_fault, [false, false, true]);
    assert_eq!(
        (sensors.encoder_counts[2], failed.truth().currents_a[2]),
        (0, 0.0)
    );
}

#[test]
fn faults_of_supply_and_clock() {
    let volts = |sensors: Sensors| f64::from(sensors.supply_code) / f64::from(CODE_MAX) * 36.0;
    let (sagged, sensors) = faulty(Fault::SupplySag, 40);
    assert!((volts(sensors) - sagged.truth().supply_v).abs() < 1e-3);
    assert!(volts(sensors) < 11.0);
    let celsius =
        |sensors: Sensors| f64::from(sensors.temperature_code) / f64::from(CODE_MAX) * 200.0 - 40.0;
    let (mut hot, sensors) = faulty(Fault::Overheating, 8000);
    assert!(
        (celsius(sensors) - 45.0).abs() < 0.01,
        "{}",
        celsius(sensors)
    );
    hot.set_fault(Fault::Overheating, false);
    run(&mut hot, 16_000, &OFF);
    assert!((celsius(hot.sense()) - 25.0).abs() < 0.01);
    assert!(faulty(Fault::LateTicks, 1).1.late && !sound(1).late);
}

#[test]
fn the_emergency_stop_is_seen() {
    let mut plant = held();
    assert!(!plant.sense().emergency_stop);
    plant.press_emergency_stop(true);
    assert!(plant.sense().emergency_stop);
}

#[derive(Debug, PartialEq, Serialize, Deserialize)]
struct Line {
    fault: Fault,
}

#[test]
fn every_fault_has_its_words_and_its_name_in_files() {
    let mut words: Vec<String> = Fault::all().map(|fault| fault.to_string()).collect();
    assert_eq!(words.len(), 41);
    words.sort();
    words.dedup();
    assert_eq!(words.len(), 41);
    for fault in Fault::all() {
        let text = toml::to_string(&Line { fault }).unwrap();
        assert_eq!(
            toml::from_str::<Line>(&text).unwrap(),
            Line { fault },
            "{text}"
        );
    }
    let read = |text: &str| toml::from_str::<Line>(text).map(|line| line.fault);
    assert_eq!(
        read("fault = { tendon_cut = 1 }").unwrap(),
        Fault::TendonCut(0)
    );
    assert_eq!(read("fault = \"supply_sag\"").unwrap(), Fault::SupplySag);
    assert!(read("fault = { tendon_cut = 4 }").is_err());
    assert!(read("fault = { tendon_cut = 0 }").is_err());
}
