use super::{MotionState, Quintic};
use crate::control::TICK_S;
use crate::control::segment::{Knot, Segment};

const TIME_S: f64 = 0.7;

const START: MotionState<f64> = MotionState {
    position: [0.1, -0.2],
    rate: [0.5, 0.3],
    acceleration: [-2.0, 1.0],
};

const END: MotionState<f64> = MotionState {
    position: [0.25, 0.05],
    rate: [-0.4, 0.2],
    acceleration: [1.5, -3.0],
};

fn require_near(found: [f64; 2], expected: [f64; 2], within: f64) {
    for (found, expected) in found.iter().zip(expected) {
        assert!((found - expected).abs() < within, "{found} {expected}");
    }
}

fn require_motion(found: &MotionState<f64>, expected: &MotionState<f64>) {
    require_near(found.position, expected.position, 1e-6);
    require_near(found.rate, expected.rate, 1e-6);
    require_near(found.acceleration, expected.acceleration, 1e-5);
}

#[test]
fn a_path_goes_from_one_motion_to_another() {
    let path = Quintic::connect(&START, &END, TIME_S);
    require_motion(&path.motion(0.0), &START);
    require_motion(&path.motion(1.0), &END);
    let path = Quintic::new(&START, END.position, TIME_S);
    require_motion(&path.motion(0.0), &START);
    require_motion(&path.motion(1.0), &MotionState::resting(END.position));
}

/// Each derivative is the change of the one before.
#[test]
fn the_derivatives_are_those_of_the_path() {
    let path = Quintic::connect(&START, &END, TIME_S);
    let step = 1e-5;
    let slope = |before: [f64; 2], after: [f64; 2]| {
        [0, 1].map(|i| (after[i] - before[i]) / (2.0 * step * TIME_S))
    };
    for part in [0.1, 0.35, 0.6, 0.9] {
        let [before, after] = [part - step, part + step].map(|part| path.motion(part));
        let now = path.motion(part);
        require_near(now.position, path.position(part), 1e-12);
        require_near(now.rate, slope(before.position, after.position), 1e-5);
        require_near(now.acceleration, slope(before.rate, after.rate), 1e-5);
        let squares = path.squares(part);
        let jerk = slope(before.acceleration, after.acceleration);
        for (found, pair) in [
            (squares.rate, now.rate),
            (squares.acceleration, now.acceleration),
            (squares.jerk, jerk),
        ] {
            let expected = pair[0] * pair[0] + pair[1] * pair[1];
            assert!((found - expected).abs() < 1e-5 * expected, "{part}");
        }
    }
}

/// Means of neighbours, taken five times over, lead from the control points to the path.
#[test]
fn the_control_points_are_those_of_the_path() {
    let path = Quintic::connect(&START, &END, TIME_S);
    for part in [0.0, 0.2, 0.5, 0.8, 1.0] {
        let found = path.control_points().map(|mut points| {
            for last in (1..6).rev() {
                for i in 0..last {
                    points[i] += part * (points[i + 1] - points[i]);
                }
            }
            points[0]
        });
        require_near(found, path.position(part), 1e-6);
    }
}

/// At the part s of the time T, the rate is (1 − s)³((1 + 3s)v + s·aT).
#[test]
fn a_leg_comes_to_rest_without_turning_back() {
    let path = Quintic::new(&START, START.rest_after(TIME_S).position, TIME_S);
    for part in [0.0, 0.25, 0.5, 0.75, 1.0] {
        let left: f64 = 1.0 - part;
        let expected = [0, 1].map(|i| {
            let asked = (1.0 + 3.0 * part) * START.rate[i];
            left * left * left * (asked + part * START.acceleration[i] * TIME_S)
        });
        require_near(path.motion(part).rate, expected, 1e-6);
    }
}

/// Ticks go round.
#[test]
fn a_segment_takes_the_time_between_its_knots() {
    for tick in [0, u32::MAX - 100] {
        let [from, to] = [(tick, START), (tick.wrapping_add(800), END)]
            .map(|(tick, motion)| Knot { tick, motion });
        let segment = Segment::connect(&from, &to);
        assert_eq!(segment.ticks, 800);
        let time_s = 800.0 * f64::from(TICK_S);
        assert!((segment.path.duration_s() - time_s).abs() < 1e-6);
        require_motion(&segment.path.motion(1.0), &END);
    }
}
