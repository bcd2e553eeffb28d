//! Trajectories: the limits that they keep, and the coordinates that they run in.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use leg_base::angles;
use leg_firmware::control::{CYCLE_TICKS, MotionLimits, Stream, StreamLimits, Trajectory};
use leg_firmware::sensors::TICK_HZ;
use leg_firmware::settings::Settings;
use leg_model::{Direction, HalfTangent, Scalar};

/// Time of a cycle, s.
const CYCLE_S: f64 = CYCLE_TICKS as f64 / TICK_HZ as f64;

/// Whatever way is taken, and however often it is changed, rate, acceleration and jerk keep half of the settings' limits in
/// half-tangent coordinates, and so the limits themselves in angles.
#[test]
fn trajectories_keep_their_limits() {
    let settings = Settings::table_1().unwrap();
    let motion = settings.motion;
    let limits = [
        motion.speed_rad_per_s,
        motion.acceleration_rad_per_s2,
        motion.jerk_rad_per_s3,
    ]
    .map(|limit| 0.5 * f64::from(limit));
    let mut rng = fastrand::Rng::with_seed(5);
    let mut trajectory =
        Trajectory::<f64>::new(MotionLimits::new(&settings), HalfTangent::new(0.0, 0.0));
    let mut stream = Stream::new(StreamLimits::new(&settings));
    let mut course = Course::default();
    for cycle in 0..200_000_u32 {
        if cycle % 1500 == 3 {
            let (tilt, azimuth) = (30.0 * rng.f64(), 360.0 * rng.f64());
            let q = (0.5 * tilt.to_radians()).tan();
            let [x, y] = angles::unit_vector(azimuth);
            trajectory.go(HalfTangent::new(q * x, q * y));
        }
        if cycle % 7000 == 900 {
            trajectory.stop();
        }
        trajectory.advance_plan(&mut stream, 0.0);
        course.step(trajectory.step().xy());
    }
    let peaks = course.peaks;
    for (peak, limit) in peaks.into_iter().zip(limits) {
        assert!(peak <= limit * 1.001, "{peaks:?} beyond {limits:?}");
        assert!(peak > 0.5 * limit, "{peaks:?} far below {limits:?}");
    }
}

/// What changes of a way come to at most: how far it leads, degrees, and how long a move takes, and a stop beyond the end of the path that it
/// ends, s.
struct Changes {
    tilt_deg: f64,
    move_s: f64,
    late_s: f64,
}

/// Changes the way of a trajectory that begins at rest at a tilt: eight in ten moves are left for another after up to 1.3 s, one comes to its end,
/// and one change is a stop. Three in ten lead to the greatest tilt itself.
fn change<T: Scalar + Into<f64>>(seed: u64, begin_deg: f64, changes: u32) -> Changes {
    let settings = Settings::table_1().unwrap();
    let point = |tilt_deg: f64, azimuth_deg: f64| {
        let [x, y] =
            angles::direction(azimuth_deg, tilt_deg).map(|component| T::from(component as f32));
        Direction::from_xy(x, y).unwrap().half_tangent()
    };
    let mut rng = fastrand::Rng::with_seed(seed);
    let begin = T::from((0.5 * begin_deg.to_radians()).tan() as f32);
    let mut trajectory = Trajectory::<T>::new(
        MotionLimits::new(&settings),
        HalfTangent::new(begin, T::zero()),
    );
    let mut stream = Stream::new(StreamLimits::new(&settings));
    let mut farthest = 0.0_f64;
    let mut run = |trajectory: &mut Trajectory<T>, cycles: u32| {
        for cycle in 0..cycles {
            trajectory.advance_plan(&mut stream, T::zero());
            let [x, y] = trajectory.step().xy().map(Into::<f64>::into);
            farthest = farthest.max(x.hypot(y));
            if !trajectory.moving() {
                return f64::from(cycle) * CYCLE_S;
            }
        }
        f64::INFINITY
    };
    let (mut move_s, mut late_s) = (0.0_f64, 0.0_f64);
    for change in 0..changes {
        let tilt_deg = (43.0 * rng.f64()).min(30.0);
        let end = point(tilt_deg, 360.0 * rng.f64());
        if change % 10 == 5 {
            let left = trajectory.ticks_to_end().unwrap_or_default();
            trajectory.stop();
            let stop_s = run(&mut trajectory, 20_000);
            late_s = late_s.max(stop_s - f64::from(left) / f64::from(TICK_HZ));
            continue;
        }
        trajectory.go(end);
        if change % 10 == 9 {
            move_s = move_s.max(run(&mut trajectory, 20_000));
            let [[x, y], [end_x, end_y]] =
                [trajectory.motion().position, end.xy()].map(|point| point.map(Into::into));
            assert!((x - end_x).hypot(y - end_y) < 1e-6);
        } else {
            run(&mut trajectory, 100 + (2500.0 * rng.f64().powi(2)) as u32);
        }
    }
    let tilt_deg = 2.0 * farthest.atan().to_degrees();
    Changes {
        tilt_deg,
        move_s,
        late_s,
    }
}

/// A path from a motion the other way swings out, the farther the longer it takes, and one on which the leg brakes leads on. Where no path but
/// the direct one was looked at, the leg came to 33.1° of 30°. A leg that begins beyond, as one that sags may, comes back and is not stuck.
#[test]
fn a_way_that_is_changed_stays_within_the_greatest_tilt() {
    for found in [change::<f64>(5, 0.0, 20_000), change::<f32>(6, 0.0, 20_000)] {
        let Changes {
            tilt_deg,
            move_s,
            late_s,
        } = found;
        println!("to {tilt_deg:.4}°, moves within {move_s:.3} s, stops late by {late_s:.4} s");
        assert!((29.9..30.004).contains(&tilt_deg), "{tilt_deg}°");
        assert!(move_s < 3.0, "{move_s} s to a target");
        assert!(late_s < 2.0 * CYCLE_S, "{late_s} s late");
    }
    for begin_deg in [30.1, 31.0, 33.0] {
        let tilt_deg = change::<f32>(7, begin_deg, 10).tilt_deg;
        assert!(
            (begin_deg - 1e-3..begin_deg + 0.004).contains(&tilt_deg),
            "{tilt_deg}°"
        );
    }
}

/// The last points of a trajectory, and the greatest rate, acceleration and jerk so far.
#[derive(Default)]
struct Course {
    points: Vec<[f64; 2]>,
    peaks: [f64; 3],
}

impl Course {
    fn step(&mut self, now: [f64; 2]) {
        self.points.push(now);
        let [.., c, b, a, now] = self.points[..] else {
            return;
        };
        let of = |weights: [f64; 4], order: i32| {
            let points = [now, a, b, c];
            let part = |i: usize| (0..4).map(|k| weights[k] * points[k][i]).sum::<f64>();
            part(0).hypot(part(1)) / CYCLE_S.powi(order)
        };
        let now = [
            of([1.0, -1.0, 0.0, 0.0], 1),
            of([1.0, -2.0, 1.0, 0.0], 2),
            of([1.0, -3.0, 3.0, -1.0], 3),
        ];
        for (peak, now) in self.peaks.iter_mut().zip(now) {
            *peak = peak.max(now);
        }
    }
}

/// A way that is made longer while the leg is on it has its greatest jerk at its very end.
#[test]
fn a_trajectory_keeps_its_jerk_to_the_end() {
    let settings = Settings::table_1().unwrap();
    let limit = 0.5 * f64::from(settings.motion.jerk_rad_per_s3);
    for first in [2e-3, 5e-3, 2e-2] {
        for second in [1.3, 2.0, 4.0] {
            for after in (20..400).step_by(20) {
                let limits = MotionLimits::new(&settings);
                let mut trajectory = Trajectory::<f64>::new(limits, HalfTangent::new(0.0, 0.0));
                let mut stream = Stream::new(StreamLimits::new(&settings));
                let mut course = Course::default();
                trajectory.go(HalfTangent::new(first, 0.0));
                for cycle in 0..2000 {
                    if cycle == after {
                        trajectory.go(HalfTangent::new(first * second, 0.0));
                    }
                    trajectory.advance_plan(&mut stream, 0.0);
                    course.step(trajectory.step().xy());
                }
                let [.., jerk] = course.peaks;
                let way = format!("{first}, {second} times as far after {after} cycles");
                assert!(jerk <= limit * 1.001, "{way}: {jerk} beyond {limit}");
            }
        }
    }
}

/// The tangent of half of the tilt is what a trajectory runs in.
#[test]
fn a_half_tangent_is_that_of_half_the_tilt() {
    let direction = HalfTangent::new(0.25_f64, 0.0).direction();
    let tilt = direction.vector().x.atan2(-direction.vector().z);
    assert!((tilt - 2.0 * 0.25_f64.atan()).abs() < 1e-15 && Scalar::is_finite(tilt));
}

/// By 20° from straight down, and by 40° through the vertical, in no more time than ever.
#[test]
fn a_move_takes_no_longer_than_it_did() {
    let settings = Settings::table_1().unwrap();
    let at = |tilt_deg: f64| HalfTangent::new((0.5 * tilt_deg.to_radians()).tan(), 0.0);
    for (begin_deg, end_deg, time_s) in [(0.0, 20.0, 0.86), (-20.0, 20.0, 1.71)] {
        let mut trajectory = Trajectory::<f64>::new(MotionLimits::new(&settings), at(begin_deg));
        let mut stream = Stream::new(StreamLimits::new(&settings));
        trajectory.go(at(end_deg));
        let mut cycles = 0;
        while cycles == 0 || trajectory.moving() {
            trajectory.advance_plan(&mut stream, 0.0);
            trajectory.step();
            cycles += 1;
        }
        let found_s = f64::from(cycles) * CYCLE_S;
        assert!(found_s < time_s + 0.005, "{end_deg}°: {found_s} s");
    }
}
