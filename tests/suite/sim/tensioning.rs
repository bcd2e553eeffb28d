//! What a leg finds as it is tensioned after homing: tendons of another make, and sensors or a hand that show a load which it cannot have.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use super::station_stand::pass;
use crate::common::require_said;
use leg_base::angles;
use leg_bench::stand::{Stand, move_to};
use leg_firmware::command::{Command, Compensation};
use leg_firmware::supervisor::{Fault, State};
use leg_rig::plant_settings::PlantSettings;
use leg_rig::ready_rigs::READY_RIGS;
use leg_rig::rig_file::RigFile;
use leg_sim::plant::Start;
use leg_sim::shadow::OTHER_TICKS_MAX;
use nalgebra::Vector3;

/// How slack the tendons are before homing, mm.
const SLACK_MM: f64 = 2.0;

/// Longest homing, and time in which the leg is tensioned and its tendons are measured, s.
const HOMING_S: f64 = 30.0;
const TENSIONED_S: f64 = 4.0;

/// How far the tip moves until a load cell that shows half to twice its tension is found, mm.
const MOVED_MM: f64 = 4.0;

fn rigs() -> impl Iterator<Item = (&'static str, RigFile)> {
    READY_RIGS
        .iter()
        .map(|rig| (rig.name, RigFile::load(Some(rig.name.as_ref())).unwrap()))
}

/// A leg that is homed by now, and not tensioned yet.
fn homed(rig: &RigFile, plant: PlantSettings) -> Stand {
    let start = Start::Slack { slack_mm: SLACK_MM };
    let mut stand = Stand::new(rig, &plant, start, 1).unwrap();
    stand.wait(0.2).unwrap();
    home(&mut stand);
    stand
}

fn home(stand: &mut Stand) {
    stand.command(&Command::Home).unwrap();
    stand.wait(0.1).unwrap();
    stand
        .tick_until(HOMING_S, "active", |stand| stand.state() == State::Active)
        .unwrap();
}

/// Lets a time pass in which a fault may come: how far the tip moves until then, mm, and whether it came.
fn moved_until_fault(stand: &mut Stand, time_s: f64) -> (f64, bool) {
    let (begun_s, from_m) = (stand.time_s(), stand.truth.tip_m);
    let mut moved_mm = 0.0_f64;
    while stand.time_s() < begun_s + time_s {
        stand.tick().unwrap();
        moved_mm = moved_mm.max(1e3 * (stand.truth.tip_m - from_m).norm());
        if stand.faults().stopping().any() {
            return (moved_mm, true);
        }
    }
    (moved_mm, false)
}

fn elongation_factor(stand: &Stand) -> f64 {
    stand.telemetry.unwrap().elongation_factor.into()
}

/// A leg that showed a load is not cleared, and once it was paid out it has no zero: it is cleared then, and homes.
fn require_homing(stand: &mut Stand) {
    stand.command(&Command::Clear).unwrap();
    pass(stand, 0.2);
    assert_eq!(stand.state(), State::Held);
    stand.command(&Command::Disarm).unwrap();
    pass(stand, 6.0);
    assert_eq!(stand.state(), State::Disarmed);
    assert!(!stand.telemetry.unwrap().homed);
    stand.command(&Command::Clear).unwrap();
    pass(stand, 0.1);
    assert!(!stand.faults().any(), "{:?}", stand.faults());
    stand.command(&Command::Home).unwrap();
    pass(stand, 0.1);
    assert_eq!(stand.state(), State::Homing);
}

#[test]
fn tendons_of_another_make_are_measured_to_half_a_percent() {
    for (name, rig) in rigs() {
        for curve_error in [0.39, 0.2, 0.05, -0.05, -0.2, -0.29] {
            let mut stand = homed(
                &rig,
                PlantSettings {
                    curve_error,
                    ..rig.plant
                },
            );
            assert_eq!(elongation_factor(&stand), 1.0);
            stand.wait(TENSIONED_S).unwrap();
            let off = elongation_factor(&stand) / (1.0 + curve_error) - 1.0;
            println!("{name}, {curve_error}: {off:.4} off");
            assert!(off.abs() < 0.005, "{name}, {curve_error}: {off}");
            stand.command(&move_to([70.0, 0.8 * rig.tilt_deg])).unwrap();
            stand.wait(3.0).unwrap();
            assert_eq!(stand.state(), State::Active, "{:?}", stand.faults());
            stand.require_shadow(OTHER_TICKS_MAX).unwrap();
        }
    }
}

/// Nothing tells three cells that are off alike from other tendons: the page of single faults says so.
#[test]
fn cells_that_are_off_alike_are_taken_for_tendons() {
    let rig = RigFile::load(None).unwrap();
    let plant = PlantSettings {
        cell_gain_error: [-0.2; 3],
        ..rig.plant
    };
    let mut stand = homed(&rig, plant);
    stand.wait(TENSIONED_S).unwrap();
    assert_eq!(stand.state(), State::Active, "{:?}", stand.faults());
    assert!(elongation_factor(&stand) > 1.05);
    let highest_n = stand.truth.tensions_n.into_iter().fold(0.0, f64::max);
    assert!(
        (highest_n * 0.8 / rig.pretension_n - 1.0).abs() < 0.02,
        "{highest_n} N"
    );
}

/// A payload that hangs on the leg as it homes pulls as the leg does, and is taken for tendons that stretch more.
#[test]
fn a_payload_at_homing_is_taken_for_softer_tendons() {
    for (name, rig) in rigs() {
        let start = Start::Slack { slack_mm: SLACK_MM };
        let mut stand = Stand::new(&rig, &rig.plant, start, 1).unwrap();
        stand.plant().set_payload(2.0, 0.0);
        stand.wait(0.2).unwrap();
        home(&mut stand);
        stand.wait(TENSIONED_S).unwrap();
        let factor = elongation_factor(&stand);
        println!("{name}: {factor:.4}");
        assert!((1.02..1.1).contains(&factor), "{name}: {factor}");
        assert_eq!(stand.state(), State::Active, "{name}: {:?}", stand.faults());
    }
}

/// What was measured stays over a disarm and the next homing.
#[test]
fn what_was_measured_stays_until_other_settings_come() {
    let rig = RigFile::load(None).unwrap();
    let mut stand = homed(
        &rig,
        PlantSettings {
            curve_error: 0.2,
            ..rig.plant
        },
    );
    stand.wait(TENSIONED_S).unwrap();
    let measured = elongation_factor(&stand);
    assert!((measured - 1.2).abs() < 0.006, "{measured}");
    stand.command(&Command::Disarm).unwrap();
    stand
        .tick_until(10.0, "disarmed", |stand| stand.state() == State::Disarmed)
        .unwrap();
    home(&mut stand);
    stand.wait(TENSIONED_S).unwrap();
    assert_eq!(elongation_factor(&stand), measured);
    assert_eq!(stand.state(), State::Active, "{:?}", stand.faults());
}

/// One load cell that shows a third more or less than its tension has the leg feel a load that it cannot have straight down.
#[test]
fn a_load_cell_that_is_off_is_found_as_the_leg_is_tensioned() {
    for (name, rig) in rigs() {
        for tendon in 0..3 {
            for gain_error in [-0.5, -0.33, 0.33, 0.5, 1.0] {
                let mut plant = rig.plant;
                plant.cell_gain_error[tendon] = gain_error;
                let mut stand = homed(&rig, plant);
                let (moved_mm, found) = moved_until_fault(&mut stand, TENSIONED_S);
                let what = format!("{name}, cell {}, {gain_error}", tendon + 1);
                println!("{what}: {moved_mm:.2} mm");
                assert!(found && moved_mm < MOVED_MM, "{what}: {moved_mm} mm");
                assert!(
                    stand.faults().has(Fault::Residual),
                    "{what}: {:?}",
                    stand.faults()
                );
                assert_eq!(elongation_factor(&stand), 1.0, "{what}");
                pass(&mut stand, 0.5);
                assert_eq!(stand.state(), State::Held, "{what}");
                require_homing(&mut stand);
            }
        }
    }
}

/// A force at the tip of the paper's leg, N, that is found as it is tensioned.
const PAPER_N: f64 = 1.5;

/// A hand at the tip of a leg with other tendons, between two axes: 3 N, and 1.5 N on the paper's rig, are found half a second after it has its pretension, and taken
/// for no length; with 0.2 N they are measured. With 1 N a leg with its own tendons is not held.
#[test]
fn a_leg_that_does_not_hang_free_is_held_as_it_is_tensioned() {
    let words = format!("0.3 N·m on the paper's rig or {PAPER_N} N at its tip");
    require_said("firmware/SAFETY.md", &[words]);
    for (name, rig) in rigs() {
        for (force_n, curve_error, held) in [
            (
                if name == READY_RIGS[0].name {
                    PAPER_N
                } else {
                    3.0
                },
                0.06,
                true,
            ),
            (1.0, 0.0, false),
            (0.2, 0.06, false),
        ] {
            let plant = PlantSettings {
                curve_error,
                ..rig.plant
            };
            let mut stand = homed(&rig, plant);
            let force = Vector3::new(1.0, 1.0, 0.0).normalize() * force_n;
            stand.plant().push(force, 2.0 * TENSIONED_S, 0.3);
            let near_n = rig.pretension_n - 0.5;
            stand
                .tick_until(TENSIONED_S, "at its pretension", |stand| {
                    f64::from(stand.telemetry.unwrap().pretension_n) >= near_n
                })
                .unwrap();
            let tensioned_s = stand.time_s();
            let (_, found) = moved_until_fault(&mut stand, TENSIONED_S);
            let what = format!("{name}, {force_n} N: {:?}", stand.faults());
            assert_eq!(found, held, "{what}");
            assert_eq!(stand.faults().has(Fault::Residual), held, "{what}");
            let measured = !held && curve_error != 0.0;
            assert_eq!(elongation_factor(&stand) != 1.0, measured, "{what}");
            let after_s = stand.time_s() - tensioned_s;
            assert!(
                !found || (0.4..0.7).contains(&after_s),
                "{what}: {after_s} s"
            );
        }
    }
}

/// A leg that is sent somewhere before its tendons were measured is not measured on the way.
#[test]
fn a_leg_that_is_sent_away_is_not_measured() {
    let rig = RigFile::load(None).unwrap();
    let plant = PlantSettings {
        curve_error: 0.04,
        ..rig.plant
    };
    let mut stand = homed(&rig, plant);
    stand.wait(0.8).unwrap();
    stand.command(&move_to([20.0, 10.0])).unwrap();
    stand.wait(TENSIONED_S).unwrap();
    assert_eq!(stand.state(), State::Active, "{:?}", stand.faults());
    assert_eq!(elongation_factor(&stand), 1.0);
}

/// Nor is one that was stopped before, and goes on after a clear or is armed again.
#[test]
fn a_leg_that_was_stopped_before_is_not_measured() {
    let rig = RigFile::load(None).unwrap();
    let plant = PlantSettings {
        curve_error: 0.04,
        ..rig.plant
    };
    for again in [Command::Clear, Command::Disarm] {
        let mut stand = homed(&rig, plant);
        stand.command(&Command::Stop).unwrap();
        pass(&mut stand, 0.5);
        assert_eq!(stand.state(), State::Held);
        stand.command(&again).unwrap();
        pass(&mut stand, 0.1);
        if again == Command::Disarm {
            stand.wait(6.0).unwrap();
            assert_eq!(stand.state(), State::Disarmed);
            stand.command(&Command::Arm).unwrap();
        }
        stand.wait(TENSIONED_S).unwrap();
        assert_eq!(stand.state(), State::Active, "{:?}", stand.faults());
        assert_eq!(elongation_factor(&stand), 1.0, "{again:?}");
    }
}

/// Nor is one whose load is not estimated.
#[test]
fn a_leg_that_does_not_estimate_its_load_is_not_measured() {
    let rig = RigFile::load(None).unwrap();
    let plant = PlantSettings {
        curve_error: 0.04,
        ..rig.plant
    };
    for compensation in [Compensation::Off, Compensation::Frozen] {
        let mut stand = homed(&rig, plant);
        stand.command(&Command::Compensation(compensation)).unwrap();
        stand.wait(TENSIONED_S).unwrap();
        assert_eq!(stand.state(), State::Active, "{:?}", stand.faults());
        assert_eq!(elongation_factor(&stand), 1.0, "{compensation:?}");
    }
}

/// How far a leg rests off a target at the farthest tilt that it was sent to after homing, mm, with so many kilograms.
fn target_error_mm(rig: &RigFile, plant: PlantSettings, azimuth_deg: f64, payload_kg: f64) -> f64 {
    let mut stand = homed(rig, plant);
    stand.wait(TENSIONED_S).unwrap();
    assert_eq!(elongation_factor(&stand), 1.0);
    stand.plant().set_payload(payload_kg, 0.4);
    stand.wait(1.0).unwrap();
    let pose_deg = [azimuth_deg, 29.9];
    stand.command(&move_to(pose_deg)).unwrap();
    stand.wait(4.0).unwrap();
    assert_eq!(stand.state(), State::Active, "{:?}", stand.faults());
    let [x, y] = angles::direction(pose_deg[0], pose_deg[1]);
    let length_m = rig.parameters.joint_length_m + rig.parameters.leg_length_m;
    let tip_m = stand.truth.tip_m;
    1e3 * (tip_m.x - x * length_m).hypot(tip_m.y - y * length_m)
}

/// Asserts that the farthest of these is near a bar, mm, and none beyond it.
fn require_nearly(bar_mm: f64, off_mm: &[f64]) {
    let farthest_mm = off_mm.iter().copied().fold(0.0, f64::max);
    println!("{off_mm:.2?} mm");
    assert!(
        (0.5 * bar_mm..bar_mm).contains(&farthest_mm),
        "{off_mm:?} mm"
    );
}

/// Tendons that are off by less than is measured: the leg rests off its target by what the pages say.
#[test]
fn tendons_that_are_off_by_less_than_is_measured_move_where_the_leg_rests() {
    const REST_MM: f64 = 1.0;
    require_said(
        "host-tools/docs/fmea.md",
        &[format!(
            "3 % moves where the leg rests by up to {REST_MM} mm"
        )],
    );
    let rig = RigFile::load(None).unwrap();
    let mut off_mm = Vec::new();
    for curve_error in [-0.027, 0.027] {
        for payload_kg in [0.0, 1.0, 2.0] {
            let plant = PlantSettings {
                curve_error,
                ..rig.plant
            };
            off_mm.push(target_error_mm(&rig, plant, 70.0, payload_kg));
        }
    }
    require_nearly(REST_MM, &off_mm);
}

/// So does a load cell that is off by less than is found as the leg is tensioned.
#[test]
fn a_load_cell_that_is_off_by_little_moves_where_the_leg_rests() {
    const OFF: f64 = 0.15;
    const REST_MM: f64 = 1.0;
    require_said(
        "host-tools/docs/fmea.md",
        &[format!(
            "by {:.0} %, with 1 kg at a tilt of 30°, by up to {REST_MM} mm",
            100.0 * OFF
        )],
    );
    let rig = RigFile::load(None).unwrap();
    let mut off_mm = Vec::new();
    for cell in 0..3 {
        for error in [-OFF, OFF] {
            let mut plant = rig.plant;
            plant.cell_gain_error[cell] = error;
            for azimuth_deg in [10.0, 70.0, 130.0, 190.0, 250.0, 310.0] {
                off_mm.push(target_error_mm(&rig, plant, azimuth_deg, 1.0));
            }
        }
    }
    require_nearly(REST_MM, &off_mm);
}
