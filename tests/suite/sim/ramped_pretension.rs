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

/// From 70 to 25 N, and back before that is reached, at 120 N/s: a tendon of 25 N is half as stiff as one of 70 N, and lags twice as far. With
/// the stiffnesses of the pretension that it goes to, 0.02 mm are left over, and with what a calibration leaves the sensors disagree.
#[test]
fn the_lengths_agree_while_the_pretension_changes() {
    const WITHIN_M: f32 = 1.5e-5;
    for name in ["table1", "notch_universal"] {
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
        stand.command(&Command::Pretension(25.0)).unwrap();
        let falling_m = largest_residual_m(&mut stand, 0.36);
        stand.command(&Command::Pretension(57.0)).unwrap();
        let rising_m = largest_residual_m(&mut stand, 0.5);
        assert!(falling_m < WITHIN_M, "{name}: {falling_m} m");
        assert!(rising_m < WITHIN_M, "{name}: {rising_m} m");
    }
}
