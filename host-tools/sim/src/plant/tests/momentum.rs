//! The angular momentum about the axis round which nothing pulls stays. The energy does not show gyroscopic moments,
//! which do no work; this does.

use super::{OFF, PlantSettings, Start, plant, ready, run};
use crate::plant::Plant;
use leg_model::Direction;
use nalgebra::{Matrix3, Vector3};

/// I = I_t(1 − ppᵀ) + I_a ppᵀ times the rotation's rate, N·m·s.
fn momentum(plant: &Plant) -> Vector3<f64> {
    let (p, inertia) = (plant.leg.direction.vector(), plant.bare);
    let (across, along) = (inertia.transverse_kg_m2, inertia.axial_kg_m2);
    let inertia = (Matrix3::identity() - p * p.transpose()) * across + p * p.transpose() * along;
    inertia * plant.leg.rate
}

/// A thick leg without weight or tendons that tilts, goes round and spins (as far as the support lets it).
fn spinning(name: &str) -> Plant {
    let mut rig = ready(name);
    rig.parameters.gravity_m_per_s2 = 0.0;
    let settings = PlantSettings {
        leg_axial_inertia_kg_m2: 8e-3,
        ..PlantSettings::default().undamped()
    };
    let mut plant = plant(&rig, &settings, Start::Slack { slack_mm: 100.0 });
    let direction = Direction::from_angles(0.4, 0.5).unwrap();
    plant.leg.direction = direction;
    plant.leg.rate = if rig.support.twists() {
        Vector3::new(1.0, -2.0, 6.0)
    } else {
        rig.support.plane(&direction).rotation([3.0, -0.5])
    };
    plant
}

/// How much the part of the momentum along an axis changes in a fifth of a second, as a part of the whole.
fn change(name: &str, axis: impl Fn(&Plant) -> Vector3<f64>) -> f64 {
    let mut plant = spinning(name);
    let part = |plant: &Plant| momentum(plant).dot(&axis(plant));
    let (before, whole) = (part(&plant), momentum(&plant).norm());
    let from = plant.leg.direction.vector();
    run(&mut plant, 1600, &OFF);
    assert!((plant.leg.direction.vector() - from).norm() > 0.2);
    assert_eq!(plant.work.stop_j, 0.0);
    let change = (part(&plant) - before).abs() / whole;
    println!("{name}: {change:.1e}");
    change
}

#[test]
fn a_ball_joint_changes_no_momentum() {
    for axis in [Vector3::x(), Vector3::y(), Vector3::z()] {
        assert!(change("spherical", |_| axis) < 1e-8);
    }
}

#[test]
fn a_universal_joint_does_not_hold_its_first_axis() {
    assert!(change("universal", |_| Vector3::x()) < 1e-8);
}

/// A leg without torsion that goes round the vertical z turns by ψ with dψ = (z + p) dφ, p along the leg.
#[test]
fn a_leg_without_torsion_goes_round_freely() {
    let round = |plant: &Plant| Vector3::z() + plant.leg.direction.vector();
    assert!(change("table1", round) < 1e-8);
}
