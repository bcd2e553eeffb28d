//! Lengths, their rates, and where the leg comes to rest, over a grid of poses.

use super::{Case, STATICS_M, export};
use crate::common::{numbers, python};
use leg_rig::rig_file::RigFile;
use nalgebra::{Matrix3, Matrix3x2, Vector3};
use serde_json::{Value, json};
use std::path::Path;

/// For lengths, m, and their rates, m/rad.
const KINEMATICS: f64 = 1e-9;

const OTHER_PAYLOADS_KG: [f64; 2] = [0.0, 2.0];
const AZIMUTHS_DEG: [f64; 5] = [0.0, 30.0, 105.0, 200.0, 300.0];
const TILTS_DEG: [f64; 4] = [0.0, 10.0, 20.0, 30.0];

/// The pose at which the leg falls into place, too, counted among the poses: azimuth 30°, tilt 30°.
const SETTLED: usize = 7;

impl Case {
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
