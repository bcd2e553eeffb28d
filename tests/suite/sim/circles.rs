//! The streamed circle on other legs than that of its scenario.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use super::ready_runs::require_shadow;
use crate::common::unlike::{
    has_other_tendons, rigs_with_a_cell_off, rigs_with_a_cell_off_like,
    rigs_with_other_tendons_like, unlike_rigs, unlike_rigs_like,
};
use leg_firmware::supervisor::Fault;
use leg_model::evaluate;
use leg_rig::ready_rigs::READY_RIGS;
use leg_rig::rig_file::RigFile;
use leg_sim::link::InProcess;
use leg_sim::ready_scenarios;
use leg_sim::scenario::Scenario;
use leg_sim::simulation::Simulation;

/// What the estimate of the load is off by shall not end a feasible pretension, N.
const ROOM_N: f64 = 1.0;

/// What the turn of the leg adds to a tension, N: so near to the ends of the range the pretension may be out of reach on the way.
const END_N: f64 = 2.0;

/// Farthest off the circle, mm, and the most by which the tip may be behind it or ahead, ms.
const OFF_MM: f64 = 0.3;
const LAG_MS: f64 = 2.0;

/// Another ready rig for the legs unlike their settings: that which is farthest off the circle.
const OTHER_RIG: &str = "spherical";

/// A circle of a leg.
struct Circle<'a> {
    rig: &'a RigFile,
    payload_kg: f64,
    tilt_deg: f64,
}

impl<'a> Circle<'a> {
    fn new(rig: &'a RigFile, payload_kg: f64) -> Self {
        Self {
            rig,
            payload_kg,
            tilt_deg: (rig.tilt_deg - 1.0).min(20.0),
        }
    }

    /// The lowest, the middle and the highest pretension of all its poses and of straight down, N.
    fn pretensions_n(&self) -> [f64; 3] {
        let range = |azimuth_deg: f64, tilt_deg: f64| {
            let query = self.rig.query(azimuth_deg, tilt_deg, self.payload_kg);
            let found = evaluate(&self.rig.parameters, &query);
            found.unwrap().pretension_range_n
        };
        let poses = (0..72).map(|i| range(5.0 * f64::from(i), self.tilt_deg));
        let both = |a: [f64; 2], b: [f64; 2]| [a[0].max(b[0]), a[1].min(b[1])];
        let [low, high] = poses.fold(range(0.0, 0.0), both);
        let [low, high] = [low + ROOM_N, high - ROOM_N];
        assert!(low < high, "{} kg: {low} to {high} N", self.payload_kg);
        [low, 0.5 * (low + high), high]
    }

    fn scenario(&self, pretension_n: f64) -> Scenario {
        let (tilt_deg, payload_kg) = (self.tilt_deg, self.payload_kg);
        let text = ready_scenarios::named("circle").unwrap().text;
        let text = text
            .replace("tilt_deg = 20", &format!("tilt_deg = {tilt_deg}"))
            .replace("payload_kg = 1", &format!("payload_kg = {payload_kg}"))
            .replace(
                "pretension_n = 70",
                &format!("pretension_n = {pretension_n}"),
            );
        let text = if has_other_tendons(self.rig) {
            self.homed(&text, pretension_n)
        } else {
            text
        };
        // A scenario has errors of its own, in the place of the rig's.
        let plant = &self.rig.plant;
        let errors = format!(
            "[plant]\ncell_gain_error_percent = {:?}\ncurve_error_percent = {:?}\n",
            plant.cell_gain_error.map(|error| 100.0 * error),
            100.0 * plant.curve_error
        );
        Scenario::parse("circle", &[text, errors].concat()).unwrap()
    }

    /// The same of a leg that is homed first, and measures its tendons.
    fn homed(&self, text: &str, pretension_n: f64) -> String {
        let payload_kg = self.payload_kg;
        let homes = format!(
            r#""home", {{ await = {{ state = "active", timeout_s = 30 }} }}, {{ wait_s = 3 }},
            {{ payload = {{ kg = {payload_kg}, over_s = 0.5 }} }}, {{ pretension_n = {pretension_n} }}, {{ wait_s = 2 }},"#
        );
        let text = text.replace("\"arm\",", &homes);
        let (steps, _) = text.split_once("[start.held]").unwrap();
        let start = "[start.slack]\nslack_mm = 2\n";
        [steps, start].concat()
    }

    /// How far the tip is off it, mm, and by how much it is behind or ahead, ms. At the ends of the range the leg has the nearest pretension
    /// that is in reach.
    fn follow(&self, pretension_n: f64) -> [f64; 2] {
        let scenario = self.scenario(pretension_n);
        let mut rig = *self.rig;
        if !has_other_tendons(&rig) {
            rig.pretension_n = pretension_n;
        }
        let simulation = Simulation::new(&scenario, &rig).unwrap();
        let summary = simulation.run(&mut InProcess::new(), &mut |_| {}).unwrap();
        assert_eq!(summary.stopped, None);
        let [low, _, high] = self.pretensions_n();
        let at_end = pretension_n < low + END_N || pretension_n > high - END_N;
        let limits: &[Fault] = if at_end { &[Fault::Unreachable] } else { &[] };
        let mut faults = summary.unexpected.iter();
        assert!(
            faults.all(|fault| limits.contains(fault)),
            "{pretension_n} N: {:?}",
            summary.unexpected
        );
        require_shadow(&summary, "circle");
        [0, 1].map(|i| summary.measurements[i].value.abs())
    }
}

/// Follows a circle at each pretension, and gives what is beyond the bars, which are so many times as wide.
fn failures(name: &str, circle: &Circle<'_>, times: f64) -> Vec<String> {
    let followed = |pretension_n: f64| {
        let [off_mm, lag_ms] = circle.follow(pretension_n);
        let what = format!(
            "{name}, seed {}, {} kg, {pretension_n:.1} N: {off_mm:.3} mm, {lag_ms:.2} ms",
            circle.scenario(pretension_n).seed,
            circle.payload_kg
        );
        println!("{what}");
        let within = off_mm <= times * OFF_MM && lag_ms <= times * LAG_MS;
        (!within).then_some(what)
    };
    let pretensions_n = circle.pretensions_n().into_iter();
    pretensions_n.filter_map(followed).collect()
}

#[test]
fn a_circle_is_followed_with_any_support_payload_and_pretension() {
    let mut failed = Vec::new();
    for ready in READY_RIGS {
        let rig = RigFile::load(Some(ready.name.as_ref())).unwrap();
        for payload_kg in [0.0, 1.0, 2.0] {
            let circle = Circle::new(&rig, payload_kg);
            failed.extend(failures(ready.name, &circle, 1.0));
        }
    }
    assert!(failed.is_empty(), "{failed:#?}");
}

/// By one and a half of the bars, on the paper's rig and another one.
#[test]
fn a_leg_unlike_its_settings_follows_a_circle() {
    let mut failed = Vec::new();
    let paper = READY_RIGS[0].name;
    let papers = unlike_rigs()
        .chain(rigs_with_a_cell_off())
        .chain(rigs_with_other_tendons_like(paper));
    for (unlike, rig) in papers {
        let circle = Circle::new(&rig, 1.0);
        failed.extend(failures(&unlike, &circle, 1.5));
    }
    let others = unlike_rigs_like(OTHER_RIG)
        .chain(rigs_with_a_cell_off_like(OTHER_RIG))
        .chain(rigs_with_other_tendons_like(OTHER_RIG));
    for (unlike, rig) in others {
        let name = format!("{OTHER_RIG}, {unlike}");
        let circle = Circle::new(&rig, 1.0);
        failed.extend(failures(&name, &circle, 1.5));
    }
    assert!(failed.is_empty(), "{failed:#?}");
}
