//! Motors, gears and screws.

use super::{HELD, OFF, PlantSettings, Start, driven, plant, ready, run};
use leg_rig::actuator::Actuator;
use leg_rig::rig_file::RigFile;

/// The pull inwards and outwards at a pretension: 150 N is the rig's maximum tension.
const HIGHEST: Start = Start::Held {
    azimuth_deg: 0.0,
    tilt_deg: 0.0,
    pretension_n: 150.0,
    payload_kg: 0.0,
};

#[test]
fn a_pull_does_not_turn_a_screw() {
    let mut plant = plant(&ready("table1"), &PlantSettings::default(), HIGHEST);
    let before = plant.truth().unstretched_m;
    run(&mut plant, 8000, &OFF);
    let truth = plant.truth();
    assert!(truth.tensions_n.iter().all(|tension| *tension > 149.0));
    assert_eq!(truth.unstretched_m, before);
    // Nor does it with the motor short-circuited.
    run(&mut plant, 800, &driven([0.0; 3]));
    assert_eq!(plant.truth().unstretched_m, before);
}

#[test]
fn a_reversed_motor_first_crosses_the_play() {
    let actuator = Actuator::default();
    let play_rad = actuator.backlash_rad * actuator.gear_ratio;
    let mut plant = plant(&ready("table1"), &PlantSettings::default(), HELD);
    run(&mut plant, 400, &driven([0.3, 0.0, 0.0]));
    run(&mut plant, 400, &OFF);
    let (turned, length) = (plant.motors[0].angle_rad, plant.truth().unstretched_m[0]);
    assert!(turned > 1.0);
    let mut crossed = 0;
    while plant.motors[0].angle_rad > turned - 2.0 * play_rad {
        plant.step(&driven([-0.1, 0.0, 0.0]));
        let back = turned - plant.motors[0].angle_rad;
        let paid_out_m = plant.truth().unstretched_m[0] - length;
        let expected = (back - play_rad).max(0.0) * actuator.m_per_rad();
        assert!(
            (paid_out_m - expected).abs() < 1e-15,
            "{paid_out_m:e} {expected:e}"
        );
        crossed += u32::from(paid_out_m == 0.0);
    }
    assert!(crossed > 0);
}

/// At a steady speed the motor's torque is that of friction and screw: F m/(η_s η_g) inwards, F m(1/η_s − 2)/η_g
/// outwards; and its speed that of V = Ri + kω.
#[test]
fn a_steady_motor_carries_its_pull() {
    let mut actuator = Actuator::default();
    // So slow a screw leaves the pull as it is.
    actuator.lead_m *= 1e-3;
    actuator.friction_nm = 0.0;
    actuator.viscous_nm_s_per_rad = 0.0;
    let settings = PlantSettings {
        supply_resistance_ohm: 0.0,
        ..PlantSettings::default()
    };
    for (duty, part) in [(0.5_f32, 1.0 / 0.3), (-0.5, 1.0 / 0.3 - 2.0)] {
        let rig = RigFile {
            actuators: [actuator; 3],
            ..ready("table1")
        };
        let mut plant = plant(&rig, &settings, HIGHEST);
        run(&mut plant, 1600, &driven([duty, 0.0, 0.0]));
        let truth = plant.truth();
        let torque = truth.tensions_n[0] * actuator.m_per_rad() * part / 0.9;
        let current = torque / actuator.torque_constant_nm_per_a * f64::from(duty.signum());
        let volts = f64::from(duty) * actuator.supply_v - actuator.resistance_ohm * current;
        let speed = volts / actuator.torque_constant_nm_per_a;
        assert!((truth.currents_a[0] - current).abs() < 1e-6, "{current} A");
        assert!(
            (truth.speeds_rad_per_s[0] / speed - 1.0).abs() < 1e-6,
            "{speed} rad/s"
        );
    }
}

#[test]
fn the_supply_sags_under_the_currents() {
    let mut plant = plant(&ready("table1"), &PlantSettings::default(), HELD);
    assert_eq!(plant.truth().supply_v, 24.0);
    run(&mut plant, 4, &driven([1.0; 3]));
    let truth = plant.truth();
    let drawn: f64 = truth.currents_a.iter().sum();
    assert!(drawn > 10.0, "{drawn} A");
    assert!((truth.supply_v - (24.0 - 0.2 * drawn)).abs() < 1e-12);
}
