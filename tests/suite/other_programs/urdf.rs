//! The exported URDF robots, read by urdf_parser_py and by MuJoCo: `tests/python/read_urdf.py`.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use crate::common::{numbers, python};
use leg_model::Direction;
use leg_model_tools::leg_shape::Body;
use leg_model_tools::urdf::Urdf;
use leg_rig::ready_rigs::READY_RIGS;
use leg_rig::rig_file::RigFile;
use nalgebra::{Rotation3, Vector3};
use serde_json::{Value, json};
use std::f64::consts::TAU;
use std::fs::File;
use std::path::Path;

const TIP_M: f64 = 1e-9;

const PAYLOAD_KG: f64 = 1.5;

/// Where a leg is led from the pose at which its joints are at zero: azimuth and tilt, rad.
const OTHER_POSE: [f64; 2] = [1.1, 0.15];

const SIX: Body = Body {
    legs: 6,
    radius_m: 0.2,
    mass_kg: 3.0,
};

fn rig(name: &str) -> RigFile {
    RigFile::load(Some(Path::new(name))).unwrap()
}

/// A robot whose joints are at zero at a pose, and their angles at another one, as its comment says.
fn robot(
    rig: &RigFile,
    payload_kg: f64,
    [zero, other]: [[f64; 2]; 2],
    body: Option<Body>,
) -> (Urdf, [f64; 2]) {
    let robot = Urdf::new(rig, payload_kg, zero.map(f64::to_degrees), body).unwrap();
    let mut text = Vec::new();
    robot.write(&mut text).unwrap();
    let text = String::from_utf8(text).unwrap();
    let added_rad = |formula: &str| -> f64 {
        let (_, after) = text.split_once(&format!("{formula} ")).unwrap();
        let digits = after.split([',', ' ', '\n']).next().unwrap();
        digits.trim_end_matches('.').parse().unwrap()
    };
    let [azimuth, tilt] = other;
    let angles_rad = [
        (tilt.sin() * azimuth.sin()).atan2(tilt.cos()) + added_rad("atan2(sin t sin a, cos t)"),
        -(tilt.sin() * azimuth.cos()).asin() + added_rad("-asin(sin t cos a)"),
    ];
    (robot, angles_rad)
}

fn tip_m(rig: &RigFile, [azimuth, tilt]: [f64; 2]) -> Vector3<f64> {
    let direction = Direction::from_angles(azimuth, tilt).unwrap();
    direction.vector() * (rig.parameters.joint_length_m + rig.parameters.leg_length_m)
}

fn assert_near(found: &Value, expected: Vector3<f64>) {
    let found = numbers(found);
    let far = (Vector3::from_column_slice(&found) - expected).norm();
    assert!(far <= TIP_M, "{found:?}, {expected:?}");
}

/// Exports robots, and asks about each.
fn read(robots: &[(Urdf, Value)]) -> Vec<Value> {
    let directory = tempfile::tempdir().unwrap();
    let jobs = robots.iter().enumerate().map(|(i, (robot, job))| {
        let path = directory.path().join(format!("{i}.urdf"));
        robot.write(File::create(&path).unwrap()).unwrap();
        let mut job = job.clone();
        job["robot"] = json!(path);
        job
    });
    python::answers("read_urdf.py", &jobs.collect::<Vec<_>>())
}

#[test]
#[ignore = "needs Python 3.11"]
fn one_leg_of_every_rig_is_where_the_model_says() {
    // Azimuths, and parts of the greatest tilt.
    let poses = [[0.0, 0.0], [0.7, 0.6], [2.5, 1.0], [-1.2, 0.9], [4.0, 0.4]];
    let cases: Vec<_> = READY_RIGS
        .iter()
        .flat_map(|ready| {
            let rig = rig(ready.name);
            poses.map(|[azimuth, part]| (rig, [azimuth, part * rig.tilt_deg.to_radians()]))
        })
        .collect();
    let robots: Vec<_> = cases
        .iter()
        .flat_map(|(rig, pose)| {
            let (robot, other_rad) = robot(rig, PAYLOAD_KG, [*pose, OTHER_POSE], None);
            let job = |rad| json!({ "tips": ["tip"], "prefix": "", "tilt_rad": rad });
            [(robot.clone(), job([0.0; 2])), (robot, job(other_rad))]
        })
        .collect();
    let read = read(&robots);
    for ((rig, pose), found) in cases.iter().zip(read.chunks_exact(2)) {
        assert_near(&found[1]["mujoco"]["tips_m"][0], tip_m(rig, OTHER_POSE));
        let found = &found[0];
        let mass = rig.parameters.leg_mass_kg + PAYLOAD_KG;
        for reader in ["parser", "mujoco"] {
            let read = found[reader]["mass_kg"].as_f64().unwrap();
            // The link between the joints has a milligram.
            assert!((read - mass - 1e-6).abs() < 1e-9, "{reader}: {read}");
        }
        assert_near(&found["mujoco"]["tips_m"][0], tip_m(rig, *pose));
        let parsed = &found["parser"];
        assert_eq!(parsed["root"], "base");
        assert_eq!(parsed["joints"], json!(["tilt_x", "tilt_y"]));
        assert_eq!(parsed["axes"], json!([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]));
        let limits = parsed["limits"].as_array().unwrap();
        for (limit, zero) in limits.iter().zip(numbers(&parsed["zeros_rad"])) {
            let [lower, upper, effort, velocity] = numbers(limit).try_into().unwrap();
            let tilt_rad = rig.tilt_deg.to_radians();
            assert!((lower + zero + tilt_rad).abs() < 1e-9, "{limit}, {zero}");
            assert!((upper + zero - tilt_rad).abs() < 1e-9, "{limit}, {zero}");
            assert!((velocity - f64::from(rig.gains.motion.speed_rad_per_s)).abs() < 1e-6);
            // Two tendons at 150 N on arms of some 12 mm.
            assert!((0.5..10.0).contains(&effort), "{effort}");
        }
        let shapes = parsed["shapes"].as_array().unwrap();
        assert_eq!(shapes.len(), 5, "plates, joint, rod and payload");
    }
}

#[test]
#[ignore = "needs Python 3.11"]
fn six_legs_stand_around_a_body() {
    let rig = rig(READY_RIGS[0].name);
    let tips: Vec<String> = (1..=6).map(|leg| format!("leg_{leg}_tip")).collect();
    // Towards its own x axis, which is outwards.
    let pose = [0.0, 0.4];
    let (robot, other_rad) = robot(&rig, 0.0, [pose, OTHER_POSE], Some(SIX));
    let job = json!({ "tips": tips, "prefix": "leg_3_", "tilt_rad": other_rad });
    let found = &read(&[(robot, job)])[0];
    let parsed = &found["parser"];
    assert_eq!(parsed["root"], "body");
    assert_eq!(parsed["joints"].as_array().unwrap().len(), 12);
    let mass = SIX.mass_kg + 6.0 * (rig.parameters.leg_mass_kg + 1e-6);
    let read = parsed["mass_kg"].as_f64().unwrap();
    assert!((read - mass).abs() < 1e-9, "{read}");
    for leg in 0..6 {
        let turn = Rotation3::from_axis_angle(&Vector3::z_axis(), TAU * f64::from(leg) / 6.0);
        let own = tip_m(&rig, if leg == 2 { OTHER_POSE } else { pose });
        let expected = turn * (Vector3::x() * SIX.radius_m + own);
        assert_near(&found["mujoco"]["tips_m"][leg as usize], expected);
    }
}
