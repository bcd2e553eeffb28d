//! The books of the energy close.

use super::{HELD, OFF, PlantSettings, driven, plant, ready_rigs, run};

/// Energy that does not add up after a push and a swing of 0.25 s, as a part of what the push brought.
fn gap(rig: &leg_rig::rig_file::RigFile, settings: &PlantSettings, duty: Option<[f32; 3]>) -> f64 {
    let mut plant = plant(rig, settings, HELD);
    let before = plant.energy().total_j();
    plant.push([20.0, -10.0, 5.0].into(), 0.02, 0.0);
    run(&mut plant, 2000, &duty.map_or(OFF, driven));
    let work = plant.work();
    let scale = work.push_j.abs() + work.sliders_j.abs();
    assert!(scale > 1e-3, "{scale} J");
    (plant.energy().total_j() - before - work.gained_j()) / scale
}

#[test]
fn after_a_push_no_energy_comes_or_goes() {
    let damped = PlantSettings::default();
    for (name, rig) in ready_rigs() {
        for (settings, damping) in [(damped.undamped(), "undamped"), (damped, "damped")] {
            let gap = gap(&rig, &settings, None);
            println!("{name}, {damping}: {gap:.1e}");
            assert!(gap.abs() < 1e-5, "{name}, {damping}: {gap:e}");
        }
    }
}

#[test]
fn the_sliders_work_is_in_the_books() {
    for (name, rig) in ready_rigs() {
        let gap = gap(&rig, &PlantSettings::default(), Some([0.5, 0.4, -0.3]));
        println!("{name}: {gap:.1e}");
        assert!(gap.abs() < 1e-5, "{name}: {gap:e}");
    }
}
