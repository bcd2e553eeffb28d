//! Without taut tendons the leg is a pendulum.

use super::{OFF, PlantSettings, Start, plant, ready, run};
use crate::plant::Plant;
use std::f64::consts::TAU;

const SLACK: Start = Start::Slack { slack_mm: 10.0 };

/// Times at which the tip passes the vertical, s, by straight lines between ticks.
fn passes(plant: &mut Plant, ticks: u32) -> Vec<f64> {
    let mut passes = Vec::new();
    let mut before = plant.truth();
    for _ in 0..ticks {
        plant.step(&OFF);
        let now = plant.truth();
        if before.tip_m.x < 0.0 && now.tip_m.x >= 0.0 {
            let part = before.tip_m.x / (before.tip_m.x - now.tip_m.x);
            passes.push(before.time_s + part * (now.time_s - before.time_s));
        }
        before = now;
    }
    passes
}

/// T = 2π√(I/(mgc)): with a slender leg I = 4mc²/3, and a payload M at L adds ML² to I and ML to mc.
#[test]
fn a_slack_leg_swings_as_a_pendulum() {
    for (name, payload_kg) in [("table1", 0.0), ("universal", 1.0), ("spherical", 2.0)] {
        let rig = ready(name);
        let p = rig.parameters;
        let tip = p.joint_length_m + p.leg_length_m;
        let mut plant = plant(&rig, &PlantSettings::default().undamped(), SLACK);
        plant.set_payload(payload_kg, 0.0);
        run(&mut plant, 1, &OFF);
        plant.push([0.05, 0.0, 0.0].into(), 0.05, 0.0);
        let passes = passes(&mut plant, 40_000);
        let periods = (passes.len() - 1) as f64;
        let period = (passes[passes.len() - 1] - passes[0]) / periods;
        let inertia = p.leg_mass_kg * p.leg_centroid_m.powi(2) * 4.0 / 3.0;
        let moment = p.leg_mass_kg * p.leg_centroid_m + payload_kg * tip;
        let all = inertia + payload_kg * tip * tip;
        let expected = TAU * (all / (moment * p.gravity_m_per_s2)).sqrt();
        let off = period / expected - 1.0;
        println!("{name}: {period:.6} s, off by {off:.1e}");
        assert!(off.abs() < 1e-5, "{name}: {period} s, not {expected} s");
    }
}

/// The stop takes the energy of an impact, and the balance has it.
#[test]
fn a_strong_push_ends_at_the_stop() {
    for name in ["table1", "universal", "spherical"] {
        let loose = Start::Slack { slack_mm: 100.0 };
        let mut plant = plant(&ready(name), &PlantSettings::default(), loose);
        let before = plant.energy_j();
        plant.push([150.0, 60.0, 0.0].into(), 0.2, 0.0);
        run(&mut plant, 1600, &OFF);
        let truth = plant.truth();
        assert!((truth.direction.vector().z + 75_f64.to_radians().cos()).abs() < 1e-3);
        let gap = plant.energy_gap_j(before);
        println!("{name}: {gap:.1e} J of {:.1} J", plant.work.push_j);
        assert!(plant.work.stop_j > 0.0 && gap.abs() < 1e-2 * plant.work.push_j);
    }
}
