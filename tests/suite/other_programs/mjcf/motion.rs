//! How a leg swings, and how controls and encoders move it, beside the simulated leg.

use super::{Case, PAYLOAD_KG, STATICS_M, export, largest_difference};
use crate::common::{numbers, python};
use leg_firmware::drive::Drive;
use leg_firmware::sensors::TICK_HZ;
use leg_model::Evaluation;
use leg_rig::ready_rigs::READY_RIGS;
use leg_rig::rig_file::RigFile;
use leg_sim::plant::{Plant, Start};
use nalgebra::Vector3;
use serde_json::{Value, json};
use std::f64::consts::PI;
use std::path::Path;

/// For frequency and damping ratio of a swing, as a part of them.
const SWING: f64 = 0.01;

/// How long the simulated leg is pushed before, and how long it is looked at after, s.
const PUSHED_S: f64 = 6.0;
const SWINGING_S: f64 = 1.0;

/// How far a leg leans, as a part of its greatest tilt.
const LEANING: f64 = 2.0 / 3.0;

/// How an exported leg swings, beside the simulated one.
#[derive(Debug)]
struct Swing {
    hz: f64,
    damping_ratio: f64,
}

impl Swing {
    /// By the zeros of what is left of a push, m, and the extrema between them: half a period each, as many as are above a
    /// fiftieth of where it begins.
    fn new(offsets_m: &[f64], step_s: f64) -> Self {
        let sides: Vec<&[f64]> = offsets_m.chunk_by(|one, next| one * next > 0.0).collect();
        let highest_m = |side: &&[f64]| side.iter().fold(0.0, |most: f64, m| most.max(m.abs()));
        let first_m = highest_m(&sides[0]);
        let high = |side: &&&[f64]| highest_m(side) > 0.02 * first_m;
        // The first begins at an extremum, the last is not whole.
        let whole: Vec<_> = sides[1..sides.len() - 1].iter().take_while(high).collect();
        let halves = whole.len() as f64;
        let samples: usize = whole.iter().map(|side| side.len()).sum();
        let decrement = (first_m / highest_m(whole[whole.len() - 1])).ln() / halves;
        Self {
            hz: halves / (2.0 * samples as f64 * step_s),
            damping_ratio: decrement / decrement.hypot(PI),
        }
    }

    fn agrees(&self, other: &Self) -> bool {
        let close = |one: f64, other: f64| (one / other - 1.0).abs() <= SWING;
        close(self.hz, other.hz) && close(self.damping_ratio, other.damping_ratio)
    }
}

/// The tip of the simulated leg after a force there has ended, motors off, beside where it was before, m.
fn plant_offsets(rig: &RigFile, case: &Case, force_n: Vector3<f64>) -> Vec<Vector3<f64>> {
    let start = Start::Held {
        azimuth_deg: case.leg.azimuth_deg,
        tilt_deg: case.leg.tilt_deg,
        pretension_n: case.leg.pretension_n,
        payload_kg: case.leg.payload_kg,
    };
    let mut plant = Plant::new(rig, &rig.plant, start, 1).unwrap();
    let off = Drive::<f32> {
        duty: [0.0; 3],
        enabled: false,
    };
    let rest_m = plant.truth().tip_m;
    plant.push(force_n, PUSHED_S, 0.5 * PUSHED_S);
    let ticks = |span_s: f64| (span_s * f64::from(TICK_HZ)).round() as usize;
    (0..ticks(PUSHED_S)).for_each(|_| plant.step(&off));
    let tip_m = |plant: &mut Plant| {
        plant.step(&off);
        plant.truth().tip_m - rest_m
    };
    (0..ticks(SWINGING_S)).map(|_| tip_m(&mut plant)).collect()
}

/// Every ready rig: straight down, and leaning in the plane of a tendon, pushed along and across.
#[test]
#[ignore = "needs Python 3.11"]
fn it_swings_as_the_simulated_leg() {
    let wrong: Vec<String> = READY_RIGS
        .iter()
        .flat_map(|ready| swings_of(ready.name))
        .collect();
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// What differs of the swings of a rig.
fn swings_of(name: &str) -> Vec<String> {
    let rig = RigFile::load(Some(Path::new(name))).unwrap();
    let pushes = [
        (0.0, Vector3::x()),
        (LEANING * rig.tilt_deg, Vector3::x()),
        (LEANING * rig.tilt_deg, Vector3::y()),
    ];
    let cases = pushes.map(|(tilt_deg, _)| Case::new(&rig, 0.0, tilt_deg));
    let directory = tempfile::tempdir().unwrap();
    let job = |(i, case): (usize, &Case)| {
        json!({
            "model": export(case, directory.path(), i),
            "force_n": pushes[i].1.as_slice(),
        })
    };
    let jobs: Vec<Value> = cases.iter().enumerate().map(job).collect();
    let answers = python::answers("compare_with_mujoco.py", &jobs);
    let mut wrong = Vec::new();
    for ((case, (tilt_deg, force_n)), free) in cases.iter().zip(pushes).zip(&answers) {
        let rest_m = case.target_m();
        let tips = free["tips_m"].as_array().unwrap();
        let tips = tips.iter().map(|tip| Vector3::from_vec(numbers(tip)));
        let exported: Vec<f64> = tips.map(|tip| (tip - rest_m).dot(&force_n)).collect();
        let exported = Swing::new(&exported, free["step_s"].as_f64().unwrap());
        let simulated = plant_offsets(&rig, case, force_n);
        let simulated: Vec<f64> = simulated.iter().map(|off| off.dot(&force_n)).collect();
        let simulated = Swing::new(&simulated, 1.0 / f64::from(TICK_HZ));
        let place = format!("{name}, tilt {tilt_deg}, along {force_n:?}");
        if !exported.agrees(&simulated) {
            wrong.push(format!(
                "{place}: MuJoCo {exported:?}, simulated {simulated:?}"
            ));
        }
        // The sensors: tensions, lengths and their rates, the tip, and the leg's axis, which points upwards.
        let Evaluation {
            tensions_n,
            lengths_m,
            ..
        } = &case.evaluation;
        let mut measured = [*tensions_n, *lengths_m, [0.0; 3]].concat();
        measured.extend(rest_m.iter().chain(&(-rest_m / case.leg.tip_m())));
        let far = largest_difference(&numbers(&free["sensors"]), &measured);
        if far.is_nan() || far >= 1e-6 {
            wrong.push(format!("{place}: sensors differ by {far:e}"));
        }
    }
    wrong
}

/// A control reels its tendon in, with the time constant of the servo, and the leg comes to rest where the model says.
#[test]
#[ignore = "needs Python 3.11"]
fn a_control_reels_its_tendon_in() {
    let rig = RigFile::load(None).unwrap();
    let case = Case::new(&rig, 30.0, 10.0);
    let controls_m = [4e-4, -2e-4, 1e-4];
    let directory = tempfile::tempdir().unwrap();
    let job = json!({ "model": export(&case, directory.path(), 0), "controls_m": controls_m });
    let found = &python::answers("compare_with_mujoco.py", &[job])[0];
    let expected_m = case.tip_at_rest_m(PAYLOAD_KG, controls_m);
    assert!((expected_m - case.target_m()).norm() > 1e-3);
    case.assert_close(found, "tip_m", expected_m.as_slice(), STATICS_M);
    let servo_time_s = found["servo_time_s"].as_f64().unwrap();
    assert!((servo_time_s * f64::from(rig.gains.servos[0].position_gain_per_s) - 1.0).abs() < 1e-6);
    let reeled = found["reeled_m"].as_array().unwrap();
    assert_eq!(reeled.len(), 3);
    for (times, reeled_m) in (1..).zip(reeled) {
        let share = 1.0 - f64::from(-times).exp();
        for (reeled_m, control_m) in numbers(reeled_m).iter().zip(controls_m) {
            // To a step of the simulation.
            assert!((reeled_m / control_m - share).abs() < 0.015, "{found}");
        }
    }
    let counts = controls_m.map(|m| m / rig.calibration.m_per_count[0]);
    case.assert_close(found, "counts", &counts, 1e-3);
    case.assert_close(found, "counts_apart", &[0.0], 1e-3);
}

/// Motors turn the simulated leg, and hold it: by its counts MuJoCo's leg comes to the same place, and counts the same.
#[test]
#[ignore = "needs Python 3.11"]
fn encoders_count_as_those_of_the_simulated_leg() {
    let rig = RigFile::load(None).unwrap();
    let case = Case::new(&rig, 30.0, 10.0);
    let start = Start::Held {
        azimuth_deg: case.leg.azimuth_deg,
        tilt_deg: case.leg.tilt_deg,
        pretension_n: case.leg.pretension_n,
        payload_kg: case.leg.payload_kg,
    };
    let mut plant = Plant::new(&rig, &rig.plant, start, 1).unwrap();
    let counts = |plant: &mut Plant| plant.sense().encoder_counts;
    let (counts_before, tip_before_m) = (counts(&mut plant), plant.truth().tip_m);
    for (duty, enabled, span_s) in [([0.3, -0.2, 0.1], true, 0.05), ([0.0; 3], false, PUSHED_S)] {
        let drive = Drive { duty, enabled };
        (0..(span_s * f64::from(TICK_HZ)) as u32).for_each(|_| plant.step(&drive));
    }
    let counted: [f64; 3] = std::array::from_fn(|i| {
        let counts = counts(&mut plant)[i].wrapping_sub(counts_before[i]) as i16;
        f64::from(counts) * rig.calibration.counts_sign[i]
    });
    let moved_m = plant.truth().tip_m - tip_before_m;
    assert!(moved_m.norm() > 1e-3, "{moved_m:?}");

    let controls_m: Vec<f64> = (0..3)
        .map(|i| counted[i] * rig.calibration.m_per_count[i].abs())
        .collect();
    let directory = tempfile::tempdir().unwrap();
    let job = json!({ "model": export(&case, directory.path(), 0), "controls_m": controls_m });
    let found = &python::answers("compare_with_mujoco.py", &[job])[0];
    case.assert_close(found, "counts", &counted, 1e-3);
    let tip_m = Vector3::from_vec(numbers(&found["tip_m"]));
    let off_m = (tip_m - case.target_m() - moved_m).norm();
    // A straight spring is not the tendon's curve.
    assert!(
        off_m < 0.02 * moved_m.norm(),
        "{off_m} m of {moved_m:?}, {found}"
    );
}
