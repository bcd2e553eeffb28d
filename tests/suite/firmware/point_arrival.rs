//! When set-points arrive at the board.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use super::set_points::Bench;
use super::wild_points::point;
use leg_firmware::control::CYCLE_TICKS;
use leg_firmware::set_point::{SetPoint, StreamPart};
use std::f64::consts::PI;

/// Points of half a circle of 10° in 2.5 s, 10 ms apart, after a way of two seconds to its begin. Times in ticks and cycles.
const POINTS: u32 = 251;
const APART: u32 = 80;
const BEGIN: u32 = 16_000;
const APART_CYCLES: u32 = APART / CYCLE_TICKS as u32;
const BEGIN_CYCLES: u32 = BEGIN / CYCLE_TICKS as u32;

fn points() -> Vec<SetPoint> {
    let time_s = f64::from(APART * (POINTS - 1)) / 8000.0;
    let at = |i: u32| {
        let s = f64::from(i) / f64::from(POINTS - 1);
        let turned = PI * s * s * s * (10.0 + s * (6.0 * s - 15.0));
        let speed = PI * 30.0 * s * s * (1.0 - s) * (1.0 - s) / time_s;
        let part = match i {
            0 => StreamPart::First,
            _ if i == POINTS - 1 => StreamPart::Last,
            _ => StreamPart::Next,
        };
        let place = point(part, BEGIN + i * APART, [turned.to_degrees(), 10.0]);
        let [x, y] = place.direction;
        let rate = [-y, x].map(|across| across * speed as f32);
        // The way to the first ends without acceleration.
        let acceleration = (i == 0).then_some([0.0; 2]);
        SetPoint {
            rate,
            acceleration,
            ..place
        }
    };
    (0..POINTS).map(at).collect()
}

/// Where the trajectory is in each cycle, of points that arrive in this cycle.
fn places(arrives_at: impl Fn(u32) -> u32) -> Vec<[f64; 2]> {
    let mut bench = Bench::new(0);
    let points = points();
    let mut sent = 0;
    let cycle = |cycle: u32| {
        while sent < POINTS && arrives_at(sent) <= cycle {
            bench.follow(&points[sent as usize]).unwrap();
            sent += 1;
        }
        bench.advance();
        bench.places[0]
    };
    let cycles = BEGIN_CYCLES + POINTS * APART_CYCLES;
    (0..cycles).map(cycle).collect()
}

/// Points that are 80 ms ahead and arrive up to 50 ms late, or four at once: the leg goes the same way to the bit, for a point counts by its own
/// time.
#[test]
fn a_host_that_is_now_and_then_late_changes_nothing() {
    const LEAD: u32 = 8;
    let steady = |i: u32| match i {
        0 => 0,
        _ => BEGIN_CYCLES + i * APART_CYCLES - LEAD * APART_CYCLES,
    };
    let bursts = |i: u32| steady(i).max(steady(i - i % 4 + 4)) * u32::from(i > 0);
    let mut rng = fastrand::Rng::with_seed(3);
    let late: Vec<u32> = (0..POINTS).map(|_| rng.u32(0..=5 * APART_CYCLES)).collect();
    // In their order.
    let jitters = |i: u32| {
        let arrives_at = |j: u32| (steady(j) + late[j as usize]) * u32::from(j > 0);
        (0..=i).map(arrives_at).max().unwrap_or_default()
    };
    let way = places(steady);
    let [.., [x, y]] = way[..] else {
        panic!("no way");
    };
    let q = 5.0_f64.to_radians().tan();
    assert!((x + q).hypot(y) < 1e-6, "{x} {y}");
    assert_eq!(way, places(bursts));
    assert_eq!(way, places(jitters));
}
