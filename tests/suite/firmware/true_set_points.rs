//! Set-points that are drawn, streamed to a simulated leg: what its true tip does.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use super::wild_points::{point, wild};
use crate::common::require_said;
use fastrand::Rng;
use leg_base::angles;
use leg_firmware::command::{Command, CommandRefusal};
use leg_firmware::host_link::HostRefusal;
use leg_firmware::set_point::{SetPoint, StreamPart};
use leg_firmware::supervisor::State;
use leg_model::evaluate;
use leg_rig::control_settings;
use leg_rig::ready_rigs::READY_RIGS;
use leg_rig::rig_file::RigFile;
use leg_sim::emulated_leg::EmulatedLeg;
use leg_sim::hosted_leg::HostedLeg;
use leg_sim::plant::Start;
use leg_sim::shadow::Shadow;
use nalgebra::Vector3;
use std::thread;

/// Points in each run of the tests, and in the one that is asked for.
const POINTS: u32 = 42_000;
const MANY_POINTS: u32 = 1_000_000;

/// Legs that they are shared among: two of each ready rig.
const LEGS: u32 = 2 * READY_RIGS.len() as u32;

/// Ticks from one point to the next, sent whatever became of the last one.
const TICKS_BETWEEN: u64 = 20;

/// What the true leg does beyond the limits of its settings, for it swings about its reference. It keeps those on speed and tension. The
/// acceleration is that of the paper's leg at 70 N; legs with any joint, payload and pretension come to 3.5 times the limit, where a tendon is
/// near its highest tension.
const BEYOND_DEG: f64 = 0.3;
const ACCELERATION_PART: f64 = 1.2;
const DRAWN_ACCELERATION_PART: f64 = 4.0;

/// The same in the first half a second after it is armed: the motors have not turned yet, and nothing has shown what it carries. A million points come to 1.7.
const FIRST_ACCELERATION_PART: f64 = 2.0;
const FIRST_TICKS: u64 = 4_000;

/// For so many ticks in a row, 0.1 s, a leg and its shadow in f64 may differ in state or faults, as in `leg strikes`: what is asked of the tendons
/// is often at its bound.
const OTHER_TICKS: u64 = 800;

/// The time over which an acceleration is measured, ticks: 20 ms, less than a period of the leg's swing.
const ACCELERATION_TICKS: usize = 160;

/// The most that a leg did, and how many of its points were accepted.
#[derive(Clone, Copy, Debug)]
struct Peaks {
    /// Tilt beyond the greatest.
    beyond_deg: f64,
    /// Speed, acceleration and tension as parts of their limits.
    speed: f64,
    acceleration: f64,
    /// The same just after the leg was armed.
    first_acceleration: f64,
    tension: f64,
    accepted: u32,
}

impl Peaks {
    const NONE: Self = Self {
        beyond_deg: f64::NEG_INFINITY,
        speed: 0.0,
        acceleration: 0.0,
        first_acceleration: 0.0,
        tension: 0.0,
        accepted: 0,
    };

    fn merge(self, other: Self) -> Self {
        Self {
            beyond_deg: self.beyond_deg.max(other.beyond_deg),
            speed: self.speed.max(other.speed),
            acceleration: self.acceleration.max(other.acceleration),
            first_acceleration: self.first_acceleration.max(other.first_acceleration),
            tension: self.tension.max(other.tension),
            accepted: self.accepted + other.accepted,
        }
    }
}

/// What is drawn for a leg: a payload up to 2 kg and a pretension that the whole workspace allows.
#[derive(Clone, Copy, Debug)]
struct Drawn {
    rig: &'static str,
    payload_kg: f64,
    pretension_n: f64,
}

impl Drawn {
    /// The leg of the paper, every other one with 2 kg.
    fn paper(seed: u64, _: &mut Rng) -> Self {
        Self {
            rig: READY_RIGS[0].name,
            payload_kg: if seed.is_multiple_of(2) { 2.0 } else { 0.0 },
            pretension_n: 70.0,
        }
    }

    fn any(seed: u64, rng: &mut Rng) -> Self {
        /// What the estimate of the load is off by, N.
        const ROOM_N: f64 = 1.0;
        let rig = READY_RIGS[seed as usize % READY_RIGS.len()].name;
        let file = RigFile::load(Some(rig.as_ref())).unwrap();
        let payload_kg = match rng.u8(..4) {
            0 => 0.0,
            1 => 2.0,
            _ => 2.0 * rng.f64(),
        };
        let range = |[azimuth_deg, tilt_deg]: [f64; 2]| {
            let query = file.query(azimuth_deg, tilt_deg, payload_kg);
            let found = evaluate(&file.parameters, &query);
            found.unwrap().pretension_range_n
        };
        let edge = (0..36).map(|i| range([10.0 * f64::from(i), file.tilt_deg.min(30.0)]));
        let both = |a: [f64; 2], b: [f64; 2]| [a[0].max(b[0]), a[1].min(b[1])];
        let [low, high] = edge.fold(range([0.0, 0.0]), both);
        let (low, high) = (low + ROOM_N, high - ROOM_N);
        if low > high {
            return Self::any(seed, rng);
        }
        Self {
            rig,
            payload_kg,
            pretension_n: low + (high - low) * rng.f64(),
        }
    }
}

/// A leg that follows commands, its control law in f64, and what it did.
struct StreamedLeg {
    leg: HostedLeg,
    shadow: Shadow,
    /// The greatest tilt, and the limits on speed, acceleration and tension.
    reach_deg: f64,
    limits: [f64; 3],
    /// The rates of the last ticks, rad/s.
    rates: Vec<Vector3<f64>>,
    peaks: Peaks,
    /// Ticks until it was armed.
    armed_ticks: u64,
}

impl StreamedLeg {
    fn armed(drawn: &Drawn, seed: u64) -> Self {
        let mut rig = RigFile::load(Some(drawn.rig.as_ref())).unwrap();
        rig.pretension_n = drawn.pretension_n;
        let settings = control_settings::settings(&rig, &rig.gains, None);
        let start = Start::Held {
            azimuth_deg: 0.0,
            tilt_deg: 0.0,
            pretension_n: drawn.pretension_n,
            payload_kg: drawn.payload_kg,
        };
        let (leg, shadow) = EmulatedLeg::start_shadowed(&rig, &rig.plant, start, seed).unwrap();
        let motion = settings.motion;
        let limits = [
            motion.speed_rad_per_s,
            motion.acceleration_rad_per_s2,
            settings.f_max_n,
        ];
        let mut streamed = Self {
            leg: HostedLeg::new(leg, &rig, [0.0; 2], seed),
            shadow,
            reach_deg: f64::from(settings.tilt_max_sine).asin().to_degrees(),
            limits: limits.map(f64::from),
            rates: vec![Vector3::zeros(); ACCELERATION_TICKS],
            peaks: Peaks::NONE,
            armed_ticks: 0,
        };
        while streamed.leg.state() != State::Disarmed {
            streamed.tick();
        }
        streamed.leg.send(&Command::Arm).unwrap();
        for _ in 0..8_000 {
            streamed.tick();
        }
        assert_eq!(streamed.leg.state(), State::Active);
        streamed.peaks = Peaks::NONE;
        streamed.armed_ticks = streamed.leg.ticks();
        streamed
    }

    fn tick(&mut self) {
        let (taken, reply) = self.leg.tick().unwrap();
        // From then on it follows another path.
        if self.shadow.divergence.other_answers == 0 {
            self.shadow.tick(&taken.sensors, &taken.link, &reply);
        }
        let truth = self.leg.truth();
        let rate = truth.rate_rad_per_s;
        let place = (self.leg.ticks() as usize) % ACCELERATION_TICKS;
        let before = std::mem::replace(&mut self.rates[place], rate);
        let time_s = ACCELERATION_TICKS as f64 / 8_000.0;
        let down = truth.direction.vector();
        let highest_n = truth.tensions_n.into_iter().fold(0.0, f64::max);
        let [speed, acceleration, tension_n] = self.limits;
        let part = (rate - before).norm() / time_s / acceleration;
        let is_first = self.leg.ticks() < self.armed_ticks + FIRST_TICKS;
        self.peaks = self.peaks.merge(Peaks {
            beyond_deg: angles::angles_deg([down.x, down.y])[1] - self.reach_deg,
            speed: rate.norm() / speed,
            acceleration: if is_first { 0.0 } else { part },
            first_acceleration: if is_first { part } else { 0.0 },
            tension: highest_n / tension_n,
            accepted: 0,
        });
    }

    /// Streams up to so many points, most of which are refused, with other commands between: until the shadow answers one otherwise. How many
    /// there were.
    fn follow(&mut self, points: u32, rng: &mut Rng) -> u32 {
        let mut last = point(StreamPart::First, 0, [0.0, 0.0]);
        for count in 0..points {
            if self.shadow.divergence.other_answers > 0 {
                return count;
            }
            if let Some(command) = command(rng, self.reach_deg) {
                self.leg.send(&command).unwrap();
            }
            let telemetry = *self.leg.telemetry().unwrap();
            if !telemetry.moving {
                last = SetPoint {
                    direction: telemetry.target,
                    ..point(StreamPart::First, telemetry.tick, [0.0, 0.0])
                };
            }
            let next = wild(rng, &last, telemetry.moving, telemetry.tick);
            let number = self.leg.send(&Command::Follow(next)).unwrap();
            for _ in 0..TICKS_BETWEEN {
                self.tick();
                let mut answers = self.leg.answers().iter();
                let answer = answers.find(|answer| answer.number == number);
                if answer.is_some_and(|answer| answer.result.is_ok()) {
                    (self.peaks.accepted, last) = (self.peaks.accepted + 1, next);
                }
                let faults = self.leg.telemetry().unwrap().faults.stopping();
                assert!(!faults.any(), "tick {}: {faults:?}", self.leg.ticks());
            }
        }
        points
    }
}

/// Now and then another command: a move, which may be out of reach or no number, a hold, or another pretension or stiffness.
fn command(rng: &mut Rng, reach_deg: f64) -> Option<Command> {
    match rng.u32(..1500) {
        0 => {
            let (azimuth_deg, tilt_deg) = (360.0 * rng.f64(), 1.1 * reach_deg * rng.f64());
            let [x, y] = angles::direction(azimuth_deg, tilt_deg).map(|c| c as f32);
            Some(Command::Move { x, y })
        }
        1 => Some(Command::Move {
            x: f32::NAN,
            y: 0.0,
        }),
        2..=5 => Some(Command::Hold),
        6 => Some(Command::Pretension(170.0 * rng.f32() - 10.0)),
        7 => Some(Command::Stiffness {
            demand_nm_per_rad: 300.0 * rng.f32() - 20.0,
            towards: None,
        }),
        _ => None,
    }
}

/// How a leg is drawn from a seed.
type Draw = fn(u64, &mut Rng) -> Drawn;

/// Streams points to one leg after the other.
fn streamed(draw: Draw, seed: u64, points: u32) -> Peaks {
    let mut rng = Rng::with_seed(seed);
    let (mut sent, mut peaks) = (0, Peaks::NONE);
    while sent < points {
        let drawn = draw(seed, &mut rng);
        let mut leg = StreamedLeg::armed(&drawn, seed);
        sent += leg.follow(points - sent, &mut rng);
        println!(
            "seed {seed}: {drawn:.2?}, up to point {sent}, {} answered otherwise: {:.3?}",
            leg.shadow.divergence.other_answers, leg.peaks
        );
        let divergence = leg.shadow.divergence;
        // It ended with the first point that was answered otherwise.
        assert!(
            divergence.states_stay_within(OTHER_TICKS),
            "seed {seed}: {divergence:?}"
        );
        peaks = peaks.merge(leg.peaks);
    }
    peaks
}

/// Whatever is streamed, each true leg keeps its limits, but for its acceleration by a part.
fn require_limits(draw: Draw, points: u32, acceleration_part: f64) {
    let seeds: Vec<u64> = (1..=u64::from(LEGS)).collect();
    let peaks = thread::scope(|scope| {
        let legs = seeds.iter().map(|&seed| {
            let leg = scope.spawn(move || streamed(draw, seed, points / LEGS));
            (seed, leg)
        });
        let legs: Vec<_> = legs.collect();
        let ended = legs.into_iter().map(|(seed, leg)| (seed, leg.join()));
        let (ended, failed): (Vec<_>, Vec<_>) = ended.partition(|(_, leg)| leg.is_ok());
        let failed: Vec<u64> = failed.into_iter().map(|(seed, _)| seed).collect();
        assert!(failed.is_empty(), "seeds {failed:?}");
        let peaks = ended.into_iter().map(|(_, leg)| leg.unwrap());
        peaks.fold(Peaks::NONE, Peaks::merge)
    });
    println!("{points} points: {peaks:?}");
    assert!(peaks.accepted > points / 25, "{peaks:?}");
    assert!((-5.0..BEYOND_DEG).contains(&peaks.beyond_deg), "{peaks:?}");
    for (peak, highest) in [
        (peaks.speed, 1.0),
        (peaks.acceleration, acceleration_part),
        (
            peaks.first_acceleration,
            acceleration_part.max(FIRST_ACCELERATION_PART),
        ),
        (peaks.tension, 1.0),
    ] {
        assert!((0.5..highest).contains(&peak), "{peak}: {peaks:?}");
    }
}

#[test]
fn no_points_lead_the_true_leg_beyond_its_limits() {
    require_limits(Drawn::paper, POINTS, ACCELERATION_PART);
    require_said(
        "host-tools/docs/commanding-a-leg.md",
        &[
            format!(
                "tilt by more than {BEYOND_DEG}° and of acceleration by more than {:.0} %",
                100.0 * (ACCELERATION_PART - 1.0)
            ),
            format!("{FIRST_ACCELERATION_PART} times that limit in the first half a second"),
            format!("up to {DRAWN_ACCELERATION_PART} times the limit on acceleration"),
        ],
    );
}

/// With any joint, payload and pretension.
#[test]
fn no_points_lead_any_true_leg_beyond_its_limits() {
    require_limits(Drawn::any, POINTS, DRAWN_ACCELERATION_PART);
}

#[test]
#[ignore = "some three minutes of two cores"]
fn a_million_points_lead_no_true_leg_beyond_its_limits() {
    require_limits(Drawn::paper, MANY_POINTS, ACCELERATION_PART);
    require_limits(Drawn::any, MANY_POINTS, DRAWN_ACCELERATION_PART);
}

/// A leg that searches for its zero follows nothing, and goes on.
#[test]
fn a_leg_that_homes_refuses_points() {
    let rig = RigFile::load(None).unwrap();
    let start = Start::Slack { slack_mm: 2.0 };
    let (leg, mut shadow) = EmulatedLeg::start_shadowed(&rig, &rig.plant, start, 3).unwrap();
    let mut leg = HostedLeg::new(leg, &rig, [0.0; 2], 3);
    let mut tick = |leg: &mut HostedLeg| {
        let (taken, reply) = leg.tick().unwrap();
        shadow.tick(&taken.sensors, &taken.link, &reply);
    };
    while leg.state() != State::Disarmed {
        tick(&mut leg);
    }
    leg.send(&Command::Home).unwrap();
    while leg.state() != State::Homing {
        tick(&mut leg);
    }
    let now = leg.telemetry().unwrap().tick;
    let first = point(StreamPart::First, now + 4000, [0.0, 5.0]);
    let number = leg.send(&Command::Follow(first)).unwrap();
    let mut answered = None;
    for _ in 0..100 {
        tick(&mut leg);
        let answer = leg.answers().iter().find(|answer| answer.number == number);
        answered = answered.or(answer.map(|answer| answer.result));
    }
    let refused = HostRefusal::Command(CommandRefusal::State(State::Homing));
    assert_eq!(answered, Some(Err(refused)));
    assert_eq!(leg.state(), State::Homing);
    assert!(shadow.divergence.stays(), "{:?}", shadow.divergence);
}
