//! Every ready scenario, in this process. Under QEMU: `board::bits_under_qemu`.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use super::ready_runs::{Run, ready, require_shadow, run, scenario};
use crate::common::require_said;
use leg_bench::sensitivity;
use leg_boards::image::workspace_root;
use leg_firmware::supervisor::{Fault, Reaction, State};
use leg_firmware_bench::protocol::{Reply, Request};
use leg_rig::ready_rigs::READY_RIGS;
use leg_rig::rig_file::RigFile;
use leg_sim::link::{InProcess, Link, LinkError};
use leg_sim::plant::Defect;
use leg_sim::ready_scenarios::{self, READY_SCENARIOS};
use leg_sim::scenario::{BOARD_EXCEPTIONS, Measurand, Scenario, Step, TestStep};
use leg_sim::shadow::OTHER_TICKS_MAX;
use leg_sim::simulation::Simulation;
use std::fs;

#[test]
fn every_ready_scenario_passes() {
    // From the last one on: another test begins with the first.
    for scenario in READY_SCENARIOS.iter().rev() {
        let summary = &ready(scenario.name).summary;
        let failed: Vec<_> = summary
            .measurements
            .iter()
            .filter(|measurement| !measurement.passes())
            .collect();
        assert!(failed.is_empty(), "{}: {failed:?}", scenario.name);
        assert_eq!(summary.stopped, None, "{}", scenario.name);
        require_shadow(summary, scenario.name);
        let unexpected = &summary.unexpected;
        assert!(unexpected.is_empty(), "{}: {unexpected:?}", scenario.name);
        assert!(
            !summary.measurements.is_empty(),
            "{} measures nothing",
            scenario.name
        );
    }
}

/// An error is judged from above: a leg that is better than expected passes. What a leg sags that leaves its load out is none.
#[test]
fn no_error_is_too_small() {
    let mut errors = 0;
    for scenario in READY_SCENARIOS {
        for measurement in &ready(scenario.name).summary.measurements {
            let is_error = matches!(
                measurement.quantity,
                Some(Measurand::TipErrorMm | Measurand::HomingErrorMm | Measurand::FollowErrorMm)
            );
            if is_error && measurement.compensated {
                assert!(
                    measurement.between[0] <= 0.0,
                    "{}: {measurement:?}",
                    scenario.name
                );
                errors += 1;
            }
        }
    }
    assert!(errors > 40, "{errors}");
}

/// The scenario of a fault waits for the fault and the state that its reaction leads to.
#[test]
fn every_fault_has_a_scenario_that_raises_it() {
    let mut raised: Vec<Fault> = Vec::new();
    for ready in READY_SCENARIOS {
        for step in scenario(ready.name).steps {
            if let Step::Test(TestStep::Reaction { fault, .. }) = step {
                raised.push(fault);
            }
        }
    }
    for fault in Fault::ALL {
        assert!(raised.contains(&fault), "no scenario raises {fault:?}");
    }
}

/// The law in f32 stays near to its shadow in f64 while nothing fails.
#[test]
fn the_shadow_in_f64_stays_near() {
    for name in ["fig9", "homing", "tour", "stiffness", "payload"] {
        let divergence = ready(name).summary.divergence;
        assert_eq!(divergence.other_state, 0, "{name}");
        // Tendons that come taut may do so a cycle apart, 5 mm/s for half a millisecond, and motors may cross the play of their
        // gears, 2.4 µm, a cycle apart.
        assert!(divergence.reference_m < 6e-6, "{name}: {divergence:?}");
        assert!(divergence.pose < 2e-5, "{name}: {divergence:?}");
        assert!(divergence.reference_m > 0.0, "{name}: nothing was compared");
    }
}

/// A firmware that says from a tick on that it is in another state than the law leads to, for so many ticks.
struct Astray {
    firmware: InProcess,
    tick: u64,
    ticks: u64,
}

impl Link for Astray {
    fn ask(&mut self, request: &Request) -> Result<Reply, LinkError> {
        let mut reply = self.firmware.ask(request)?;
        if let Reply::Ticked(ticked) = &mut reply {
            self.tick += 1;
            if (1000..1000 + self.ticks).contains(&self.tick) {
                ticked.telemetry.state = State::Held;
            }
        }
        Ok(reply)
    }
}

/// Where all else is well, a run that the shadow does not follow fails.
#[test]
fn a_run_whose_shadow_leaves_the_firmwares_state_does_not_pass() {
    let text = "title = \"waits\"\nsteps = [{ wait_s = 0.2 }]";
    let scenario = Scenario::parse("waits", text).unwrap();
    for (ticks, passes) in [
        (0, true),
        (OTHER_TICKS_MAX, true),
        (OTHER_TICKS_MAX + 1, false),
        (400, false),
    ] {
        let mut link = Astray {
            firmware: InProcess::new(),
            tick: 0,
            ticks,
        };
        let summary = run(&scenario, &mut link).summary;
        assert_eq!(summary.divergence.other_state, ticks);
        assert_eq!(summary.passes(), passes, "{ticks} ticks");
    }
}

/// The figure of `leg run --errors`: what cells and curves that are off cost.
#[test]
fn cells_and_curves_that_are_off_move_the_tip_by_as_much_as_is_said() {
    let largest_mm = |cell_percent: f64, curve_percent: f64| {
        let scenario = scenario("support").with_errors(cell_percent, curve_percent);
        let run = run(&scenario, &mut InProcess::new());
        require_shadow(&run.summary, "support");
        sensitivity::largest_mm(&run.summary).unwrap()
    };
    let (exact, cells, curves) = (
        largest_mm(0.0, 0.0),
        largest_mm(1.0, 0.0),
        largest_mm(0.0, 2.0),
    );
    assert!(exact < 0.03, "{exact}");
    assert!(cells > 2.0 * exact && cells < 0.2, "{cells}");
    assert!(curves > 2.0 * exact && curves < 0.2, "{curves}");
}

/// How far the tip may swing when a tendon is cut, mm.
const CUT_SWING_MM: f64 = 250.0;

/// Wherever the leg leans and whatever it carries, when a tendon is cut it swings no farther than SAFETY.md says.
#[test]
fn a_cut_tendon_lets_the_tip_swing_no_farther_than_is_said() {
    let ready = ready_scenarios::named("fault_tension_jump").unwrap().text;
    let (steps, _) = ready.split_once("[start.held]").unwrap();
    let mut swings_mm = Vec::new();
    for tendon in 1..=3 {
        for azimuth in (0..360).step_by(40) {
            for (tilt, payload) in [(0, 0.0), (15, 1.0), (30, 0.0), (30, 1.0), (30, 2.0)] {
                let text = |steps: &str| {
                    format!(
                        "{}\n[start.held]\nazimuth_deg = {azimuth}\ntilt_deg = {tilt}\npretension_n = 70\npayload_kg = {payload}\n",
                        steps.replace("tendon_cut = 1", &format!("tendon_cut = {tendon}"))
                    )
                };
                let rig = RigFile::load(None).unwrap();
                // A tendon that pulled little is found slack.
                let found_slack = steps.replace(
                    "fault = \"tension_jump\", state = \"held\", within_ms = 2",
                    "fault = \"slack\", state = \"held\", within_ms = 60",
                );
                let swing = |text: &String| {
                    let scenario = Scenario::parse("cut", text).unwrap();
                    // A pose that its payload does not allow at the pretension is no start.
                    let simulation = Simulation::new(&scenario, &rig).ok()?;
                    let link = &mut InProcess::new();
                    let summary = simulation.run(link, &mut |_| ()).unwrap();
                    require_shadow(&summary, text);
                    let moved = summary.measurements.iter().find(|found| found.unit == "mm");
                    Some(moved.map(|moved| moved.value))
                };
                // Or by lengths and tensions that do not agree.
                let found_apart = found_slack.replace("fault = \"slack\"", "fault = \"residual\"");
                let texts = [text(steps), text(&found_slack), text(&found_apart)];
                let Some(by_jump) = swing(&texts[0]) else {
                    continue;
                };
                let later = || texts[1..].iter().find_map(|text| swing(text).flatten());
                let moved_mm = by_jump.or_else(later);
                let [text, ..] = texts;
                assert!(moved_mm.is_some(), "neither fault came:\n{text}");
                swings_mm.push((moved_mm.unwrap(), text));
            }
        }
    }
    assert!(swings_mm.len() > 100, "{} starts", swings_mm.len());
    let (farthest, text) = swings_mm.iter().max_by(|a, b| a.0.total_cmp(&b.0)).unwrap();
    assert!(
        (200.0..CUT_SWING_MM).contains(farthest),
        "{farthest} mm:\n{text}"
    );
    let said = format!("the tip of the paper's leg may swing by up to {CUT_SWING_MM} mm");
    require_said("firmware/SAFETY.md", &[said]);
}

/// Wherever the leg leans and whatever it carries, a disarm leads it down, and its tip sags no farther than SAFETY.md says when its
/// tendons are paid out; so does that of every ready rig. One whose sensors are not watched yet, 0.05 s after the arm, is paid out
/// where it is, and sags farther.
#[test]
fn a_disarmed_leg_sags_no_farther_than_is_said() {
    const LED_DOWN_MM: f64 = 2.0;
    const PAID_OUT_MM: f64 = 130.0;
    // A ball joint lets the leg twist as it sags.
    const OTHERS_MM: f64 = 3.0;
    let sags = |rig: &str, [before, after]: [&str; 2], azimuth: u32, tilt: u32, payload: f64| {
        let text = format!(
            r#"
title = "disarm"
steps = [
    {{ await = {{ state = "disarmed", timeout_s = 1 }} }},
    "arm",
    {before}
    "disarm",
    {after}
    {{ await = {{ state = "disarmed", timeout_s = 20 }} }},
    {{ wait_s = 1 }},
    {{ measure = {{ name = "sag", quantity = "tip_moved_mm", between = [0, 1000] }} }},
]
[start.held]
azimuth_deg = {azimuth}
tilt_deg = {tilt}
pretension_n = 70
payload_kg = {payload}
"#
        );
        let scenario = Scenario::parse("disarm", &text).unwrap();
        // A pose that its payload does not allow at the pretension is no start.
        let rig = RigFile::load(Some(rig.as_ref())).unwrap();
        let simulation = Simulation::new(&scenario, &rig).ok()?;
        let summary = simulation.run(&mut InProcess::new(), &mut |_| ()).unwrap();
        require_shadow(&summary, &text);
        let sag = summary.measurements.iter().find(|found| found.unit == "mm");
        Some(sag.unwrap().value)
    };
    let down = [
        "{ wait_s = 0.5 },",
        "{ await = { state = \"ramping_down\", timeout_s = 10 } }, \"mark\",",
    ];
    let at_once = ["{ wait_s = 0.05 }, \"mark\",", ""];
    let mut farthest_mm = [0.0_f64; 2];
    let mut starts = 0;
    for azimuth in (0..360).step_by(60) {
        for (tilt, payload) in [(0, 1.0), (20, 1.0), (30, 0.0), (30, 1.0), (30, 2.0)] {
            for (farthest, around) in farthest_mm.iter_mut().zip([down, at_once]) {
                if let Some(sag_mm) = sags("table1", around, azimuth, tilt, payload) {
                    *farthest = farthest.max(sag_mm);
                    starts += 1;
                }
            }
        }
    }
    assert!(starts > 50, "{starts} starts");
    let others = READY_RIGS.iter().map(|rig| rig.name);
    for rig in others.filter(|name| *name != "table1") {
        let mut starts = 0;
        for (azimuth, tilt, payload) in
            [(20, 8, 2.0), (100, 8, 0.0), (160, 24, 1.0), (250, 24, 0.0)]
        {
            if let Some(sag_mm) = sags(rig, down, azimuth, tilt, payload) {
                assert!(
                    sag_mm <= OTHERS_MM,
                    "{rig}, {azimuth}°, {tilt}°, {payload} kg: {sag_mm} mm"
                );
                starts += 1;
            }
        }
        assert!(starts > 1, "{rig}: {starts} starts");
    }
    let [led_down, paid_out] = farthest_mm;
    assert!(led_down <= LED_DOWN_MM, "{led_down} mm");
    assert!(paid_out <= PAID_OUT_MM, "{paid_out} mm");
    let page = fs::read_to_string(workspace_root().join("firmware/SAFETY.md")).unwrap();
    for words in [
        format!("sags by less than {LED_DOWN_MM} mm ({OTHERS_MM} mm on the other ready rigs)"),
        format!("by up to {PAID_OUT_MM} mm"),
    ] {
        assert!(page.contains(&words), "{words}");
    }
}

/// Wherever the leg leans and whatever it carries, an arm leaves its tip where it is.
#[test]
fn a_leg_is_armed_where_it_stands() {
    let steps = ready_scenarios::named("arm_lean").unwrap().text;
    let (steps, _) = steps.split_once("[start.held]").unwrap();
    let steps = steps.replace("wait_s = 3", "wait_s = 1");
    let rig = RigFile::load(None).unwrap();
    let mut starts = 0;
    for azimuth in (0..360).step_by(60) {
        for (tilt, payload, pretension) in [(20, 1, 110), (30, 1, 70), (30, 2, 65), (30, 2, 70)] {
            let text = format!(
                "{steps}\n[start.held]\nazimuth_deg = {azimuth}\ntilt_deg = {tilt}\npretension_n = {pretension}\npayload_kg = {payload}\n"
            );
            let scenario = Scenario::parse("arm", &text).unwrap();
            // A pose that its payload does not allow at the pretension is no start.
            let Ok(simulation) = Simulation::new(&scenario, &rig) else {
                continue;
            };
            starts += 1;
            let summary = simulation.run(&mut InProcess::new(), &mut |_| ()).unwrap();
            require_shadow(&summary, &text);
            let moved = summary.measurements.iter().find(|found| found.unit == "mm");
            let moved_mm = moved.unwrap().value;
            assert!(moved_mm < 0.5, "{moved_mm} mm:\n{text}");
            let stops = |(fault, _): &(Fault, f64)| fault.reaction() != Reaction::Limit;
            assert!(
                !summary.faults.iter().any(stops),
                "{:?}:\n{text}",
                summary.faults
            );
        }
    }
    assert!(starts > 18, "{starts} starts");
}

/// A step that does not end stops a scenario, and what came out until then is kept.
#[test]
fn what_came_out_before_a_step_that_never_ends_is_kept() {
    let text = "title = \"never\"\nsteps = [{ wait_s = 0.1 }, { measure = { name = \"level\", quantity = \"pretension_n\", between = [0, 0] } }, { await = { state = \"held\", timeout_s = 0.1 } }]";
    let scenario = Scenario::parse("never", text).unwrap();
    let Run { summary, bits, .. } = run(&scenario, &mut InProcess::new());
    require_shadow(&summary, "never");
    let stopped = summary.stopped.clone().unwrap();
    assert!(
        stopped.starts_with("step 3: held did not come within 0.1 s"),
        "{stopped}"
    );
    assert_eq!(summary.measurements.len(), 1);
    assert!(summary.measurements[0].passes() && !summary.passes());
    assert!(bits.len() > 1600 && !summary.samples.is_empty());
}

#[test]
fn the_page_says_what_a_board_does_otherwise() {
    let page = workspace_root().join("host-tools/docs/scenarios.md");
    let page = fs::read_to_string(page).unwrap();
    for (scenarios, what, why) in BOARD_EXCEPTIONS {
        let row = format!("| {scenarios} | {what} | {why} |");
        assert!(page.contains(&row), "{row}");
    }
}

#[test]
fn the_page_lists_every_defect() {
    let page = workspace_root().join("host-tools/docs/scenarios.md");
    let page = fs::read_to_string(page).unwrap();
    let (_, table) = page
        .split_once("| fault | what happens |\n|---|---|\n")
        .unwrap();
    let rows: Vec<&str> = table
        .lines()
        .take_while(|row| row.starts_with('|'))
        .collect();
    let expected: Vec<String> = Defect::descriptions()
        .map(|(name, text)| format!("| `{name}` | {text} |"))
        .collect();
    assert_eq!(rows, expected, "\n{}", expected.join("\n"));
}
