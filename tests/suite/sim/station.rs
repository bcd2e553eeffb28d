//! A leg that keeps station: it compensates its load slowly, without a host.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use super::station_stand::{BACK_MM, Excursion, armed, faults, keeping, paper, pass, ticks};
use crate::common::require_said;
use leg_bench::stand::Stand;
use leg_firmware::command::{Command, Compensation};
use leg_firmware::supervisor::{Fault, FaultSet, State};
use leg_sim::plant::Start;

/// The fastest that it corrects, mm/s at the tip.
pub const FASTEST_MM_PER_S: f64 = 2.1;

/// Mean of the sums of the duties, and the part of the ticks in which a motor is driven.
fn driven(bench: &mut Stand, time_s: f64) -> [f64; 2] {
    let (mut sum, mut driven) = (0.0, 0.0);
    for _ in 0..ticks(time_s) {
        bench.tick().unwrap();
        let duty: f32 = bench.motors.duty.iter().map(|duty| duty.abs()).sum();
        sum += f64::from(duty);
        driven += f64::from(u8::from(duty > 0.0));
    }
    [sum, driven].map(|sum| sum / ticks(time_s) as f64)
}

/// Two kilograms are hung on the leg and taken off again: it comes back within 3 s where it sags by up to 4.5 mm, and goes no faster than
/// it may. At the edge of the workspace it sags farther, and takes as much longer.
#[test]
fn a_payload_is_compensated_slowly_and_without_a_host() {
    const OVER_S: f64 = 0.2;
    const WITHIN_S: f64 = 3.0;
    const EDGE_S: f64 = 6.0;
    const DRIVEN_PART: f64 = 0.6;
    const DUTY: f64 = 0.02;
    require_said(
        "firmware/SAFETY.md",
        &[
            format!(
                "back to {BACK_MM} mm within {} s up to a tilt of 20°, within {} s at 30°",
                WITHIN_S + OVER_S,
                EDGE_S + OVER_S
            ),
            format!("corrects at up to {FASTEST_MM_PER_S} mm/s at the tip"),
            format!(
                "driven in less than {} % of the ticks, at a mean duty below {} %",
                100.0 * DRIVEN_PART,
                100.0 * DUTY
            ),
        ],
    );
    for (seed, pose_deg, sag_mm, within_s) in [
        (11, [0.0, 5.0], [0.5, 1.1], 1.0),
        (12, [0.0, 15.0], [2.0, 3.0], 2.0),
        (13, [60.0, 20.0], [3.5, 5.8], WITHIN_S),
        (14, [200.0, 20.0], [3.5, 5.4], WITHIN_S),
        (15, [30.0, 30.0], [5.0, 8.7], EDGE_S),
    ] {
        let mut bench = keeping(&paper(), pose_deg, 0.0, seed);
        let home_m = bench.truth.tip_m;
        for payload_kg in [2.0, 0.0] {
            bench.plant().set_payload(payload_kg, OVER_S);
            let found = Excursion::new(&mut bench, home_m, within_s + 1.0);
            let what = format!("seed {seed}, {pose_deg:?}, {payload_kg} kg: {found:?}");
            println!("{what}");
            assert_eq!(bench.state(), State::KeepingStation, "{what}");
            assert_eq!(faults(&bench), FaultSet::NONE, "{what}");
            assert!(
                found.largest_mm > sag_mm[0] && found.largest_mm < sag_mm[1],
                "{what}"
            );
            assert!(found.back_s <= within_s + OVER_S, "{what}");
            assert!(found.mm_per_s < FASTEST_MM_PER_S, "{what}");
            let estimated_kg = f64::from(bench.telemetry.unwrap().payload_kg);
            assert!(
                (estimated_kg - payload_kg).abs() < 0.25,
                "{what}: {estimated_kg} kg"
            );
            // Between corrections the motors rest on their screws.
            let [duty, part] = driven(&mut bench, 2.0);
            println!("{what}: driven in {part} of the ticks, at a duty of {duty}");
            assert!(duty < DUTY && part < DRIVEN_PART, "{what}: {duty}, {part}");
        }
    }
}

/// Any command that ends it, and what does not.
#[test]
fn every_command_does_what_is_said_from_station() {
    let sound = keeping(&paper(), [60.0, 15.0], 1.0, 41);
    for (command, state) in [
        (Command::Stop, State::Held),
        (Command::KeepStation, State::KeepingStation),
        (Command::Clear, State::KeepingStation),
        (Command::KeepAlive, State::KeepingStation),
        (Command::Hold, State::KeepingStation),
        (Command::Home, State::KeepingStation),
        (Command::Move { x: 0.1, y: 0.0 }, State::KeepingStation),
        (Command::Pretension(140.0), State::KeepingStation),
        (Command::Pretension(f32::NAN), State::KeepingStation),
        (
            Command::Stiffness {
                demand_nm_per_rad: 120.0,
                towards: None,
            },
            State::KeepingStation,
        ),
        (
            Command::Compensation(Compensation::Off),
            State::KeepingStation,
        ),
        (Command::Arm, State::Active),
        // It is led straight down first.
        (Command::Disarm, State::Active),
    ] {
        let mut bench = sound.clone();
        bench.command(&command).unwrap();
        pass(&mut bench, 0.1);
        assert_eq!(bench.state(), state, "{command:?}");
        assert_eq!(faults(&bench), FaultSet::NONE, "{command:?}");
    }
    // What a leg that keeps station does is not changed by a command: the load is still compensated.
    let mut bench = sound.clone();
    bench
        .command(&Command::Compensation(Compensation::Off))
        .unwrap();
    bench.command(&Command::Pretension(140.0)).unwrap();
    let before_m = bench.truth.tip_m;
    pass(&mut bench, 2.0);
    assert!((bench.truth.tip_m - before_m).norm() < 5e-5);
    let mut bench = sound.clone();
    bench.command(&Command::Disarm).unwrap();
    pass(&mut bench, 5.0);
    assert_eq!(bench.state(), State::Disarmed);
    // A host that lets it follow commands again and dies leaves it in hold.
    let mut bench = sound;
    bench.command(&Command::Arm).unwrap();
    bench.command(&Command::Move { x: 0.1, y: 0.0 }).unwrap();
    pass(&mut bench, 0.5);
    assert_eq!(bench.state(), State::Held);
    assert_eq!(faults(&bench), FaultSet::single(Fault::CommandTimeout));
}

/// Where the leg cannot be left to itself it is held, as it was always.
#[test]
fn a_leg_that_may_not_keep_station_is_held() {
    let keep = |bench: &mut Stand| {
        bench.command(&Command::KeepStation).unwrap();
        pass(bench, 0.5);
        assert_eq!(bench.state(), State::Held);
        assert_eq!(faults(bench), FaultSet::NONE);
    };
    let mut off = paper();
    off.keeps_station = false;
    keep(&mut armed(&off, [0.0, 10.0], 0.5, 51));
    let sound = armed(&paper(), [0.0, 10.0], 0.5, 52);
    for compensation in [Compensation::Off, Compensation::Frozen] {
        let mut bench = sound.clone();
        bench.command(&Command::Compensation(compensation)).unwrap();
        pass(&mut bench, 0.1);
        keep(&mut bench);
    }
    let mut moving = sound;
    moving.command(&Command::Move { x: 0.0, y: 0.1 }).unwrap();
    pass(&mut moving, 0.1);
    keep(&mut moving);
    // Armed just now, its sensors are not watched yet.
    let start = Start::Held {
        azimuth_deg: 0.0,
        tilt_deg: 10.0,
        pretension_n: paper().pretension_n,
        payload_kg: 0.5,
    };
    let mut young = Stand::new(&paper(), &paper().plant, start, 54).unwrap();
    young.wait(0.1).unwrap();
    young.command(&Command::Arm).unwrap();
    young
        .tick_until(0.1, "active", |stand| stand.state() == State::Active)
        .unwrap();
    keep(&mut young);
}

/// Three kilograms are hung on a leg that leans far: no tensions hold them there.
#[test]
fn a_station_with_a_load_that_no_tensions_hold_is_held() {
    let mut bench = keeping(&paper(), [40.0, 28.0], 0.5, 53);
    bench.plant().set_payload(3.0, 1.0);
    pass(&mut bench, 4.0);
    assert_eq!(bench.state(), State::Held);
    assert!(
        faults(&bench).has(Fault::Infeasible),
        "{:?}",
        faults(&bench)
    );
}

/// A payload grows until no tensions within the bounds hold it: up to then the leg is asked for nothing nearer to the maximum than 4 N.
#[test]
fn a_station_takes_no_tension_within_four_newtons_of_the_maximum() {
    const NEWTONS: f32 = 4.0;
    let rig = paper();
    let mut bench = keeping(&rig, [40.0, 28.0], 0.5, 55);
    bench.plant().set_payload(3.5, 20.0);
    let mut highest_n = 0.0_f32;
    for _ in 0..ticks(22.0) {
        bench.tick().unwrap();
        if bench.state() != State::KeepingStation {
            break;
        }
        let asked_n = bench.telemetry.unwrap().target_tensions_n;
        highest_n = asked_n.into_iter().fold(highest_n, f32::max);
    }
    assert_eq!(bench.state(), State::Held);
    let below_n = rig.f_max_n as f32 - highest_n;
    assert!(
        (NEWTONS - 0.1..NEWTONS + 0.5).contains(&below_n),
        "{below_n} N"
    );
    require_said(
        "firmware/SAFETY.md",
        &[format!("{NEWTONS} N below the maximum tension")],
    );
}

/// A hand pushes for a minute: the leg comes back under it, and comes back when it is gone.
#[test]
fn a_push_for_a_minute_is_compensated() {
    let mut bench = keeping(&paper(), [30.0, 10.0], 0.5, 61);
    let home_m = bench.truth.tip_m;
    let plant = bench.plant();
    plant.push(plant.transverse(100.0) * 6.0, 60.0, 0.3);
    for largest_mm in [4.0, 7.3] {
        let found = Excursion::new(&mut bench, home_m, 60.0);
        assert!(
            found.largest_mm < largest_mm && found.end_mm < 0.1,
            "{found:?}"
        );
        assert!(found.mm_per_s < FASTEST_MM_PER_S, "{found:?}");
        assert_eq!(bench.state(), State::KeepingStation);
    }
}

/// A host that takes the leg over in the middle of a correction: the rest of the way is gone no faster. It was 30 mm/s.
#[test]
fn what_is_left_of_a_correction_is_gone_as_slowly_when_the_leg_is_taken_over() {
    let mut bench = keeping(&paper(), [60.0, 20.0], 0.0, 71);
    let home_m = bench.truth.tip_m;
    bench.plant().set_payload(2.0, 0.2);
    pass(&mut bench, 0.8);
    assert!((bench.truth.tip_m - home_m).norm() > 2e-3);
    bench.command(&Command::Arm).unwrap();
    let mut before_m = bench.telemetry.unwrap().reference_m;
    for cycle in 0..600 {
        pass(&mut bench, 0.005);
        let reference_m = bench.telemetry.unwrap().reference_m;
        if cycle == 0 {
            assert_eq!(bench.state(), State::Active);
            assert!(bench.moving(), "it is not said to be there");
        }
        for (now, before) in reference_m.iter().zip(before_m) {
            let mm_per_s = f64::from(now - before).abs() * 1e3 / 0.005;
            assert!(mm_per_s < 1.0, "{mm_per_s} mm/s in cycle {cycle}");
        }
        before_m = reference_m;
        bench.command(&Command::KeepAlive).unwrap();
    }
    assert!(!bench.moving());
    assert!((bench.truth.tip_m - home_m).norm() < 1e-4);
}
