//! The exported MuJoCo models, judged by MuJoCo: `tests/python/compare_with_mujoco.py` runs in a virtual environment under the
//! target directory.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use crate::common::{numbers, python};
use leg_model::{Direction, Evaluation, Load, Query, Rig, Tendon, evaluate};
use leg_model_tools::mjcf::{HeldLeg, HeldTendon, Mjcf};
use leg_model_tools::nonlinear::{Balance, Posture};
use leg_rig::rig_file::RigFile;
use nalgebra::{Matrix3, Matrix3x2, Vector3};
use serde_json::{Value, json};
use std::fs::File;
use std::path::{Path, PathBuf};

/// For lengths, m, and their rates, m/rad.
const KINEMATICS: f64 = 1e-9;

/// For the tip at rest, m.
const STATICS_M: f64 = 1e-6;

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
            leg: HeldLeg::new(&rig.parameters, &query).unwrap(),
            evaluation: evaluate(&rig.parameters, &query).unwrap(),
            direction: Direction::from_angles(query.azimuth_rad, query.tilt_rad).unwrap(),
        }
    }

    fn target_m(&self) -> Vector3<f64> {
        self.direction.vector() * self.leg.tip_m()
    }

    /// The tip at rest with a payload, by the host's nonlinear equilibrium. As in the export nothing stretches.
    fn tip_at_rest_m(&self, payload_kg: f64) -> Vector3<f64> {
        let rig = Rig::new(&self.leg.parameters).unwrap();
        let tendon = |tendon: HeldTendon| Tendon::constant(tendon.stiffness_n_per_m).unwrap();
        let balance = Balance::new(
            rig,
            Load::new(&rig, payload_kg).unwrap(),
            self.leg.support,
            self.leg.tendons.map(tendon),
            self.leg.tendons.map(|tendon| tendon.unstretched_m).into(),
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
        let others = OTHER_PAYLOADS_KG.map(|payload_kg| self.tip_at_rest_m(payload_kg));
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
    let model = Mjcf::new(&case.leg).unwrap();
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
fn torsion_free() {
    agrees("table1");
}

#[test]
fn spherical() {
    agrees("spherical");
}

#[test]
fn universal() {
    agrees("universal");
}

#[test]
fn compliant_pivot() {
    agrees("compliant_pivot");
}

#[test]
fn elastic_rod_universal() {
    agrees("elastic_rod_universal");
}

#[test]
fn notch_universal() {
    agrees("notch_universal");
}

#[test]
fn leaf_spring_universal() {
    agrees("leaf_spring_universal");
}
