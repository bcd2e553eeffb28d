//! The exported MuJoCo models, judged by MuJoCo: `tests/python/compare_with_mujoco.py` runs in a virtual environment under the
//! target directory.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

mod kinematics;
mod motion;
mod six_legs;

use crate::common::numbers;
use leg_model::{Direction, Evaluation, Load, Query, Rig, Tendon, evaluate};
use leg_model_tools::mjcf::{HeldLeg, HeldTendon, Mjcf};
use leg_model_tools::nonlinear::{Balance, Posture};
use leg_rig::rig_file::RigFile;
use nalgebra::Vector3;
use serde_json::Value;
use std::fs::File;
use std::path::{Path, PathBuf};

/// For the tip at rest, m.
const STATICS_M: f64 = 1e-6;

const PAYLOAD_KG: f64 = 1.0;
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

fn export(case: &Case, directory: &Path, i: usize) -> PathBuf {
    let path = directory.join(format!("{i}.xml"));
    let model = Mjcf::new(&case.leg, None).unwrap();
    model.write(File::create(&path).unwrap()).unwrap();
    path
}
