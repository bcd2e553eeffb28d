//! `leg tune` on simulated legs whose true values it is not told: what it measures is what they are.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use fastrand::Rng;
use leg_host::cancel_flag::CancelFlag;
use leg_host::operator::{HostIdentity, Operator};
use leg_host::transport::emulated::EmulatedLine;
use leg_host::tune::{
    JogPlan, Row, SwingPlan, Swings, comparison, measure_motor, measure_swing, section, supply_v,
    table,
};
use leg_rig::rig_file::RigFile;
use leg_sim::emulated_leg::EmulatedLeg;
use leg_sim::link::InProcess;

/// A leg that is not as configured: friction within a half of it, resistance and torque constant within a fifth, play from the half
/// to the double, tendons and inertia so that it swings at another frequency.
fn drawn(configured: &RigFile, seed: u64) -> RigFile {
    let mut rng = Rng::with_seed(seed);
    let mut even = |half: f64| 1.0 + half * (2.0 * rng.f64() - 1.0);
    let mut real = *configured;
    let actuator = &mut real.actuator;
    actuator.friction_nm *= even(0.5);
    actuator.resistance_ohm *= even(0.2);
    actuator.torque_constant_nm_per_a *= even(0.2);
    actuator.viscous_nm_s_per_rad *= even(0.5);
    actuator.screw_efficiency *= even(0.1);
    actuator.backlash_rad *= 1.25 + 0.75 * (even(1.0) - 1.0);
    real.plant.curve_error = 0.03 * (even(1.0) - 1.0);
    let inertia = configured
        .plant
        .transverse_inertia_kg_m2(&configured.parameters);
    real.plant.leg_transverse_inertia_kg_m2 = Some(inertia * even(0.2));
    real
}

/// A leg and its host.
fn leg(configured: &RigFile, real: &RigFile, seed: u64) -> (EmulatedLine, Operator) {
    let leg = EmulatedLeg::unlike(configured, real, Box::new(InProcess::new()), seed).unwrap();
    let line = EmulatedLine::new(leg, "the leg");
    let host = Box::new(line.connect());
    let operator = Operator::open(host, HostIdentity::FIXED, CancelFlag::default()).unwrap();
    (line, operator)
}

fn row<'a>(rows: &'a [Row], name: &str) -> &'a Row {
    rows.iter().find(|row| row.name == name).unwrap()
}

#[test]
fn the_constants_of_a_motor_are_found_within_five_percent() {
    let configured = RigFile::load(None).unwrap();
    for seed in 1..=4 {
        let real = drawn(&configured, seed);
        let (_, mut operator) = leg(&configured, &real, seed);
        let settings = operator.settings().unwrap();
        let motor = 1 + (seed % 3) as u8;
        let plan = JogPlan::new(
            motor,
            &settings,
            supply_v(&mut operator, &settings).unwrap(),
        );
        let began = std::time::Instant::now();
        let found = measure_motor(&mut operator, &plan, &settings, &mut |_| ()).unwrap();
        println!("{:?} {:?}", began.elapsed(), operator.now());
        let rows = comparison(&found.constants, None, &real);
        println!("{}", table(&rows));
        println!("{}", section(motor, &rows));
    }
}

#[test]
fn swing() {
    let configured = RigFile::load(None).unwrap();
    for seed in 1..=3 {
        let real = drawn(&configured, seed);
        let (_, mut operator) = leg(&configured, &real, seed);
        let plan = SwingPlan::new(&configured);
        let began = std::time::Instant::now();
        let swings: Swings = measure_swing(&mut operator, &plan, &configured, &mut |s| {
            println!("{:?} {:?}", s.ring, s.configured_hz)
        })
        .unwrap();
        println!("{:?} {:?}", began.elapsed(), operator.now());
        let k = |p: f64| (p, real.plant.curve_error);
        println!(
            "{:?} {:?} true {:?} {:?}",
            k(1.0),
            swings.inertia_kg_m2,
            real.plant.leg_transverse_inertia_kg_m2,
            swings.play_m
        );
        println!("true play {}", real.actuator.play_m());
    }
}
