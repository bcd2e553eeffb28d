#![allow(clippy::unwrap_used, reason = "a test may panic")]

use super::{evaluate_f64, grid, kernel_request, numbers, random, run_f64};
use crate::precision::{Part, evaluation_parts, kernel_parts};
use leg_firmware_bench::kernels::Kernel;
use leg_sim::link::{InProcess, Link};

fn count(parts: &[Part]) -> usize {
    parts.iter().map(|&(_, count)| count).sum()
}

#[test]
fn every_number_belongs_to_a_part() {
    let mut link = InProcess::new();
    for state in &random(21, 1) {
        let parts = count(&evaluation_parts(state.support));
        assert_eq!(evaluate_f64(state).unwrap().len(), parts);
        for kernel in Kernel::ALL {
            let parts = count(kernel_parts(kernel));
            let ran = numbers(&link.ask(&kernel_request(kernel, state)).unwrap()).unwrap();
            assert_eq!(ran.len(), parts, "{}", kernel.name());
            let expected = run_f64(kernel, state).unwrap();
            assert_eq!(expected.len(), parts, "{} in f64", kernel.name());
        }
    }
}

#[test]
fn random_states_are_equal_for_equal_seeds_and_feasible() {
    let states = random(300, 5);
    for (state, again) in states.iter().zip(random(300, 5)) {
        assert_eq!(state.pose(), again.pose());
        let evaluation = leg_model::evaluate(&state.rig(), &state.query().unwrap()).unwrap();
        for tension in evaluation.tensions_n {
            assert!((8.0..=150.0).contains(&tension), "{}", state.pose());
        }
    }
    assert_ne!(states[0].pose(), random(1, 6)[0].pose());
}

#[test]
fn the_grid_spans_the_workspace() {
    let grid = grid();
    assert_eq!(grid.len(), 24 * 7 * 4 * 7);
    let spans = |quantity: fn(&super::Pose) -> f64, min: f64, max: f64| {
        let values: Vec<f64> = grid.iter().map(|state| quantity(&state.pose())).collect();
        assert!(values.iter().all(|value| (min..=max).contains(value)));
        assert!(values.contains(&min) && values.contains(&max));
    };
    spans(|pose| pose.azimuth_deg.round(), 0.0, 345.0);
    spans(|pose| pose.tilt_deg.round(), 0.0, 30.0);
    spans(|pose| pose.payload_kg, 0.0, 2.0);
}
