//! An encoder that jumps: whatever it reads, no motor is driven with more than its supply.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use leg_firmware::command::{Command, CommandRefusal};
use leg_firmware::control::CYCLE_TICKS;
use leg_firmware::leg::Leg;
use leg_firmware::sensors::Sensors;
use leg_firmware::supervisor::{Fault, State};
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

/// What was counted is lost: the leg is switched off, and does not follow its zero again.
#[test]
fn a_jump_ends_the_zero() {
    let (mut leg, mut sensors) = active_leg();
    sensors.encoder_counts[1] = sensors.encoder_counts[1].wrapping_add(1000);
    let obeys = |leg: &mut Leg<f32>, command| {
        assert!(leg.command(2, command));
        let outcome = (0..CYCLE_TICKS).find_map(|_| {
            leg.tick(&sensors);
            leg.outcome()
        });
        outcome.unwrap().result
    };
    // Found in the first cycle; gone in the second.
    for _ in 0..2 * CYCLE_TICKS {
        leg.tick(&sensors);
    }
    let telemetry = leg.telemetry();
    assert_eq!(telemetry.state, State::Off);
    assert!(telemetry.faults.has(Fault::EncoderJump) && !telemetry.homed);
    while leg.outcome().is_some() {}
    assert_eq!(obeys(&mut leg, Command::Clear), Ok(()));
    assert_eq!(leg.telemetry().state, State::Disarmed);
    let refused = obeys(&mut leg, Command::Arm);
    assert_eq!(refused, Err(CommandRefusal::NotHomed));
}
