//! A pretension on its way: the damping of the tendons has them lag by what their stiffnesses of that moment ask for.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use leg_bench::stand::Stand;
use leg_firmware::command::Command;
use leg_firmware::supervisor::State;
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
        let mut stand = Stand::new(&file, &tared, start, 3).unwrap();
        stand
            .tick_until(1.0, "disarmed", |stand| stand.state() == State::Disarmed)
            .unwrap();
        stand.command(&Command::Arm).unwrap();
        stand.wait(1.0).unwrap();
        for (command, time_s) in [(falls, 0.36), (rises, 0.5)] {
            stand.command(&command).unwrap();
            let largest_m = largest_residual_m(&mut stand, time_s);
            println!("{name}, {command:?}: {largest_m} m");
            assert!(largest_m < WITHIN_M, "{name}, {command:?}: {largest_m} m");
        }
    }
}
