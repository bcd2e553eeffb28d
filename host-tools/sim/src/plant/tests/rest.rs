//! The leg comes to rest where the statics say.

use super::{HELD, OFF, PlantSettings, plant, ready_rigs, run};
use leg_model::{Load, Rig};
use leg_model_tools::nonlinear::{Balance, Posture};
use nalgebra::{SVector, Vector3};

const STRONGLY_DAMPED: PlantSettings = PlantSettings {
    joint_damping_nm_s_per_rad: 0.5,
    ..PlantSettings::DEFAULT
};

#[test]
fn a_held_leg_stays() {
    for (name, rig) in ready_rigs() {
        let mut plant = plant(&rig, &PlantSettings::default(), HELD);
        let before = plant.truth().tip_m;
        run(&mut plant, 800, &OFF);
        let moved = (plant.truth().tip_m - before).norm();
        assert!(moved < 1e-12, "{name}: {moved:e} m");
    }
}

#[test]
fn a_loaded_and_pushed_leg_rests_where_the_statics_say() {
    for (name, file) in ready_rigs() {
        let mut plant = plant(&file, &STRONGLY_DAMPED, HELD);
        let start = plant.truth();
        plant.push([3.0, -8.0, 2.0].into(), 0.05, 0.0);
        plant.set_payload(1.2, 0.1);
        run(&mut plant, 24_000, &OFF);
        let truth = plant.truth();
        let rig = Rig::new(&file.parameters).unwrap();
        let load = Load::new(&rig, 1.2).unwrap();
        let unstretched = SVector::from(truth.unstretched_m);
        let statics = Balance::new(rig, load, file.support, file.tendons, unstretched);
        let begin = Posture {
            direction: start.direction,
            torsion: start.torsion_rad,
        };
        let rest = statics.rest(begin).unwrap();
        let expected: Vector3<f64> = rest.direction.vector() * rig.tip_m();
        let off = (truth.tip_m - expected).norm();
        println!("{name}: {off:.1e} m");
        assert!(off < 1e-7, "{name}: {off:e} m");
        assert!((truth.torsion_rad - rest.torsion).abs() < 1e-6, "{name}");
    }
}
