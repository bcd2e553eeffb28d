//! Every ready rig, a member of the paper's class each: small loads against the nonlinear equilibrium, and the same
//! answers from the host in f64, the firmware's f32 and the emulated core.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use crate::common::{difference, numbers};
use leg_model::{Query, StiffnessAt, evaluate};
use leg_model_tools::nonlinear;
use leg_rig::ready_rigs::{READY_RIGS, ReadyRig};
use leg_rig::rig_file::RigFile;
use serde_json::{Map, Value};
use std::collections::BTreeSet;
use std::io::Write;
use std::process::{Command, Stdio};

/// A weight so small that the leg answers it linearly. With three freedoms nothing is left out of the linear answer;
/// with two it is in the planes of symmetry, where no moment about the blocked axis turns with it.
#[test]
fn a_small_weight_deviates_linearly_on_every_support() {
    for ready in READY_RIGS {
        let file = RigFile::parse(ready.name, ready.text).unwrap();
        let mut rig = file.parameters;
        rig.gravity_m_per_s2 = 1e-5;
        let azimuths: &[f64] = if file.support.twists() {
            &[0.0, 17.0, 130.0, 305.0]
        } else {
            &[0.0, 180.0]
        };
        for &azimuth in azimuths {
            let query = Query {
                stiffness_at: StiffnessAt::Tension,
                ..file.query(azimuth, file.tilt_deg.min(25.0), 1.0)
            };
            let linear = evaluate(&rig, &query).unwrap().deviation_m;
            let nonlinear = nonlinear::deviation_m(&rig, &query).unwrap().unwrap();
            let relative = (nonlinear / linear - 1.0).abs();
            assert!(
                relative < 1e-5,
                "{} at {azimuth}°: {relative:e}",
                ready.name
            );
        }
    }
}

const POSES: &str = r#"{"azimuth_deg":0,"tilt_deg":0,"payload_kg":1}
{"azimuth_deg":30,"tilt_deg":20,"payload_kg":0}
{"azimuth_deg":75,"tilt_deg":-15,"payload_kg":0.5,"level_n":60}
{"azimuth_deg":290,"tilt_deg":30,"payload_kg":2,"stiffness_at":"tension"}
{"azimuth_deg":160,"tilt_deg":25,"payload_kg":1.5,"stiffness_n_per_m":80000}
"#;

fn answers(rig: &str, on: &str) -> String {
    let leg = env!("CARGO_BIN_EXE_leg-under-test");
    let mut leg = Command::new(leg)
        .args(["eval", "--on", on, "--rig", rig])
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .unwrap();
    leg.stdin
        .take()
        .unwrap()
        .write_all(POSES.as_bytes())
        .unwrap();
    let output = leg.wait_with_output().unwrap();
    assert!(output.status.success(), "{rig} on {on}");
    String::from_utf8(output.stdout).unwrap()
}

fn objects(text: &str) -> Vec<Map<String, Value>> {
    text.lines()
        .map(|line| serde_json::from_str(line).unwrap())
        .collect()
}

/// What f32 does not compute.
const DOUBLE_ONLY: [&str; 1] = ["deviation_nonlinear_m"];

/// f32 against f64, and the emulated core against f32.
fn assert_alike_everywhere(rig: &str) {
    let single = answers(rig, "f32");
    assert_eq!(answers(rig, "qemu"), single, "{rig}: bits");
    let (double, single) = (objects(&answers(rig, "f64")), objects(&single));
    assert_eq!(double.len(), 5);
    for (double, single) in double.iter().zip(&single) {
        let mut keys: BTreeSet<&String> = single.keys().collect();
        assert!(DOUBLE_ONLY.iter().all(|key| !single.contains_key(*key)));
        let double_only = DOUBLE_ONLY.map(String::from);
        keys.extend(&double_only);
        assert_eq!(double.keys().collect::<BTreeSet<_>>(), keys, "{rig}");
        let numeric = single
            .iter()
            .filter(|(_, value)| value.is_number() || value.is_array());
        for (key, value) in numeric.filter(|(key, _)| *key != "level_limits") {
            let (found, expected) = (numbers(value), numbers(&double[key]));
            // What vanishes at the vertical is judged absolutely.
            let absolute = found
                .iter()
                .zip(&expected)
                .all(|(a, b)| (a - b).abs() < 1e-7);
            let off = difference(&found, &expected);
            assert!(absolute || off < 3e-5, "{rig} {key}: {off:e}");
        }
    }
}

#[test]
fn f32_agrees_with_f64_and_the_emulated_core_with_f32_on_every_support() {
    for rig in &READY_RIGS {
        assert_alike_everywhere(rig.name);
    }
}

#[test]
fn tendons_with_a_curve_each_cross_the_link() {
    let text = READY_RIGS[0].text;
    let (start, end) = (
        text.find("[tendon.curve]").unwrap(),
        text.find("[workspace]").unwrap(),
    );
    let curve = |name: &str, stiffer: &str| {
        let named = text[start..end].replace("[tendon.curve]", name);
        // Another last point: stiffer tendons are stretched less.
        named.replace("2.516238389659529", stiffer)
    };
    let curves = [
        curve("[tendon.curve_1]", "2.5162"),
        curve("[tendon.curve_2]", "2.51"),
        curve("[tendon.curve_3]", "2.52"),
    ];
    let directory = tempfile::tempdir().unwrap();
    let file = directory.path().join("each.toml");
    std::fs::write(
        &file,
        [&text[..start], &curves.concat(), &text[end..]].concat(),
    )
    .unwrap();
    assert_alike_everywhere(file.to_str().unwrap());
}

/// `leg run` on a rig, as JSON.
fn run(rig: &ReadyRig, on: &str) -> Value {
    let directory = tempfile::tempdir().unwrap();
    let output = Command::new(env!("CARGO_BIN_EXE_leg-under-test"))
        .args(["run", "--json", "--scenario", "support", "--on", on])
        .args(["--rig", rig.name, "--plots"])
        .arg(directory.path())
        .output()
        .unwrap();
    assert!(output.status.success(), "{} on {on}: {output:?}", rig.name);
    serde_json::from_slice(&output.stdout).unwrap()
}

/// The moving leg: its tip comes to its target on every support, and the emulated core measures the same to the last
/// digit.
#[test]
fn the_leg_moves_on_every_support_with_equal_bits() {
    for rig in &READY_RIGS {
        let (qemu, sim) = (run(rig, "qemu"), run(rig, "sim"));
        assert!(qemu["findings"].as_array().unwrap().len() > 2);
        for key in ["findings", "ticks", "tension_range_n", "divergence"] {
            assert_eq!(qemu[key], sim[key], "{}: {key}", rig.name);
        }
        assert_eq!(qemu["divergence"]["other_state"], 0, "{}", rig.name);
    }
}

/// The deviation that the paper's idealisation gives bounds that of its class: stiffer joints sag less.
#[test]
fn members_of_the_class_differ_by_their_joints_only() {
    let deviation = |name: &str| {
        let ready = READY_RIGS.iter().find(|rig| rig.name == name).unwrap();
        let file = RigFile::parse(ready.name, ready.text).unwrap();
        evaluate(&file.parameters, &file.query(0.0, 10.0, 1.0))
            .unwrap()
            .deviation_m
    };
    let [ball, pivot] = ["spherical", "compliant_pivot"].map(deviation);
    assert!(pivot < 0.99 * ball, "{pivot} {ball}");
    let [rigid, notch] = ["universal", "notch_universal"].map(deviation);
    assert!(notch < 0.995 * rigid, "{notch} {rigid}");
}

/// Largest and mean difference of the linear deviation from the nonlinear equilibrium over the workspace, percent, with
/// the load's own stiffness and tendons of the constant stiffness at the pretension.
fn linear_error_percent(file: &RigFile) -> (f64, f64) {
    let tendons = crate::common::constant_tendons(file.stiffnesses_n_per_m()[0]).unwrap();
    let mut errors = Vec::new();
    for payload_kg in [0.0, 0.5, 1.0, 2.0] {
        for azimuth in (0..360).step_by(15) {
            for tilt in [1, 2, 3, 4, 5, 6].map(|part| file.tilt_deg / 6.0 * f64::from(part)) {
                let query = Query {
                    tendons,
                    ..file.query(f64::from(azimuth), tilt, payload_kg)
                };
                let linear = evaluate(&file.parameters, &query).unwrap();
                let nonlinear = nonlinear::deviation_m(&file.parameters, &query).unwrap();
                let taut = linear.tensions_n.iter().all(|&tension| tension > 0.0);
                // Where a stiff joint leaves a tendon nothing to pull, the leg is not linear.
                let (true, Some(nonlinear)) = (taut, nonlinear) else {
                    continue;
                };
                errors
                    .push(100.0 * (linear.deviation_with_load_stiffness_m / nonlinear - 1.0).abs());
            }
        }
    }
    let mean = errors.iter().sum::<f64>() / errors.len() as f64;
    (errors.into_iter().fold(0.0, f64::max), mean)
}

#[test]
fn the_linear_deviation_is_near_the_equilibrium_over_the_workspace() {
    for ready in READY_RIGS {
        let file = RigFile::parse(ready.name, ready.text).unwrap();
        let (largest, mean) = linear_error_percent(&file);
        println!(
            "{}: at most {largest:.2} %, {mean:.2} % on average",
            ready.name
        );
        assert!(
            (0.005..1.5).contains(&mean),
            "{}: {mean} % on average",
            ready.name
        );
        assert!(largest < 1.1, "{}: at most {largest} %", ready.name);
    }
}
