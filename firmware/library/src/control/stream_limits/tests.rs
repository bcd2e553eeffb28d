#![allow(clippy::unwrap_used, reason = "a test may panic")]

use super::{StreamLimits, differences};
use crate::control::CYCLE_S;
use crate::control::quintic::{MotionState, Peaks, Quintic};
use crate::set_point::{MotionLimit, PointRefusal, SetPoint, StreamPart};
use crate::settings::Settings;

/// What no path of these tests comes to.
const NONE: f64 = 1e9;

fn limits(rate: f64, acceleration: f64, jerk: f64) -> StreamLimits<f64> {
    StreamLimits {
        peaks: Peaks {
            rate,
            acceleration,
            jerk,
        },
        ..StreamLimits::new(&Settings::table_1().unwrap())
    }
}

/// From rest to rest through the middle, in a direction of its own.
fn crossing(distance: f64, time_s: f64) -> Quintic<f64> {
    let end = [0.3, 0.4].map(|part| part * distance);
    let start = MotionState::resting(end.map(|x: f64| -x));
    Quintic::new(&start, end, time_s)
}

/// The hulls of a path over a distance d from rest to rest in a time T are 5d/T, 20d/T² and 120d/T³ wide.
#[test]
fn a_path_that_is_too_fast_is_refused_by_the_limit_that_it_leaves() {
    let (distance, time_s) = (0.1, 0.5);
    let rate = 5.0 * distance / time_s;
    let bend = 20.0 * distance / (time_s * time_s);
    let jerk = 120.0 * distance / (time_s * time_s * time_s);
    let path = crossing(distance, time_s);
    for (part, kept) in [(1.001, true), (0.999, false)] {
        for (limits, limit) in [
            (limits(part * rate, NONE, NONE), MotionLimit::Speed),
            (limits(NONE, part * bend, NONE), MotionLimit::Acceleration),
            (limits(NONE, NONE, part * jerk), MotionLimit::Jerk),
        ] {
            let expected = if kept {
                Ok(())
            } else {
                Err(PointRefusal::Limit(limit))
            };
            assert_eq!(limits.keeps(&path), expected, "{part}");
        }
    }
}

/// From a steady motion it comes to rest ever more slowly; one that speeds up goes on to do so at first.
#[test]
fn a_motion_that_comes_to_rest_too_fast_is_refused() {
    let limits = StreamLimits::<f64>::new(&Settings::table_1().unwrap());
    let Peaks {
        rate, acceleration, ..
    } = limits.peaks;
    let too_fast = Err(PointRefusal::Limit(MotionLimit::Speed));
    for (part, acceleration, expected) in [
        (0.99, 0.0, Ok(())),
        (1.01, 0.0, too_fast),
        (0.99, acceleration, too_fast),
    ] {
        let motion = MotionState {
            rate: [part * rate, 0.0],
            acceleration: [acceleration, 0.0],
            ..MotionState::resting([0.0; 2])
        };
        assert_eq!(
            limits.keeps_to_rest(&motion),
            expected,
            "{part} {acceleration}"
        );
    }
}

#[test]
fn a_path_out_of_reach_is_refused() {
    let limits = limits(NONE, NONE, NONE);
    let reach = limits.reach_square.sqrt();
    for (part, expected) in [(0.999, Ok(())), (1.001, Err(PointRefusal::OutOfReach))] {
        // Half of the distance is on either side.
        let path = crossing(2.0 * part * reach, 0.5);
        assert_eq!(limits.keeps(&path), expected, "{part}");
    }
}

/// At both ends, the outer differences are the derivatives themselves but for their factors.
#[test]
fn the_differences_are_those_of_the_derivatives() {
    let [start, end] = [(0.1, 0.5, -2.0), (0.3, -0.4, 1.5)].map(|(q, v, a)| MotionState {
        position: [q, 0.0],
        rate: [v, 0.0],
        acceleration: [a, 0.0],
    });
    let time_s = 0.7;
    let path = Quintic::connect(&start, &end, time_s);
    let [points, _] = path.control_points();
    let [first, second, third] = differences(&points);
    let jerk = |part: f64| {
        let step = 1e-6;
        let [before, after] = [part - step, part + step].map(|part| path.motion(part));
        (after.acceleration[0] - before.acceleration[0]) / (2.0 * step * time_s)
    };
    for (found, expected) in [
        (5.0 * first[0], 0.5 * time_s),
        (5.0 * first[4], -0.4 * time_s),
        (20.0 * second[0], -2.0 * time_s * time_s),
        (20.0 * second[3], 1.5 * time_s * time_s),
        (60.0 * third[0], jerk(0.0) * time_s * time_s * time_s),
        (60.0 * third[2], jerk(1.0) * time_s * time_s * time_s),
        // In the middle, the third derivative is the mean of its points, the inner one counted twice.
        (
            15.0 * (third[0] + 2.0 * third[1] + third[2]),
            jerk(0.5) * time_s * time_s * time_s,
        ),
    ] {
        assert!((found - expected).abs() < 1e-4, "{found} {expected}");
    }
}

/// Rate and acceleration in half-tangent coordinates are the changes of where a set-point goes on to.
#[test]
fn a_set_point_is_a_motion_in_half_tangents() {
    let limits = limits(NONE, NONE, NONE);
    let (p, v, a) = ([0.15, -0.2], [0.4, 0.3], [1.0, -2.0]);
    let motion = limits
        .motion(&SetPoint {
            part: StreamPart::First,
            tick: 0,
            direction: p.map(|x| x as f32),
            rate: v.map(|x| x as f32),
            acceleration: Some(a.map(|x| x as f32)),
            tension: None,
        })
        .unwrap();
    let at = |time_s: f64| {
        let [x, y] = [0, 1].map(|i: usize| p[i] + time_s * (v[i] + 0.5 * time_s * a[i]));
        let w: f64 = 1.0 / (1.0 + (1.0 - x * x - y * y).sqrt());
        [w * x, w * y]
    };
    let step_s = 1e-4;
    let [before, now, after] = [-step_s, 0.0, step_s].map(at);
    for i in 0..2 {
        let rate = (after[i] - before[i]) / (2.0 * step_s);
        let acceleration = (after[i] - 2.0 * now[i] + before[i]) / (step_s * step_s);
        assert!((motion.position[i] - now[i]).abs() < 1e-6);
        assert!((motion.rate[i] - rate).abs() < 1e-5);
        assert!((motion.acceleration[i] - acceleration).abs() < 1e-4);
    }
}

/// Whatever a leg does within its limits, it comes to rest within them, and in no more time than that takes.
#[test]
fn a_leg_comes_to_rest_within_its_limits() {
    let limits = StreamLimits::<f64>::new(&Settings::table_1().unwrap());
    let peaks = limits.peaks;
    for (rate, acceleration) in [(1.0, 0.0), (0.5, 1.0), (0.5, -1.0), (0.1, 0.5), (0.0, 1.0)] {
        let motion = MotionState {
            position: [0.0; 2],
            rate: [0.6, 0.8].map(|part| part * rate * peaks.rate),
            acceleration: [1.0, 0.0].map(|part| part * acceleration * peaks.acceleration),
        };
        let path = limits.rest_segment(&motion).path;
        for i in 0..=100 {
            let squares = path.squares(f64::from(i) / 100.0);
            let most = |limit: f64| 1.0001 * limit * limit;
            assert!(squares.acceleration <= most(peaks.acceleration));
            assert!(squares.jerk <= most(peaks.jerk), "{rate} {acceleration}");
        }
        let end = path.motion(1.0);
        assert!(end.rate.iter().all(|rate| rate.abs() < 1e-5));
    }
    // Without a limit of the jerk, the time is the rate over 0.45 of the acceleration, in whole cycles.
    let limits = self::limits(1.0, 2.0, NONE);
    let motion = MotionState {
        position: [0.0; 2],
        rate: [0.0, 0.9],
        acceleration: [0.0; 2],
    };
    let time_s = limits.rest_segment(&motion).path.duration_s();
    let least_s = 0.9 / (0.45 * 2.0);
    let late_s = time_s - least_s;
    assert!(
        (-1e-6..2.0 * f64::from(CYCLE_S)).contains(&late_s),
        "{time_s} s"
    );
}
