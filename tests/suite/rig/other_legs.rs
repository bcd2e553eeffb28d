//! Legs lighter, wider or longer than the paper's: homing finds their zero by what is derived from mass and geometry.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use leg_bench::stand::Stand;
use leg_firmware::command::Command;
use leg_firmware::supervisor::State;
use leg_rig::ready_rigs::READY_RIGS;
use leg_rig::rig_file::RigFile;
use leg_sim::plant::Start;

/// What a zero may be off, mm: three times what that of the paper's leg is.
const ZERO_MM: f64 = 0.03;

/// The rings of the paper's rig as its file gives them.
const RING: &str = "[[24, 0], [-12, 20.784609690826528], [-12, -20.784609690826528]]";

/// The paper's rig with other lines, anchors on rings of another radius, mm, and more at its end.
fn rig(lines: &[(&str, &str)], ring_mm: f64, more: &str) -> RigFile {
    let ring = [0.0_f64, 120.0, 240.0].map(|deg| {
        let (sine, cosine) = deg.to_radians().sin_cos();
        [ring_mm * cosine, ring_mm * sine]
    });
    let mut text = READY_RIGS[0].text.replace(RING, &format!("{ring:?}"));
    for (line, other) in lines {
        assert!(text.contains(line), "{line}");
        text = text.replace(line, other);
    }
    RigFile::parse("leg", &(text + more)).unwrap()
}

/// The text of a rig with tendons of one stiffness, N/m.
pub fn with_stiffness(text: &str, n_per_m: f64) -> String {
    let (mechanism, rest) = text.split_once("[tendon.curve]").unwrap();
    let (_, workspace) = rest.split_once("[workspace]").unwrap();
    let stiffness = format!("stiffness_n_per_m = {n_per_m}");
    let mechanism = mechanism.replace("stiffness_at = \"pretension\"", &stiffness);
    format!("{mechanism}[workspace]{workspace}")
}

/// When a leg begins to home, s.
pub const HOMES_S: f64 = 0.2;

/// A leg that was homed just now, from so much slack.
pub fn homed(rig: &RigFile, slack_mm: f64) -> Stand {
    let mut stand = Stand::new(rig, &rig.plant, Start::Slack { slack_mm }, 1).unwrap();
    stand.wait(HOMES_S).unwrap();
    stand.command(&Command::Home).unwrap();
    stand.wait(0.1).unwrap();
    stand
        .tick_until(300.0, "active", |stand| stand.state() == State::Active)
        .unwrap();
    assert!(!stand.faults().any(), "{:?}", stand.faults());
    stand
}

/// Homes a leg, and gives the most that a tendon's zero is off, mm.
fn zero_off_mm(rig: &RigFile) -> f64 {
    let mut stand = homed(rig, 2.0);
    let found_m = stand.telemetry.unwrap().unstretched_at_zero_m;
    let real_m = stand.plant().unstretched_at_zero_m();
    let pairs = found_m.iter().zip(real_m);
    pairs
        .map(|(found, real)| 1e3 * (f64::from(*found) - real).abs())
        .fold(0.0, f64::max)
}

/// A tendon that is found taut lifts such a leg far: what does not make it slack again lets homing fail, or find a zero that is off by 0.7 mm.
#[test]
fn wide_and_light_legs_find_their_zero() {
    let light = [("leg_kg = 1.5", "leg_kg = 0.5")];
    for (rig, touch_n) in [
        (rig(&light, 45.0, ""), 0.0..1.0),
        (rig(&[], 44.0, "\n[actuator]\ngear_ratio = 14\n"), 1.0..2.0),
    ] {
        let homing = &rig.gains.homing;
        let off_mm = zero_off_mm(&rig);
        println!("{} N: {off_mm:.4} mm", homing.touch_n);
        assert!(touch_n.contains(&homing.touch_n), "{} N", homing.touch_n);
        assert!(off_mm < ZERO_MM, "{off_mm} mm");
    }
}

/// Tendons that are longer than any pose of such a leg makes them show none, until they are taut again.
#[test]
fn a_leg_with_narrow_anchors_is_armed() {
    let tall = [
        ("upper_mm = 6", "upper_mm = 20"),
        ("joint_mm = 29", "joint_mm = 45"),
    ];
    let rig = rig(&tall, 13.0, "");
    let mut stand = homed(&rig, 2.0);
    stand.wait(3.0).unwrap();
    assert!(!stand.faults().any(), "{:?}", stand.faults());
    let [pretension_n, wanted_n] = [
        f64::from(stand.telemetry.unwrap().pretension_n),
        rig.pretension_n,
    ];
    assert!((pretension_n - wanted_n).abs() < 0.1, "{pretension_n} N");
}

/// Its swing decays slowly: averaged after 1.5 s, the zero is off by 0.12 mm.
#[test]
fn a_long_leg_finds_its_zero() {
    for (centroid, settle_s) in [("centroid_mm = 150", 4.0), ("centroid_mm = 211", 8.0)] {
        let long = READY_RIGS[0].text.replace("centroid_mm = 91", centroid);
        let rig = RigFile::parse("long", &with_stiffness(&long, 3e5)).unwrap();
        let off_mm = zero_off_mm(&rig);
        println!("{centroid}: {off_mm:.4} mm");
        assert!((rig.gains.homing.settle_time_s - settle_s).abs() < 0.2);
        assert!(off_mm < ZERO_MM, "{centroid}: {off_mm} mm");
    }
}
