//! An encoder that jumps: whatever it reads, no motor is driven with more than its supply.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use leg_firmware::command::Command;
use leg_firmware::control::CYCLE_TICKS;
use leg_firmware::leg::Leg;
use leg_firmware::sensors::Sensors;
use leg_firmware::supervisor::State;
use leg_rig::rig_file::RigFile;
use leg_sim::link::InProcess;
use leg_sim::scenario::Scenario;
use leg_sim::simulation::Simulation;
use std::path::Path;

/// A leg that follows commands, and what its sensors then read.
fn active_leg() -> (Leg<f32>, Sensors) {
    let text = "title = \"still\"\nseed = 1\nsteps = [{ wait_s = 0.01 }]\n\n[start.held]\nazimuth_deg = 0\ntilt_deg = 10\npretension_n = 70\npayload_kg = 0\n";
    let rig = RigFile::load(Some(Path::new("table1"))).unwrap();
    let scenario = Scenario::parse("still", text).unwrap();
    let simulation = Simulation::new(&scenario, &rig).unwrap();
    let mut leg = Leg::new(simulation.settings()).unwrap();
    let mut sensors = Vec::new();
    let watch = &mut |tick: &leg_sim::simulation::Tick<'_>| sensors.push(*tick.sensors);
    simulation.run(&mut InProcess::new(), watch).unwrap();
    for sensors in &sensors {
        leg.tick(sensors);
    }
    assert!(leg.command(1, Command::Arm));
    let last = *sensors.last().unwrap();
    for _ in 0..CYCLE_TICKS {
        leg.tick(&last);
    }
    assert_eq!(leg.telemetry().state, State::Active);
    (leg, last)
}

#[test]
fn a_jump_of_any_size_asks_for_no_more_than_the_supply() {
    for axis in 0..3 {
        for jump in (0..=u16::MAX).step_by(257) {
            let (mut leg, mut sensors) = active_leg();
            for _ in 0..8 {
                sensors.encoder_counts[axis] = sensors.encoder_counts[axis].wrapping_add(jump);
                let duty = leg.tick(&sensors).duty;
                let sound = duty.iter().all(|duty| duty.abs() <= 1.0);
                assert!(sound, "axis {axis}, {jump} counts: {duty:?}");
            }
        }
    }
}
