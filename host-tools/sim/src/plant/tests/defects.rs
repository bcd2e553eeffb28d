//! Each defect does what its name says.

mod cells;

use super::{HELD, OFF, PlantSettings, driven, plant, ready, run};
use crate::action::Action;
use crate::plant::{Defect, Plant};
use leg_firmware::drive::Drive;
use leg_firmware::sensors::{CODE_MAX, Sensors};

/// Its current sensors show what flows.
fn held() -> Plant {
    let settings = PlantSettings {
        current_offset_a: [0.0; 3],
        ..PlantSettings::default()
    };
    plant(&ready("table1"), &settings, HELD)
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
fn a_new_tendon_has_no_tension_where_the_leg_is() {
    let mut plant = defective(Defect::TendonCut(1), 4000).0;
    let before = plant.truth();
    plant.set_defect(Defect::TendonCut(1), false);
    let after = plant.truth();
    assert!(after.tensions_n[1].abs() < 1e-6, "{:?}", after.tensions_n);
    assert_eq!(after.tip_m, before.tip_m);
    for other in [0, 2] {
        assert_eq!(after.tensions_n[other], before.tensions_n[other]);
    }
    // A tendon that is not cut stays as it is.
    plant.set_defect(Defect::TendonCut(0), false);
    assert_eq!(plant.truth().tensions_n, after.tensions_n);
    plant
        .truth()
        .unstretched_m
        .iter()
        .zip(before.unstretched_m)
        .enumerate()
        .for_each(|(i, (now, before))| {
            assert_eq!(*now != before, i == 1);
        });
}

#[test]
fn currents() {
    let shown_a = |plant: &mut Plant| {
        let part = f64::from(plant.sense().current_codes[1]) / f64::from(CODE_MAX);
        (2.0 * part - 1.0) * ready("table1").actuators[0].current_range_a
    };
    for (defect, driven_a, off_a) in [
        (None, None, 0.0),
        (Some(Defect::CurrentFullScale(1)), Some(12.0), 12.0),
        (Some(Defect::CurrentFullScaleDisabled(1)), None, 12.0),
        (Some(Defect::CurrentZero(1)), Some(0.0), 0.0),
        (Some(Defect::CurrentDead(1)), Some(-12.0), -12.0),
    ] {
        let mut plant = driven_leg(defect, 400).0;
        let (found, real) = (shown_a(&mut plant), plant.truth().currents_a[1]);
        let expected = driven_a.unwrap_or(real);
        assert!(
            real > 0.1 && (found - expected).abs() < 1e-3,
            "{defect:?}: {found} A"
        );
        run(&mut plant, 1, &OFF);
        let found = shown_a(&mut plant);
        assert!((found - off_a).abs() < 1e-3, "{defect:?}: {found} A");
    }
}

/// What a sensor that is off shows without a current it shows beside one, until it is dead.
#[test]
fn a_current_sensor_is_off_whatever_it_shows() {
    let offset_a = 0.3;
    let settings = PlantSettings {
        current_offset_a: [0.0, offset_a, 0.0],
        ..PlantSettings::default()
    };
    for (defect, off_a) in [
        (None, offset_a),
        (Some(Defect::CurrentZero(1)), offset_a),
        (Some(Defect::CurrentOffset(1)), offset_a + 10.0),
        (Some(Defect::CurrentDead(1)), -12.0),
    ] {
        let mut plant = plant(&ready("table1"), &settings, HELD);
        if let Some(defect) = defect {
            plant.set_defect(defect, true);
        }
        run(&mut plant, 1, &OFF);
        let codes = plant.sense().current_codes.map(f64::from);
        let shown_a = codes.map(|code| 24.0 * code / f64::from(CODE_MAX) - 12.0);
        assert!((shown_a[1] - off_a).abs() < 1e-3, "{defect:?}: {shown_a:?}");
        assert!(
            shown_a[0].abs() < 1e-3 && shown_a[2].abs() < 1e-3,
            "{shown_a:?}"
        );
    }
}

#[test]
fn an_open_half_bridge_drives_one_way_only() {
    for (defect, moves) in [
        (Defect::HalfBridgeOpen(0), [false, true]),
        (Defect::HalfBridgeOpenOutwards(0), [true, false]),
    ] {
        for (duty, moves) in [0.3, -0.3].into_iter().zip(moves) {
            let mut plant = held();
            plant.set_defect(defect, true);
            run(&mut plant, 400, &driven([duty; 3]));
            let truth = plant.truth();
            assert_eq!(
                truth.speeds_rad_per_s[0] != 0.0,
                moves,
                "{defect:?}, {duty}"
            );
            assert_eq!(truth.currents_a[0] != 0.0, moves, "{defect:?}, {duty}");
            assert!(truth.speeds_rad_per_s[1] != 0.0);
        }
    }
}

#[test]
fn lines_that_are_torn_drive_inwards() {
    for (defect, duty, enabled, inwards) in [
        (Defect::DriverFullOn(0), 0.0, true, true),
        (Defect::DriverFullOn(0), 0.0, false, false),
        (Defect::DirectionStuck(0), -0.3, true, true),
        (Defect::DirectionStuck(0), 0.0, true, false),
    ] {
        let mut plant = held();
        plant.set_defect(defect, true);
        let duty = [duty; 3];
        run(&mut plant, 40, &Drive { duty, enabled });
        let speed = plant.truth().speeds_rad_per_s[0];
        assert_eq!(speed > 0.0, inwards, "{defect:?}: {speed} rad/s");
    }
}

/// A plug, a screw, a gear and a tendon against sound ones.
#[test]
fn worn_parts() {
    let travel_m = |defect: Option<Defect>, duty: f32| {
        let mut plant = held();
        let before = plant.truth().unstretched_m[0];
        defect
            .iter()
            .for_each(|defect| plant.set_defect(*defect, true));
        run(&mut plant, 1600, &driven([duty, 0.0, 0.0]));
        before - plant.truth().unstretched_m[0]
    };
    for (defect, duty, part) in [
        (Defect::MotorIntermittent(0), 0.2, 0.2..0.8),
        (Defect::ScrewDry(0), 0.5, 0.3..0.8),
        (Defect::ScrewDry(0), 0.15, 0.0..0.1),
        // It pays out only after 0.16 mm of play.
        (Defect::GearPlay(0), -0.2, 0.5..0.95),
    ] {
        let found = travel_m(Some(defect), duty) / travel_m(None, duty);
        assert!(part.contains(&found), "{defect:?}: {found}");
    }
    let mut plant = held();
    let before = plant.truth().unstretched_m;
    plant.set_defect(Defect::TendonCreeps(1), true);
    run(&mut plant, 8000, &OFF);
    let after = plant.truth().unstretched_m;
    assert!((after[1] - before[1] - 1e-4).abs() < 1e-9);
    assert_eq!([after[0], after[2]], [before[0], before[2]]);
}

#[test]
fn a_hand_holds_the_tip() {
    let moved_mm = |grasped: bool| {
        let mut plant = held();
        let before = plant.truth().tip_m;
        plant.set_defect(Defect::LegGrasped, grasped);
        plant.push(plant.transverse(0.0) * 5.0, 10.0, 0.2);
        run(&mut plant, 8000, &OFF);
        1000.0 * (plant.truth().tip_m - before).norm()
    };
    let [free, held] = [false, true].map(moved_mm);
    assert!(free > 2.0 && held < 0.8, "{free} mm, {held} mm");
}

#[test]
fn a_tendon_slips_once() {
    let mut plant = held();
    let before = plant.truth().unstretched_m;
    for on in [true, true, false] {
        plant.set_defect(Defect::TendonSlips(2), on);
        let mut expected = before;
        expected[2] += 5e-3;
        assert_eq!(plant.truth().unstretched_m, expected);
        assert_eq!(plant.truth().tensions_n[2], 0.0);
    }
    assert_eq!(plant.unstretched_at_zero_m()[2], before[2] + 5e-3);
}

#[test]
fn a_jumping_encoder_counts_bursts() {
    let (mut plant, mut last, mut bursts) = (held(), 0_u16, [0; 2]);
    plant.set_defect(Defect::EncoderJumps(1), true);
    for _ in 0..80_000 {
        run(&mut plant, 1, &OFF);
        let counts = plant.sense().encoder_counts;
        assert_eq!([counts[0], counts[2]], [0; 2]);
        match counts[1].wrapping_sub(last) {
            0 => {}
            50 => bursts[0] += 1,
            down if down == 0_u16.wrapping_sub(50) => bursts[1] += 1,
            other => panic!("a burst of {other}"),
        }
        last = counts[1];
    }
    assert!(
        bursts.iter().all(|count| (75..125).contains(count)),
        "{bursts:?}"
    );
}

#[test]
fn the_supply_dips_once() {
    let mut plant = held();
    plant.set_defect(Defect::SupplyDip, true);
    let volts: Vec<f64> = (0..80)
        .map(|_| {
            run(&mut plant, 1, &OFF);
            plant.truth().supply_v
        })
        .collect();
    assert!(volts[..40].iter().all(|v| *v == 12.0), "{volts:?}");
    assert!(volts[40..].iter().all(|v| *v == 24.0), "{volts:?}");
}

#[test]
fn encoders() {
    let mut slipped = held();
    slipped.set_defect(Defect::EncoderSlipsQuarter(2), true);
    assert_eq!(slipped.sense().encoder_counts, [0, 0, 512]);
    let sound = sound(400).encoder_counts;
    let swapped = defective(Defect::EncodersSwapped, 400).1.encoder_counts;
    assert_eq!(swapped, [sound[1], sound[0], sound[2]]);
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
    let range_a = 2.0 * ready("table1").actuators[0].current_range_a;
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
    assert_eq!(names.len(), 3 * 43 + 11);
    assert_eq!(Defect::descriptions().count(), 43 + 11);
    for number in [0, 4] {
        let line = format!(r#"{{"fault":{{"tendon_cut":{number}}}}}"#);
        assert!(Action::parse(&line).is_err());
    }
}
