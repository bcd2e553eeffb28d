//! What a simulation tells apart: commanded, reference, estimated and true.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use leg_rig::rig_file::RigFile;
use leg_sim::link::InProcess;
use leg_sim::scenario::Scenario;
use leg_sim::simulation::{Comparison, Simulation, Summary};

fn run(steps: &str) -> Summary {
    let text = format!(
        "title = \"comparison\"\nsteps = [\n\
         {{ await = {{ state = \"disarmed\", timeout_s = 1 }} }}, \"arm\", {{ wait_s = 0.5 }},\n{steps}\n]\n"
    );
    let scenario = Scenario::parse("comparison", &text).unwrap();
    let simulation = Simulation::new(&scenario, &RigFile::load(None).unwrap()).unwrap();
    let summary = simulation.run(&mut InProcess::new(), &mut |_| ()).unwrap();
    assert!(summary.passes(), "{:?}", summary.measurements);
    summary
}

fn distance_mm(a: [f64; 3], b: [f64; 3]) -> f64 {
    let squares = a.iter().zip(b).map(|(a, b)| (a - b).powi(2));
    squares.sum::<f64>().sqrt()
}

/// How far the estimate, the reference and the command are from the truth, mm.
fn errors_mm(comparison: &Comparison) -> [f64; 3] {
    [
        comparison.tip_estimated_mm,
        comparison.tip_reference_mm,
        comparison.tip_commanded_mm,
    ]
    .map(|tip_mm| distance_mm(tip_mm, comparison.tip_true_mm))
}

/// A leg that compensates nothing sags: its reference is where it was sent, its estimate is where it is.
#[test]
fn a_leg_that_sags_knows_where_it_is() {
    let summary = run(
        "{ compensation = \"off\" }, { payload = { kg = 1, over_s = 0.3 } }, { wait_s = 1 },\n\
         { move = { azimuth_deg = 30, tilt_deg = 20 } }, { arrive = { then_s = 2, timeout_s = 5 } },",
    );
    let sampled = &summary.samples;
    let last = &sampled.last().unwrap().comparison;
    let [estimated, reference, commanded] = errors_mm(last);
    assert!(estimated < 0.1, "{last:?}");
    assert!(reference > 2.0, "{last:?}");
    assert!((reference - commanded).abs() < 0.01, "{last:?}");
    assert!((last.payload_true_kg - 1.0).abs() < 1e-9, "{last:?}");
    // On the way the command is ahead of the reference.
    let ahead = sampled.iter().any(|sample| {
        let comparison = &sample.comparison;
        let [_, reference, commanded] = errors_mm(comparison);
        commanded > 50.0 && reference < 5.0
    });
    assert!(ahead);
    assert!(
        sampled
            .iter()
            .all(|sample| sample.comparison.path_error_mm.is_none())
    );
}

/// What a leg itself reports tells apart where it was sent, where its trajectory has it now, and where it is: by a move, a hold and a
/// stiffness.
#[test]
fn a_report_says_what_was_commanded() {
    let summary = run(
        "{ stiffness = { nm_per_rad = 90 } }, { move = { azimuth_deg = 0, tilt_deg = 30 } }, { wait_s = 0.4 },\n\
         \"hold\", { wait_s = 1 }, { pretension_n = 60 }, { move = { azimuth_deg = 90, tilt_deg = 10 } },\n\
         { arrive = { then_s = 0.5, timeout_s = 5 } },",
    );
    let samples = &summary.samples;
    let told = |at_s: f64| {
        samples
            .iter()
            .map(|sample| &sample.telemetry)
            .find(|told| f64::from(told.tick) >= 8000.0 * at_s)
    };
    let first = told(0.4).unwrap();
    assert_eq!(first.commanded, first.target, "nothing was commanded yet");
    assert_eq!(first.stiffness_commanded_nm_per_rad, None);
    let moved: Vec<_> = samples
        .iter()
        .map(|sample| &sample.telemetry)
        .filter(|told| (told.commanded[0] - 0.5).abs() < 1e-6)
        .collect();
    assert!(
        moved.iter().any(|told| told.target[0] < 0.1 && told.moving),
        "on the way"
    );
    assert!(
        moved
            .iter()
            .all(|told| told.stiffness_commanded_nm_per_rad == Some(90.0)
                && told.pretension_commanded_n.is_none())
    );
    let held = told(f64::from(moved.last().unwrap().tick) / 8000.0 + 0.9).unwrap();
    assert_eq!(held.commanded, held.target, "a hold leaves the reference");
    assert!((0.01..0.45).contains(&held.target[0]), "{held:?}");
    let last = &samples.last().unwrap().telemetry;
    assert_eq!(
        (
            last.pretension_commanded_n,
            last.stiffness_commanded_nm_per_rad
        ),
        (Some(60.0), None)
    );
    let sent = [0.0, f64::to_radians(10.0).sin()];
    for (axis, sent) in sent.into_iter().enumerate() {
        let off =
            [last.commanded, last.target, last.pose].map(|at| (f64::from(at[axis]) - sent).abs());
        assert!(off[0] < 1e-6 && off[1] < 1e-5 && off[2] < 1e-3, "{off:?}");
    }
}

/// Along a path the command is the path: the chart's error is that of the measurement.
#[test]
fn the_error_along_a_path_is_that_of_its_measurement() {
    let summary = run(
        "{ circle = { tilt_deg = 10, period_s = 4, turns = 0.5, points_per_s = 100 } },\n\
         { measure = { name = \"error\", quantity = \"follow_error_mm\", between = [0, 0.3] } },",
    );
    let along: Vec<f64> = summary
        .samples
        .iter()
        .filter_map(|sample| sample.comparison.path_error_mm)
        .collect();
    assert!((900..1100).contains(&along.len()), "{}", along.len());
    let highest = along.iter().copied().fold(0.0, f64::max);
    let measured = summary.measurements[0].value;
    assert!(
        highest <= measured + 1e-9 && highest > 0.9 * measured,
        "{highest} {measured}"
    );
    for sample in summary
        .samples
        .iter()
        .filter(|sample| sample.comparison.path_error_mm.is_some())
    {
        let [estimated, reference, commanded] = errors_mm(&sample.comparison);
        let errors_mm = [estimated, reference, commanded];
        assert!(
            errors_mm.iter().all(|mm| *mm < 0.3),
            "{:?}",
            sample.comparison
        );
        assert!((commanded - sample.comparison.path_error_mm.unwrap()).abs() < 1e-9);
    }
}
