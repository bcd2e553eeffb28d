//! Streams of set-points, whatever a host sends.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use super::still_leg::StillLeg;
use super::wild_points::{WILD_REFUSALS, point, wild};
use crate::common::require_said;
use leg_firmware::command::{Command, CommandRefusal};
use leg_firmware::control::{
    CYCLE_S, CYCLE_TICKS, Knot, MotionLimits, POINTS_MAX, Stream, StreamLimits, Trajectory,
};
use leg_firmware::set_point::{MotionLimit, PointRefusal, SetPoint, StreamPart, StreamTension};
use leg_firmware::settings::Settings;
use leg_model::HalfTangent;
use std::f64::consts::TAU;

fn settings() -> Settings {
    Settings::table_1().unwrap()
}

/// The trajectory of a leg, its stream, and the tick.
pub struct Bench {
    trajectory: Trajectory<f64>,
    stream: Stream<f64>,
    tick: u32,
    /// Half-tangents of the last four cycles, the newest first.
    pub places: [[f64; 2]; 4],
}

impl Bench {
    pub fn new(tick: u32) -> Self {
        let settings = settings();
        Self {
            trajectory: Trajectory::new(MotionLimits::new(&settings), HalfTangent::new(0.0, 0.0)),
            stream: Stream::new(StreamLimits::new(&settings)),
            tick,
            places: [[0.0; 2]; 4],
        }
    }

    /// What a leg does with a point.
    pub fn follow(&mut self, point: &SetPoint) -> Result<(), PointRefusal> {
        if self.stream.repeats(point) {
            return Ok(());
        }
        match (point.part, self.trajectory.streamed()) {
            (StreamPart::First, true) => return Err(PointRefusal::Following),
            (StreamPart::First, false) => {}
            (_, true) => return self.stream.extend(self.tick, point),
            (_, false) => return Err(PointRefusal::NoStream),
        }
        let start = Knot {
            tick: self.tick.wrapping_add(u32::from(CYCLE_TICKS)),
            motion: self.trajectory.next_motion(),
        };
        self.stream.begin(start, point)?;
        self.trajectory.begin_stream();
        Ok(())
    }

    /// Leaves a stream for rest; false if none is followed.
    fn leave_stream(&mut self) -> bool {
        self.stream.leave();
        let streamed = self.trajectory.streamed();
        if streamed {
            let motion = self.trajectory.motion();
            let to_rest = self.stream.limits.rest_segment(&motion);
            self.trajectory.leave_stream(&to_rest);
        }
        streamed
    }

    fn hold(&mut self) {
        if !self.leave_stream() {
            self.trajectory.stop();
        }
    }

    fn go(&mut self, to: HalfTangent<f64>) {
        self.leave_stream();
        self.trajectory.go(to);
    }

    /// The rest of a cycle, after its command.
    pub fn advance(&mut self) {
        let [a, b, c, _] = self.places;
        self.places = [self.trajectory.step().xy(), a, b, c];
        self.trajectory.advance_plan(&mut self.stream, 0.0);
        self.tick = self.tick.wrapping_add(u32::from(CYCLE_TICKS));
    }

    /// Rate, acceleration and jerk of the last cycles.
    fn motion(&self) -> [f64; 3] {
        let difference = |weights: [f64; 4], order: i32| {
            let part = |i: usize| -> f64 {
                let terms = weights.iter().zip(self.places);
                terms.map(|(weight, place)| weight * place[i]).sum()
            };
            part(0).hypot(part(1)) / f64::from(CYCLE_S).powi(order)
        };
        [
            difference([1.0, -1.0, 0.0, 0.0], 1),
            difference([1.0, -2.0, 1.0, 0.0], 2),
            difference([1.0, -3.0, 3.0, -1.0], 3),
        ]
    }
}

/// Half a million points, most of them refused, with holds and moves between: what the leg is led by keeps half of the limits in
/// half-tangent coordinates, as a move does, and the reach. The margins: 9 % of speed where a hold comes in the middle of a
/// segment, what the rounding of points that are 5 ms apart makes of the jerk, and the bulge of 0.5 % of the reach.
#[test]
fn no_points_lead_beyond_the_limits() {
    let settings = settings();
    let reach = f64::from(settings.tilt_max_sine).asin();
    let reach = (0.5 * reach).tan();
    let motion = settings.motion;
    const SPEED: f32 = 1.09;
    const JERK: f32 = 3.3;
    require_said(
        "firmware/SAFETY.md",
        &[
            format!("the jerk may be {JERK} times its limit"),
            format!(
                "the speed may be {:.0} % above its own",
                100.0 * (SPEED - 1.0)
            ),
        ],
    );
    let limits = [
        SPEED * motion.speed_rad_per_s,
        motion.acceleration_rad_per_s2,
        JERK * motion.jerk_rad_per_s3,
    ]
    .map(|limit| 0.5 * f64::from(limit));
    const SEED: u64 = 13;
    println!("seed {SEED}");
    let mut rng = fastrand::Rng::with_seed(SEED);
    let mut bench = Bench::new(u32::MAX - 1_000_000);
    let mut peaks = [0.0_f64; 4];
    let (mut accepted, mut refused) = (0, 0);
    let mut refusals: Vec<(PointRefusal, u32)> = Vec::new();
    let mut last = point(StreamPart::First, bench.tick, [0.0, 0.0]);
    for cycle in 0..2_000_000_u32 {
        match rng.u32(..8000) {
            0..8 => bench.hold(),
            8 => {
                let (azimuth, way) = (TAU * rng.f64(), reach * rng.f64().sqrt());
                bench.go(HalfTangent::new(way * azimuth.cos(), way * azimuth.sin()));
            }
            _ => {}
        }
        if rng.u32(..4) == 0 {
            let next = wild(&mut rng, &last, bench.trajectory.streamed(), bench.tick);
            match bench.follow(&next) {
                Ok(()) => (accepted, last) = (accepted + 1, next),
                Err(refusal) => {
                    refused += 1;
                    let known = refusals.iter_mut().find(|(known, _)| *known == refusal);
                    match known {
                        Some((_, count)) => *count += 1,
                        None => refusals.push((refusal, 1)),
                    }
                }
            }
            if !bench.trajectory.moving() {
                let [x, y] = bench.places[0];
                let direction = HalfTangent::new(x, y).direction().vector();
                last = SetPoint {
                    direction: [direction.x as f32, direction.y as f32],
                    ..point(StreamPart::First, bench.tick, [0.0, 0.0])
                };
            }
        }
        bench.advance();
        if cycle < 4 {
            continue;
        }
        let [x, y] = bench.places[0];
        let [rate, acceleration, jerk] = bench.motion();
        for (peak, now) in peaks.iter_mut().zip([x.hypot(y), rate, acceleration, jerk]) {
            assert!(now.is_finite());
            *peak = peak.max(now);
        }
    }
    println!("{accepted} accepted; {refusals:?}");
    for refusal in WILD_REFUSALS {
        let count = refusals.iter().find(|(known, _)| *known == refusal);
        assert!(
            count.is_some_and(|(_, count)| *count > 100),
            "{refusal:?}: {refusals:?}"
        );
    }
    let [place, motion @ ..] = peaks;
    assert!(
        accepted > 20_000 && refused > 100_000,
        "{accepted} {refused}"
    );
    assert!(
        place <= 1.005 * reach && place > 0.9 * reach,
        "{place} of {reach}"
    );
    for (peak, limit) in motion.into_iter().zip(limits) {
        assert!(peak <= limit, "{motion:?} beyond {limits:?}");
        assert!(peak > 0.5 * limit, "{motion:?} far below {limits:?}");
    }
}

/// A stream that stops leads to rest, without a jump, and says that a point is missing unless it was told the last.
#[test]
fn a_stream_that_stops_ends_in_rest() {
    for (part, missing) in [(StreamPart::Next, true), (StreamPart::Last, false)] {
        let mut bench = Bench::new(0);
        assert_eq!(
            bench.follow(&point(StreamPart::First, 4000, [0.0, 1.0])),
            Ok(())
        );
        let moving = SetPoint {
            rate: [0.1, 0.0],
            ..point(part, 8000, [0.0, 3.0])
        };
        assert_eq!(bench.follow(&moving), Ok(()));
        for _ in 0..4000 {
            bench.advance();
        }
        assert!(!bench.trajectory.moving());
        assert_eq!(bench.trajectory.point_missing(), missing);
        assert_eq!(bench.motion(), [0.0; 3]);
        let [x, _] = bench.places[0];
        assert!(
            x > f64::to_radians(1.5).tan(),
            "it stops after the point, at {x}"
        );
    }
}

/// Each thing that is wrong with a point has its name, and the stream goes on as if it had not come.
#[test]
fn a_point_is_refused_by_name() {
    let second = point(StreamPart::Next, 8000, [0.0, 1.2]);
    let number = SetPoint {
        rate: [f32::NAN, 0.0],
        ..second
    };
    let fast = SetPoint {
        rate: [1.0, 0.0],
        ..second
    };
    let limit = PointRefusal::Limit;
    let tensioned = |tension| SetPoint {
        tension: Some(tension),
        ..second
    };
    for (refused, refusal) in [
        (number, PointRefusal::Number),
        (
            tensioned(StreamTension::Pretension(f32::INFINITY)),
            PointRefusal::Number,
        ),
        (
            tensioned(StreamTension::Stiffness(0.0)),
            PointRefusal::Number,
        ),
        (
            point(StreamPart::Next, 8000, [0.0, 50.0]),
            PointRefusal::OutOfReach,
        ),
        (
            point(StreamPart::Next, 3900, [0.0, 1.2]),
            PointRefusal::Order,
        ),
        (
            point(StreamPart::Next, 4039, [0.0, 1.0]),
            PointRefusal::Order,
        ),
        (point(StreamPart::Next, 0, [0.0, 1.2]), PointRefusal::Late),
        (
            point(StreamPart::Next, 80_001, [0.0, 1.2]),
            PointRefusal::Early,
        ),
        (fast, limit(MotionLimit::Speed)),
        (
            point(StreamPart::Next, 5600, [0.0, 1.8]),
            limit(MotionLimit::Acceleration),
        ),
        (
            point(StreamPart::Next, 4800, [0.0, 1.08]),
            limit(MotionLimit::Jerk),
        ),
    ] {
        let mut bench = Bench::new(0);
        assert_eq!(bench.follow(&second), Err(PointRefusal::NoStream));
        assert_eq!(
            bench.follow(&point(StreamPart::First, 4000, [0.0, 1.0])),
            Ok(())
        );
        assert_eq!(bench.follow(&refused), Err(refusal), "{refused:?}");
        assert_eq!(bench.follow(&second), Ok(()));
        assert_eq!(
            bench.follow(&second),
            Ok(()),
            "a repetition changes nothing"
        );
        let last = point(StreamPart::Last, 12_000, [0.0, 1.2]);
        assert_eq!(bench.follow(&last), Ok(()));
        let after = point(StreamPart::Next, 16_000, [0.0, 1.2]);
        assert_eq!(bench.follow(&after), Err(PointRefusal::NoStream));
    }
}

#[test]
fn a_full_stream_refuses_points_until_there_is_room() {
    let mut bench = Bench::new(0);
    let next = |number: u32| point(StreamPart::Next, 4000 + 40 * number, [0.0, 1.0]);
    assert_eq!(
        bench.follow(&point(StreamPart::First, 4000, [0.0, 1.0])),
        Ok(())
    );
    // The first is followed from the next cycle on.
    bench.advance();
    let count = POINTS_MAX as u32;
    for number in 1..=count {
        assert_eq!(bench.follow(&next(number)), Ok(()));
    }
    assert_eq!(bench.follow(&next(count + 1)), Err(PointRefusal::Full));
    while bench.tick < 4040 {
        bench.advance();
    }
    assert_eq!(bench.follow(&next(count + 1)), Ok(()));
}

/// A second stream beside the first is refused, a move ends a stream, and a point whose answer was lost may come again.
#[test]
fn a_leg_follows_one_stream() {
    let mut still = StillLeg::armed();
    let tick = still.leg.telemetry().tick;
    let at = |part, ticks: u32| Command::Follow(point(part, tick + ticks, [0.0, 10.0]));
    let refused = |refusal| Err(CommandRefusal::Point(refusal));
    let first = at(StreamPart::First, 4000);
    assert_eq!(
        still.obey(at(StreamPart::Next, 4000)),
        refused(PointRefusal::NoStream)
    );
    assert_eq!(still.obey(first), Ok(()));
    assert_eq!(still.obey(first), Ok(()));
    assert_eq!(
        still.obey(at(StreamPart::First, 5000)),
        refused(PointRefusal::Following)
    );
    let next = at(StreamPart::Next, 5000);
    assert_eq!((still.obey(next), still.obey(next)), (Ok(()), Ok(())));
    let [x, y] = [0.1, 0.0];
    assert_eq!(still.obey(Command::Move { x, y }), Ok(()));
    // The leg has left the stream: a repetition of its last point would not be followed either.
    for after in [next, at(StreamPart::Next, 6000)] {
        assert_eq!(still.obey(after), refused(PointRefusal::NoStream));
    }
}
