//! Rows of a path as set-points.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use leg_base::timed_path::{PathRow, TimedPath, TimedPoint, check, run_up, way};
use leg_firmware::control::MotionState;
use leg_firmware::sensors::TICK_HZ;
use leg_firmware::set_point::{MotionLimit, PointRefusal, StreamPart, StreamTension};
use leg_firmware::settings::Settings;

const RADIUS: f64 = 0.3;
const PER_S: f64 = 1.3;

fn circle(time_s: f64) -> MotionState<f64> {
    let (sin, cos) = (PER_S * time_s).sin_cos();
    let [r, v, a] = [RADIUS, RADIUS * PER_S, RADIUS * PER_S * PER_S];
    MotionState {
        position: [r * cos, r * sin],
        rate: [-v * sin, v * cos],
        acceleration: [-a * cos, -a * sin],
    }
}

fn rows(times_s: &[f64]) -> Vec<PathRow> {
    let row = |&time_s: &f64| PathRow {
        time_s: 100.0 + time_s,
        direction: circle(time_s).position,
        tension: None,
    };
    times_s.iter().map(row).collect()
}

fn settings() -> Settings {
    Settings::table_1().unwrap()
}

/// How far position, rate and acceleration of a point are from the circle's.
fn deviation(point: &TimedPoint) -> [f64; 3] {
    let (found, expected) = (point.motion, circle(point.time_s));
    [
        (found.position, expected.position),
        (found.rate, expected.rate),
        (found.acceleration, expected.acceleration),
    ]
    .map(|([x, y], [u, v])| (x - u).hypot(y - v))
}

/// At the ends, too, and with times that are not even.
#[test]
fn points_have_the_rates_of_the_motion_through_the_rows() {
    let times_s: Vec<_> = (0..40)
        .map(|i| 0.02 * f64::from(i) + 0.003 * f64::from(i % 3))
        .collect();
    let path = TimedPath::new(&rows(&times_s));
    assert_eq!(path.points().len(), times_s.len());
    for (point, time_s) in path.points().iter().zip(times_s) {
        let [position, rate, acceleration] = deviation(point);
        assert!((point.time_s - time_s).abs() < 1e-9);
        assert!(
            position < 1e-12 && rate < 1e-6 && acceleration < 3e-4,
            "{point:?}"
        );
    }
}

#[test]
fn few_rows_are_a_path_too() {
    let two = TimedPath::new(&rows(&[0.0, 1.0]));
    for point in two.points() {
        assert_eq!(point.motion, MotionState::resting(point.motion.position));
    }
    for count in 1..8 {
        let times_s: Vec<_> = (0..count).map(f64::from).collect();
        assert_eq!(
            TimedPath::new(&rows(&times_s)).points().len(),
            times_s.len()
        );
    }
    let path = TimedPath::new(&rows(&[0.0, 0.1, 0.2, 0.3]));
    for time_s in [0.05, 0.15, 0.29] {
        let motion = path.motion(time_s).unwrap();
        let [position, ..] = deviation(&TimedPoint {
            time_s,
            motion,
            tension: None,
        });
        assert!(position < 1e-5, "{position}");
    }
    assert_eq!((path.motion(-0.01), path.motion(0.31)), (None, None));
}

/// A time between two ticks is sent as the nearest tick, with where the leg is then.
#[test]
fn a_set_point_is_where_the_leg_is_at_its_tick() {
    for time_s in [0.1, 0.100_05, 0.100_1] {
        let point = TimedPoint {
            time_s,
            motion: circle(time_s),
            tension: None,
        };
        let sent = point.set_point(u32::MAX, StreamPart::Next);
        let at_s = f64::from(sent.tick.wrapping_add(1)) / f64::from(TICK_HZ);
        assert!((at_s - time_s).abs() <= 0.5 / f64::from(TICK_HZ) + 1e-12);
        let MotionState { position, rate, .. } = circle(at_s);
        for i in 0..2 {
            assert!((f64::from(sent.direction[i]) - position[i]).abs() < 3e-8);
            assert!((f64::from(sent.rate[i]) - rate[i]).abs() < 1e-7);
        }
    }
}

#[test]
fn rows_far_from_each_other_have_points_between() {
    let tension = Some(StreamTension::Pretension(60.0));
    let [from, to] = [(0.0, None), (0.5, tension)].map(|(time_s, tension)| TimedPoint {
        time_s,
        motion: circle(time_s),
        tension,
    });
    let points = way(&from, &to);
    assert_eq!((points.len(), points.last()), (25, Some(&to)));
    for point in points {
        assert_eq!(point.tension, tension);
        let [position, rate, acceleration] = deviation(&point);
        assert!(
            position < 1e-6 && rate < 1e-4 && acceleration < 2e-3,
            "{point:?}"
        );
    }
}

/// Within the limits, from a rest; a circle that is faster than the leg has none.
#[test]
fn a_start_in_motion_has_a_run_up() {
    let first = TimedPoint {
        time_s: 0.0,
        motion: circle(0.0),
        tension: None,
    };
    let points = run_up(&first, &settings()).unwrap();
    assert_eq!(points.last(), Some(&first));
    let rest = points.first().unwrap();
    assert!(rest.time_s <= -0.5);
    assert_eq!(rest.motion, MotionState::resting(rest.motion.position));
    assert_eq!(check(&points, &settings()), Ok(()));
    let fast = TimedPoint {
        motion: MotionState {
            rate: first.motion.rate.map(|rate| 3.0 * rate),
            ..first.motion
        },
        ..first
    };
    let refusal = PointRefusal::Limit(MotionLimit::Speed);
    assert_eq!(run_up(&fast, &settings()), Err(refusal));
}

/// A path whose points are all in reach is refused for what is wrong with it, however far it overshoots between them.
#[test]
fn a_path_that_is_much_too_fast_is_told_so() {
    for faster in [3.0, 10.0, 30.0, 100.0] {
        let row = |i: u32| PathRow {
            time_s: f64::from(i) * 0.01,
            direction: circle(f64::from(i) * 0.01 * faster).position,
            tension: None,
        };
        let rows: Vec<_> = (0..500).map(row).collect();
        let (time_s, refusal) = TimedPath::new(&rows).streamed(&settings()).unwrap_err();
        let limit = PointRefusal::Limit(MotionLimit::Speed);
        assert_eq!(refusal, limit, "{faster} times, at {time_s} s");
    }
}

#[test]
fn the_point_that_is_refused_is_told() {
    let mut rows = rows(&[0.0, 0.1, 0.2, 0.3, 0.4, 0.5]);
    assert!(TimedPath::new(&rows).streamed(&settings()).is_ok());
    rows[4].direction = [0.6, 0.0];
    let refused = TimedPath::new(&rows).streamed(&settings());
    let (time_s, refusal) = refused.unwrap_err();
    assert!((time_s - 0.4).abs() < 1e-9 && refusal == PointRefusal::OutOfReach);
}
