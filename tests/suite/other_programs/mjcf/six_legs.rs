//! Legs around a body.

use crate::common::python;
use leg_model_tools::leg_shape::Body;
use leg_model_tools::mjcf::{HeldLeg, Mjcf};
use leg_rig::ready_rigs::READY_RIGS;
use leg_rig::rig_file::RigFile;
use serde_json::{Value, json};
use std::fs::File;
use std::path::Path;

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
