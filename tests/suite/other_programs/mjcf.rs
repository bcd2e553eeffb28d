//! The exported MuJoCo models, judged by MuJoCo: `tests/python/compare_with_mujoco.py` runs in a virtual environment under the
//! target directory.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use crate::common::{numbers, python};
use leg_firmware::drive::Drive;
use leg_firmware::sensors::TICK_HZ;
use leg_model::{Direction, Evaluation, Load, Query, Rig, Tendon, evaluate};
use leg_model_tools::leg_shape::Body;
use leg_model_tools::mjcf::{HeldLeg, HeldTendon, Mjcf};
use leg_model_tools::nonlinear::{Balance, Posture};
use leg_rig::ready_rigs::READY_RIGS;
use leg_rig::rig_file::RigFile;
use leg_sim::plant::{Plant, Start};
use nalgebra::{Matrix3, Matrix3x2, Vector3};
use serde_json::{Value, json};
use std::f64::consts::PI;
use std::fs::File;
use std::path::{Path, PathBuf};

/// For lengths, m, and their rates, m/rad.
const KINEMATICS: f64 = 1e-9;

/// For the tip at rest, m.
const STATICS_M: f64 = 1e-6;

/// For frequency and damping of a swing, as a part of them.
const SWING: f64 = 0.02;

/// How long the simulated leg is pushed before, and how long it is looked at after, s.
const PUSHED_S: f64 = 6.0;
const SWINGING_S: f64 = 1.0;

const PAYLOAD_KG: f64 = 1.0;
const OTHER_PAYLOADS_KG: [f64; 2] = [0.0, 2.0];
const AZIMUTHS_DEG: [f64; 5] = [0.0, 30.0, 105.0, 200.0, 300.0];
const TILTS_DEG: [f64; 4] = [0.0, 10.0, 20.0, 30.0];

/// The pose at which the leg falls into place, too, counted among the poses: azimuth 30°, tilt 30°.
const SETTLED: usize = 7;

/// One exported leg and what the model says of it.
struct Case {
    leg: HeldLeg,
    evaluation: Evaluation<f64>,
    direction: Direction<f64>,
}

impl Case {
    fn new(rig: &RigFile, azimuth_deg: f64, tilt_deg: f64) -> Self {
        let at_the_rigs_pretension = rig.query(azimuth_deg, tilt_deg, PAYLOAD_KG);
        let [lowest, highest] = evaluate(&rig.parameters, &at_the_rigs_pretension)
            .unwrap()
            .pretension_range_n;
        // The rig's pretension does not serve every elastic joint at every pose.
        let query = Query {
            pretension_n: (lowest + highest) / 2.0,
            ..at_the_rigs_pretension
        };
        Self {
            leg: HeldLeg::new(rig, &query).unwrap(),
            evaluation: evaluate(&rig.parameters, &query).unwrap(),
            direction: Direction::from_angles(query.azimuth_rad, query.tilt_rad).unwrap(),
        }
    }

    fn target_m(&self) -> Vector3<f64> {
        self.direction.vector() * self.leg.tip_m()
    }

    /// The tip at rest with a payload, each tendon reeled in by so much, m, by the host's nonlinear equilibrium. As in the export
    /// nothing stretches.
    fn tip_at_rest_m(&self, payload_kg: f64, reeled_m: [f64; 3]) -> Vector3<f64> {
        let rig = Rig::new(&self.leg.parameters).unwrap();
        let tendon = |tendon: HeldTendon| Tendon::constant(tendon.stiffness_n_per_m).unwrap();
        let balance = Balance::new(
            rig,
            Load::new(&rig, payload_kg).unwrap(),
            self.leg.support,
            self.leg.tendons.map(tendon),
            Vector3::from(self.leg.tendons.map(|tendon| tendon.unstretched_m))
                - Vector3::from(reeled_m),
        );
        let start = Posture {
            direction: self.direction,
            torsion: 0.0,
        };
        balance.rest(start).unwrap().direction.vector() * self.leg.tip_m()
    }

    /// −Aᵀ times the leg's rotation rates by joint.
    fn length_rates(&self, rotation_rates: &[Vec<f64>]) -> Vec<f64> {
        let moment_map = Matrix3::from_fn(|i, j| self.evaluation.moment_map_m[i][j]);
        let joints = rotation_rates[0].len();
        let column = |joint: usize| Vector3::from_fn(|i, _| rotation_rates[i][joint]);
        let rates: Vec<Vector3<f64>> = (0..joints)
            .map(|joint| -moment_map.transpose() * column(joint))
            .collect();
        (0..3)
            .flat_map(|tendon| rates.iter().map(move |rate| rate[tendon]))
            .collect()
    }

    /// What MuJoCo finds at the pose without letting the leg move.
    fn judge_kinematics(&self, found: &Value) {
        let rotations: Vec<Vec<f64>> = found["rotation_rates"]
            .as_array()
            .unwrap()
            .iter()
            .map(numbers)
            .collect();
        let near =
            |key: &str, expected: &[f64]| self.assert_close(found, key, expected, KINEMATICS);
        near("lengths_m", &self.evaluation.lengths_m);
        near("length_rates_m_per_rad", &self.length_rates(&rotations));
        near("tip_m", self.target_m().as_slice());
    }

    /// Where MuJoCo finds the leg at rest.
    fn judge_statics(&self, found: &Value) {
        let near = |key: &str, expected: &[f64]| self.assert_close(found, key, expected, STATICS_M);
        let target = self.target_m();
        near("tip_at_rest_m", target.as_slice());
        if !found["tip_settled_m"].is_null() {
            near("tip_settled_m", target.as_slice());
        }
        let others = OTHER_PAYLOADS_KG.map(|payload_kg| self.tip_at_rest_m(payload_kg, [0.0; 3]));
        near(
            "other_tips_at_rest_m",
            Matrix3x2::from_columns(&others).as_slice(),
        );
    }

    fn assert_close(&self, found: &Value, key: &str, expected: &[f64], tolerance: f64) {
        let far = largest_difference(&numbers(&found[key]), expected);
        let HeldLeg {
            support,
            azimuth_deg,
            tilt_deg,
            ..
        } = &self.leg;
        assert!(
            far <= tolerance,
            "{support:?}, azimuth {azimuth_deg}, tilt {tilt_deg}: {key} differs by {far:e}"
        );
    }
}

/// Infinite for arrays of different lengths, NaN where a number is missing.
fn largest_difference(found: &[f64], expected: &[f64]) -> f64 {
    if found.len() != expected.len() {
        return f64::INFINITY;
    }
    let differences = found.iter().zip(expected).map(|(a, b)| (a - b).abs());
    differences.fold(0.0, |largest, next| {
        if next > largest || next.is_nan() {
            next
        } else {
            largest
        }
    })
}

/// Asks MuJoCo about every case.
fn ask(cases: &[Case]) -> Vec<Value> {
    let directory = tempfile::tempdir().unwrap();
    let jobs: Vec<Value> = cases
        .iter()
        .enumerate()
        .map(|(i, case)| {
            json!({
                "model": export(case, directory.path(), i),
                "other_payloads_kg": OTHER_PAYLOADS_KG,
                "settle": i == SETTLED,
            })
        })
        .collect();
    let answers = python::answers("compare_with_mujoco.py", &jobs);
    assert_eq!(answers.len(), cases.len());
    answers
}

fn export(case: &Case, directory: &Path, i: usize) -> PathBuf {
    let path = directory.join(format!("{i}.xml"));
    let model = Mjcf::new(&case.leg, None).unwrap();
    model.write(File::create(&path).unwrap()).unwrap();
    path
}

/// Exports a ready rig over the grid of poses and sets MuJoCo's answers beside the model.
fn agrees(rig: &str) {
    let rig = RigFile::load(Some(Path::new(rig))).unwrap();
    let cases: Vec<Case> = AZIMUTHS_DEG
        .into_iter()
        .flat_map(|azimuth| TILTS_DEG.map(|tilt| Case::new(&rig, azimuth, tilt)))
        .collect();
    for (case, found) in cases.iter().zip(ask(&cases)) {
        case.judge_kinematics(&found);
        case.judge_statics(&found);
    }
}

#[test]
#[ignore = "needs Python 3.11"]
fn torsion_free() {
    agrees("table1");
}

#[test]
#[ignore = "needs Python 3.11"]
fn spherical() {
    agrees("spherical");
}

#[test]
#[ignore = "needs Python 3.11"]
fn universal() {
    agrees("universal");
}

#[test]
#[ignore = "needs Python 3.11"]
fn compliant_pivot() {
    agrees("compliant_pivot");
}

#[test]
#[ignore = "needs Python 3.11"]
fn elastic_rod_universal() {
    agrees("elastic_rod_universal");
}

#[test]
#[ignore = "needs Python 3.11"]
fn notch_universal() {
    agrees("notch_universal");
}

#[test]
#[ignore = "needs Python 3.11"]
fn leaf_spring_universal() {
    agrees("leaf_spring_universal");
}

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

/// Straight down, and leaning in the plane of a tendon, pushed along and across.
#[test]
#[ignore = "needs Python 3.11"]
fn it_swings_as_the_simulated_leg() {
    let rig = RigFile::load(None).unwrap();
    let pushes = [
        (0.0, Vector3::x()),
        (20.0, Vector3::x()),
        (20.0, Vector3::y()),
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
    for ((case, (tilt_deg, force_n)), free) in cases.iter().zip(pushes).zip(&answers) {
        let rest_m = case.target_m();
        let tips = free["tips_m"].as_array().unwrap();
        let tips = tips.iter().map(|tip| Vector3::from_vec(numbers(tip)));
        let exported: Vec<f64> = tips.map(|tip| (tip - rest_m).dot(&force_n)).collect();
        let exported = Swing::new(&exported, free["step_s"].as_f64().unwrap());
        let simulated = plant_offsets(&rig, case, force_n);
        let simulated: Vec<f64> = simulated.iter().map(|off| off.dot(&force_n)).collect();
        let simulated = Swing::new(&simulated, 1.0 / f64::from(TICK_HZ));
        assert!(
            exported.agrees(&simulated),
            "tilt {tilt_deg}, along {force_n:?}: MuJoCo {exported:?}, simulated {simulated:?}"
        );
        // The sensors: tensions, lengths and their rates, the tip, and the leg's axis, which points upwards.
        let Evaluation {
            tensions_n,
            lengths_m,
            ..
        } = &case.evaluation;
        let mut measured = [*tensions_n, *lengths_m, [0.0; 3]].concat();
        measured.extend(rest_m.iter().chain(&(-rest_m / case.leg.tip_m())));
        let far = largest_difference(&numbers(&free["sensors"]), &measured);
        assert!(far < 1e-6, "tilt {tilt_deg}: sensors differ by {far:e}");
    }
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
    assert!((servo_time_s * f64::from(rig.gains.servo.position_gain_per_s) - 1.0).abs() < 1e-6);
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

/// With their feet apart, on every rig.
#[test]
#[ignore = "needs Python 3.11"]
fn six_legs_stand_around_a_body() {
    let directory = tempfile::tempdir().unwrap();
    let jobs = READY_RIGS.iter().map(|ready| {
        let rig = RigFile::load(Some(Path::new(ready.name))).unwrap();
        let leg = HeldLeg::new(&rig, &rig.query(0.0, 10.0, 0.0)).unwrap();
        let path = directory.path().join(format!("{}.xml", ready.name));
        let body = Body::new(&rig, 6, 0.2, None).unwrap();
        let model = Mjcf::new(&leg, Some(body)).unwrap();
        model.write(File::create(&path).unwrap()).unwrap();
        json!({ "model": path, "stands_s": 1.0 })
    });
    let jobs: Vec<Value> = jobs.collect();
    let answers = python::answers("compare_with_mujoco.py", &jobs);
    for (ready, found) in READY_RIGS.iter().zip(&answers) {
        let [sunk_m, leans] = ["sunk_m", "leans"].map(|key| found[key].as_f64().unwrap());
        let at_most_m = 0.01;
        assert!(
            sunk_m.abs() < at_most_m && leans < 0.01,
            "{}: {found}",
            ready.name
        );
        assert_eq!(found["actuators"], 18, "{}", ready.name);
    }
}
