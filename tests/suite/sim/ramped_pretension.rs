//! A pretension on its way: the damping of the tendons has them lag by what their stiffnesses of that moment ask for, and what their curves leave
//! out grows with it.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use super::station_stand::pass;
use crate::common::require_said;
use leg_bench::stand::Stand;
use leg_firmware::command::Command;
use leg_firmware::supervisor::{Fault, State};
use leg_rig::plant_settings::PlantSettings;
use leg_rig::rig_file::RigFile;
use leg_sim::plant::Start;

/// What forward kinematics leaves over at most in a time, s, in m.
fn largest_residual_m(stand: &mut Stand, time_s: f64) -> f32 {
    let end_s = stand.time_s() + time_s;
    let mut largest_m = 0.0_f32;
    while stand.time_s() < end_s {
        stand.tick().unwrap();
        stand.require_no_fault().unwrap();
        largest_m = largest_m.max(stand.telemetry.unwrap().residual_m);
    }
    largest_m
}

/// At rest, armed with the tension that it has.
fn armed(rig: &RigFile, plant: &PlantSettings, start: Start) -> Stand {
    let mut stand = Stand::new(rig, plant, start, 3).unwrap();
    stand
        .tick_until(1.0, "disarmed", |stand| stand.state() == State::Disarmed)
        .unwrap();
    stand.command(&Command::Arm).unwrap();
    stand.wait(1.0).unwrap();
    stand
}

/// From 70 to 25 N, and back before that is reached, at 120 N/s: a tendon of 25 N has 0.38 of the stiffness of one of 70 N, and lags 2.6 times as far.
/// With the stiffnesses of the pretension that it goes to, 0.02 mm are left over, and with what a calibration leaves the sensors disagree.
#[test]
fn the_lengths_agree_while_the_pretension_changes() {
    const WITHIN_M: f32 = 1.5e-5;
    let stiffness = |demand_nm_per_rad| Command::Stiffness {
        demand_nm_per_rad,
        towards: None,
    };
    for (name, [falls, rises]) in [
        ("table1", [25.0, 57.0].map(Command::Pretension)),
        ("notch_universal", [25.0, 57.0].map(Command::Pretension)),
        ("table1", [11.2, 70.8].map(stiffness)),
    ] {
        let file = RigFile::load(Some(name.as_ref())).unwrap();
        let start = Start::hanging(file.pretension_n);
        let tared = PlantSettings {
            cell_offset_n: [0.0; 3],
            ..file.plant
        };
        let mut stand = armed(&file, &tared, start);
        for (command, time_s) in [(falls, 0.36), (rises, 0.5)] {
            stand.command(&command).unwrap();
            let largest_m = largest_residual_m(&mut stand, time_s);
            println!("{name}, {command:?}: {largest_m} m");
            assert!(largest_m < WITHIN_M, "{name}, {command:?}: {largest_m} m");
        }
    }
}

/// What tendons stretch otherwise than by their curves is not told from a load cell that is off where it is much: a leg that was not measured
/// after homing is held then.
#[test]
fn tendons_that_were_not_measured_may_be_off_by_little() {
    const WITHIN: f64 = 0.04;
    const BEYOND: f64 = 0.05;
    const LOW_N: f32 = 12.0;
    const HIGH_N: f32 = 94.0;
    for sign in [1.0, -1.0] {
        for (part, held) in [(WITHIN, false), (BEYOND, true)] {
            let mut rig = RigFile::load(None).unwrap();
            rig.pretension_n = LOW_N.into();
            rig.plant.curve_error = sign * part;
            let mut stand = armed(&rig, &rig.plant, Start::hanging(rig.pretension_n));
            stand.command(&Command::Pretension(HIGH_N)).unwrap();
            pass(&mut stand, 5.0);
            let found = stand.faults().has(Fault::Residual) && stand.state() == State::Held;
            assert_eq!(found, held, "{part} {sign}: {:?}", stand.faults());
        }
    }
    let percent = |part: f64| 100.0 * part;
    require_said(
        "firmware/SAFETY.md",
        &[
            format!("otherwise than by their curves by {} %", percent(WITHIN)),
            format!("by {} % is held", percent(BEYOND)),
            format!("from {LOW_N} to {HIGH_N} N"),
        ],
    );
}
