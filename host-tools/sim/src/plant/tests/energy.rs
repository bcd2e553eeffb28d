//! The energy balance.

use super::{HELD, OFF, PlantSettings, driven, plant, ready_rigs, run};

/// Energy that does not add up after a push and a swing of 0.25 s, as a part of what the push brought.
fn gap(rig: &leg_rig::rig_file::RigFile, settings: &PlantSettings, duty: Option<[f32; 3]>) -> f64 {
    let mut plant = plant(rig, settings, HELD);
    let before = plant.energy_j();
    plant.push([20.0, -10.0, 5.0].into(), 0.02, 0.0);
    run(&mut plant, 2000, &duty.map_or(OFF, driven));
    let scale = plant.work.push_j.abs() + plant.work.sliders_j.abs();
    assert!(scale > 1e-3, "{scale} J");
    plant.energy_gap_j(before) / scale
}

#[test]
fn the_energy_is_that_before_and_the_work() {
    let damped = PlantSettings::default();
    let turning = Some([0.5, 0.4, -0.3]);
    for (name, rig) in ready_rigs() {
        for (case, settings, duty) in [
            ("undamped", damped.undamped(), None),
            ("damped", damped, None),
            ("with turning motors", damped, turning),
        ] {
            let gap = gap(&rig, &settings, duty);
            println!("{name}, {case}: {gap:.1e}");
            assert!(gap.abs() < 1e-5, "{name}, {case}: {gap:e}");
        }
    }
}
