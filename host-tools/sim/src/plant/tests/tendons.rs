//! The tendons: slack, stretched beyond their curve, cut, and not as the rig file says.

use super::{HELD, OFF, PlantSettings, Start, driven, plant, ready, run};
use crate::plant::Defect;
use crate::plant::tendon_pull::RealTendon;
use leg_model::Elasticity;

#[test]
fn a_slack_leg_hangs_at_rest_until_its_tendons_are_wound_up() {
    let start = Start::Slack { slack_mm: 0.5 };
    let mut plant = plant(&ready("table1"), &PlantSettings::default(), start);
    run(&mut plant, 800, &OFF);
    let at_rest = plant.truth();
    assert_eq!((at_rest.tensions_n, at_rest.tip_m.z), ([0.0; 3], -0.219));
    let at_zero = plant.unstretched_at_zero_m();
    assert!(at_zero.iter().all(|length| (length - 0.0355).abs() < 1e-15));
    while plant.truth().tensions_n[0] < 20.0 {
        plant.step(&driven([0.1; 3]));
        // While it reels in, the encoder gives the length to a count.
        let (truth, m_per_count) = (plant.truth(), plant.actuators[0].m_per_count());
        let counts = plant.sense().encoder_counts;
        for i in 0..3 {
            let counted = at_zero[i] - f64::from(counts[i]) * m_per_count;
            assert!((0.0..=m_per_count * 1.001).contains(&(counted - truth.unstretched_m[i])));
        }
    }
    assert!(plant.truth().time_s < 1.0);
}

#[test]
fn beyond_its_curve_a_tendon_goes_on_straight() {
    let tendon = ready("table1").tendons[0];
    let (end_m, stiffness) = (
        tendon.elongation(200.0).unwrap(),
        tendon.stiffness(200.0).unwrap(),
    );
    let real = RealTendon::new(&tendon, 0.0).unwrap();
    let (farther, tension) = (end_m + 1e-4, 200.0 + 1e-4 * stiffness);
    assert!((real.tension_n(farther) - tension).abs() < 1e-9);
    for elongation in [0.3 * end_m, end_m, farther] {
        let energy = |step: f64| real.energy_j(elongation + step);
        let slope = (energy(1e-8) - energy(-1e-8)) / 2e-8;
        let tension = real.tension_n(elongation);
        assert!((slope / tension - 1.0).abs() < 1e-6, "{slope} {tension}");
    }
    assert!(RealTendon::new(&tendon, -1.0).is_err());
}

/// It rests at the pose with the same tensions, on tendons that are shorter without tension.
#[test]
fn tendons_that_stretch_more_hold_the_leg_alike() {
    let rig = ready("spherical");
    let softer = PlantSettings {
        curve_error: 0.1,
        ..PlantSettings::default()
    };
    let (by_file, mut real) = (
        plant(&rig, &PlantSettings::default(), HELD),
        plant(&rig, &softer, HELD),
    );
    run(&mut real, 400, &OFF);
    let (by_file, real) = (by_file.truth(), real.truth());
    assert!((by_file.tip_m - real.tip_m).norm() < 1e-12);
    for i in 0..3 {
        let tension = by_file.tensions_n[i];
        let more = 0.1 * rig.tendons[i].elongation(tension).unwrap();
        assert!((tension - real.tensions_n[i]).abs() < 1e-6);
        assert!((by_file.unstretched_m[i] - real.unstretched_m[i] - more).abs() < 1e-12);
    }
}

#[test]
fn the_energy_balance_holds_over_a_cut_and_a_change_of_payload() {
    let mut plant = plant(&ready("universal"), &PlantSettings::default(), HELD);
    let before = plant.energy_j();
    plant.set_payload(2.0, 0.1);
    run(&mut plant, 400, &OFF);
    assert!((plant.truth().payload_kg - 1.25).abs() < 1e-9);
    run(&mut plant, 800, &OFF);
    assert_eq!(plant.truth().payload_kg, 2.0);
    plant.set_defect(Defect::TendonCut(2), true);
    run(&mut plant, 800, &OFF);
    let work = plant.work;
    assert!(work.cut_j > 1e-3 && work.payload_j < -1.0);
    let gap = plant.energy_gap_j(before);
    assert!(gap.abs() < 1e-5, "{gap:e} J");
}

#[test]
fn a_start_that_no_tension_holds_is_refused() {
    let rig = ready("table1");
    let start = |pretension_n, payload_kg| Start::Held {
        azimuth_deg: 30.0,
        tilt_deg: 30.0,
        pretension_n,
        payload_kg,
    };
    for refused in [start(10.0, 1.0), start(70.0, 50.0), start(70.0, -1.0)] {
        let settings = PlantSettings::default();
        assert!(crate::plant::Plant::new(&rig, &settings, refused, 1).is_err());
    }
}
