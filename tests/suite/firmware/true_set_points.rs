//! Set-points that are drawn, streamed to a simulated leg: what its true tip does.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use super::set_points::{point, wild};
use crate::common::require_said;
use leg_base::angles;
use leg_firmware::command::{Command, CommandRefusal};
use leg_firmware::host_link::HostRefusal;
use leg_firmware::set_point::StreamPart;
use leg_firmware::settings::Settings;
use leg_firmware::supervisor::State;
use leg_rig::rig_file::RigFile;
use leg_sim::emulated_leg::EmulatedLeg;
use leg_sim::hosted_leg::HostedLeg;
use leg_sim::plant::Start;
use nalgebra::Vector3;
use std::{env, thread};

/// Points in the tests; `LEG_POINTS=1000000` streams so many instead.
const POINTS: u32 = 24_000;

/// Legs that they are shared among, each with its seed.
const LEGS: u32 = 8;

/// Ticks from one point to the next, sent whatever became of the last one.
const TICKS_BETWEEN: u64 = 20;

/// What the true leg does beyond the limits of its settings, for it swings about its reference. It keeps those on speed and tension: a
/// million points come to 30.19°, 4.33 rad/s² of 4, 0.736 rad/s of 0.8 and 148.9 N of 150.
const BEYOND_DEG: f64 = 0.3;
const ACCELERATION_PART: f64 = 1.2;

/// The time over which an acceleration is measured, ticks: 20 ms, less than a period of the leg's swing.
const ACCELERATION_TICKS: usize = 160;

/// The most that a leg did, and how many of its points were accepted.
#[derive(Clone, Copy, Debug, Default)]
struct Peaks {
    tilt_deg: f64,
    speed_rad_per_s: f64,
    acceleration_rad_per_s2: f64,
    tension_n: f64,
    accepted: u32,
}

impl Peaks {
    fn merge(self, other: Self) -> Self {
        Self {
            tilt_deg: self.tilt_deg.max(other.tilt_deg),
            speed_rad_per_s: self.speed_rad_per_s.max(other.speed_rad_per_s),
            acceleration_rad_per_s2: self
                .acceleration_rad_per_s2
                .max(other.acceleration_rad_per_s2),
            tension_n: self.tension_n.max(other.tension_n),
            accepted: self.accepted + other.accepted,
        }
    }
}

/// A leg that follows commands, every other one with 2 kg.
fn armed(seed: u64) -> HostedLeg {
    let rig = RigFile::load(None).unwrap();
    let start = Start::Held {
        azimuth_deg: 0.0,
        tilt_deg: 0.0,
        pretension_n: rig.pretension_n,
        payload_kg: if seed.is_multiple_of(2) { 2.0 } else { 0.0 },
    };
    let leg = EmulatedLeg::start_in_process(&rig, &rig.plant, start, seed).unwrap();
    let mut leg = HostedLeg::new(leg, &rig, [0.0; 2], seed);
    while leg.state() != State::Disarmed {
        leg.tick().unwrap();
    }
    leg.send(&Command::Arm).unwrap();
    for _ in 0..8_000 {
        leg.tick().unwrap();
    }
    assert_eq!(leg.state(), State::Active);
    leg
}

/// Streams so many points, most of which are refused.
fn streamed(seed: u64, points: u32) -> Peaks {
    let mut leg = armed(seed);
    let mut rng = fastrand::Rng::with_seed(seed);
    let mut peaks = Peaks::default();
    let mut rates = vec![Vector3::zeros(); ACCELERATION_TICKS];
    let mut last = point(StreamPart::First, 0, [0.0, 0.0]);
    for _ in 0..points {
        let telemetry = *leg.telemetry().unwrap();
        if !telemetry.moving {
            last = point(StreamPart::First, telemetry.tick, [0.0, 0.0]);
            last.direction = telemetry.target;
        }
        let next = wild(&mut rng, &last, telemetry.moving, telemetry.tick);
        let number = leg.send(&Command::Follow(next)).unwrap();
        for _ in 0..TICKS_BETWEEN {
            leg.tick().unwrap();
            let answer = leg.answers().iter().find(|answer| answer.number == number);
            if answer.is_some_and(|answer| answer.result.is_ok()) {
                (peaks.accepted, last) = (peaks.accepted + 1, next);
            }
            let faults = leg.telemetry().unwrap().faults.stopping();
            assert!(!faults.any(), "seed {seed}: {faults:?}");
            let truth = leg.truth();
            let before = rates[(leg.ticks() as usize) % ACCELERATION_TICKS];
            let rate = truth.rate_rad_per_s;
            rates[(leg.ticks() as usize) % ACCELERATION_TICKS] = rate;
            let time_s = ACCELERATION_TICKS as f64 / 8_000.0;
            let down = truth.direction.vector();
            let highest_n = truth.tensions_n.into_iter().fold(0.0, f64::max);
            peaks = peaks.merge(Peaks {
                tilt_deg: angles::angles_deg([down.x, down.y])[1],
                speed_rad_per_s: rate.norm(),
                acceleration_rad_per_s2: (rate - before).norm() / time_s,
                tension_n: highest_n,
                accepted: 0,
            });
        }
    }
    peaks
}

/// Whatever is streamed, the true leg keeps its limits but for what it swings.
#[test]
fn no_points_lead_the_true_leg_beyond_its_limits() {
    let points = env::var("LEG_POINTS").map_or(POINTS, |text| text.parse().unwrap());
    let peaks = thread::scope(|scope| {
        let legs = [(); LEGS as usize];
        let mut seed = 0;
        let legs = legs.map(|()| {
            seed += 1;
            scope.spawn(move || streamed(seed, points / LEGS))
        });
        let peaks = legs.map(|leg| leg.join().unwrap());
        peaks.into_iter().fold(Peaks::default(), Peaks::merge)
    });
    println!("{points} points: {peaks:?}");
    let settings = Settings::table_1().unwrap();
    let speed = f64::from(settings.motion.speed_rad_per_s);
    let acceleration = f64::from(settings.motion.acceleration_rad_per_s2);
    let reach_deg = f64::from(settings.tilt_max_sine).asin().to_degrees();
    let f_max_n = f64::from(settings.f_max_n);
    assert!(peaks.accepted > points / 25, "{peaks:?}");
    for (peak, limit, beyond) in [
        (peaks.tilt_deg, reach_deg, 1.0 + BEYOND_DEG / reach_deg),
        (peaks.speed_rad_per_s, speed, 1.0),
        (
            peaks.acceleration_rad_per_s2,
            acceleration,
            ACCELERATION_PART,
        ),
        (peaks.tension_n, f_max_n, 1.0),
    ] {
        assert!(peak < limit * beyond, "{peak} of {limit}: {peaks:?}");
        assert!(peak > 0.5 * limit, "{peak} far below {limit}: {peaks:?}");
    }
    require_said(
        "host-tools/docs/commanding-a-leg.md",
        &[format!(
            "by {BEYOND_DEG}° of tilt and {:.0} % of acceleration",
            100.0 * (ACCELERATION_PART - 1.0)
        )],
    );
}

/// A leg that searches for its zero follows nothing, and goes on.
#[test]
fn a_leg_that_homes_refuses_points() {
    let rig = RigFile::load(None).unwrap();
    let start = Start::Slack { slack_mm: 2.0 };
    let leg = EmulatedLeg::start_in_process(&rig, &rig.plant, start, 3).unwrap();
    let mut leg = HostedLeg::new(leg, &rig, [0.0; 2], 3);
    while leg.state() != State::Disarmed {
        leg.tick().unwrap();
    }
    leg.send(&Command::Home).unwrap();
    while leg.state() != State::Homing {
        leg.tick().unwrap();
    }
    let tick = leg.telemetry().unwrap().tick;
    let first = point(StreamPart::First, tick + 4000, [0.0, 5.0]);
    let number = leg.send(&Command::Follow(first)).unwrap();
    let mut answered = None;
    for _ in 0..100 {
        leg.tick().unwrap();
        let answer = leg.answers().iter().find(|answer| answer.number == number);
        answered = answered.or(answer.map(|answer| answer.result));
    }
    let refused = HostRefusal::Command(CommandRefusal::State(State::Homing));
    assert_eq!(answered, Some(Err(refused)));
    assert_eq!(leg.state(), State::Homing);
}
