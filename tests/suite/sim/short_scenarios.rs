//! What is lost where a scenario ends soon: answers in its last step, and all that takes no time.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use super::ready_runs::run;
use leg_sim::link::InProcess;
use leg_sim::scenario::Scenario;
use leg_sim::simulation::Summary;

fn ended(steps: &str) -> Summary {
    let text = format!("title = \"Soon over\"\nsteps = [{steps}]\n");
    let scenario = Scenario::parse("short", &text).unwrap();
    run(&scenario, &mut InProcess::new()).summary
}

/// The commands that were refused.
fn refused(summary: &Summary) -> Vec<&'static str> {
    summary.refused.iter().map(|one| one.command).collect()
}

/// A leg that stops on its way brakes first, and executes no command meanwhile.
#[test]
fn a_refusal_after_the_brake_of_the_last_step_is_told() {
    let summary = ended(
        r#"{ await = { state = "disarmed", timeout_s = 1 } }, "arm", { wait_s = 0.5 },
        { move = { azimuth_deg = 30, tilt_deg = 10 } }, { wait_s = 0.3 }, "stop", "arm""#,
    );
    assert_eq!(refused(&summary), ["arm"]);
    // Two commands are answered within 0.02 s by a leg that does not brake.
    let arm = &summary.refused[0];
    let ended_s = summary.ticks as f64 / 8000.0;
    assert!(ended_s - arm.at_s > 0.05, "{ended_s} {arm:?}");
}

#[test]
fn commands_alone_are_answered() {
    let summary = ended(r#""home", "arm""#);
    assert!(summary.ticks > 1, "{}", summary.ticks);
    assert!(!summary.refused.is_empty());
}

#[test]
fn a_scenario_without_time_lasts_a_tick() {
    let summary = ended("{ emergency_stop = true }");
    assert_eq!(summary.ticks, 1);
}

#[test]
fn a_push_in_the_first_step_is_measured() {
    let summary = ended(
        r#"{ push_test = { name = "push", azimuth_deg = 40, force_n = 1.5, settle_s = 1, nm_per_rad = 60, within_percent = 99 } }"#,
    );
    let [push] = summary.measurements.as_slice() else {
        panic!("{:?}", summary.measurements);
    };
    assert!(push.value.is_finite(), "{push:?}");
}
