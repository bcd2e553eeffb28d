//! A host that sends its points late, each by another time: the board's own clock says when they are followed.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use fastrand::Rng;
use leg_base::timed_path::{PathRow, TimedPath};
use leg_firmware::command::Command;
use leg_firmware::sensors::TICK_HZ;
use leg_firmware::supervisor::{FaultSet, State};
use leg_rig::control_settings;
use leg_rig::rig_file::RigFile;
use leg_sim::emulated_leg::EmulatedLeg;
use leg_sim::hosted_leg::HostedLeg;
use leg_sim::path_sender::PathSender;
use leg_sim::plant::Start;
use leg_sim::shadow::Shadow;
use std::collections::VecDeque;

/// The bars of the circle.
const OFF_MM: f64 = 0.3;
const LAG_MS: f64 = 2.0;

/// A circle of 20° in 5 s at 100 Hz.
fn circle() -> TimedPath {
    let row = |i: u32| {
        let time_s = f64::from(i) * 0.01;
        PathRow::from_angles(time_s, 72.0 * time_s, 20.0)
    };
    TimedPath::new(&(0..=500).map(row).collect::<Vec<_>>())
}

/// What became of a circle.
struct Followed {
    off_mm: f64,
    /// By how much the tip is behind by the least squares of its errors.
    lag_ms: f64,
    faults: FaultSet,
    /// How many points came in the longest burst, all in one tick, and how late the latest was sent, ticks.
    burst: usize,
    latest_ticks: u64,
}

/// Host, leg and the control law in f64.
struct Line {
    leg: HostedLeg,
    shadow: Shadow,
    sender: PathSender,
    /// The commands that wait, each with the tick at which it was due, and that at which it is sent.
    waiting: VecDeque<(u64, u64, Command)>,
}

impl Line {
    fn armed(seed: u64) -> Self {
        let rig = RigFile::load(None).unwrap();
        let settings = control_settings::settings(&rig, &rig.gains, None);
        let start = Start::Held {
            azimuth_deg: 0.0,
            tilt_deg: 0.0,
            pretension_n: rig.pretension_n,
            payload_kg: 1.0,
        };
        let (leg, shadow) = EmulatedLeg::start_shadowed(&rig, &rig.plant, start, seed).unwrap();
        let mut line = Self {
            leg: HostedLeg::new(leg, &rig, [0.0; 2], seed),
            shadow,
            sender: PathSender::new(circle(), true, &settings).unwrap(),
            waiting: VecDeque::new(),
        };
        while line.leg.state() != State::Disarmed {
            line.tick();
        }
        line.leg.send(&Command::Arm).unwrap();
        for _ in 0..TICK_HZ {
            line.tick();
        }
        line
    }

    fn tick(&mut self) {
        let (taken, reply) = self.leg.tick().unwrap();
        self.shadow.tick(&taken.sensors, &taken.link, &reply);
    }

    /// Follows the circle; each point waits for up to so many ticks more than it should, and none passes the one before it.
    fn follow(&mut self, late_ticks: u64, rng: &mut Rng) -> Followed {
        let approach = self.sender.approach();
        self.leg.send(&approach).unwrap();
        let mut found = Followed {
            off_mm: 0.0,
            lag_ms: 0.0,
            faults: FaultSet::NONE,
            burst: 0,
            latest_ticks: 0,
        };
        let (mut error_by_velocity, mut velocity_square) = (0.0, 0.0);
        loop {
            self.tick();
            let telemetry = *self.leg.telemetry().unwrap();
            found.faults = found.faults.union(telemetry.faults);
            self.send_due(late_ticks, rng, &mut found);
            let Some(time_s) = self.sender.time_s(&telemetry) else {
                continue;
            };
            if self.sender.is_over(time_s) {
                break;
            }
            let Some(at) = self.sender.motion(time_s) else {
                continue;
            };
            let error_m = self.leg.truth().tip_m - self.leg.tip_m(at.position);
            let [x, y] = at.position;
            let down = (1.0 - x * x - y * y).sqrt();
            let [u, v] = at.rate;
            let rate = nalgebra::Vector3::new(u, v, (x * u + y * v) / down);
            let velocity_m_per_s = rate * self.leg.tip_length_m();
            found.off_mm = found.off_mm.max(error_m.norm() * 1e3);
            error_by_velocity += error_m.dot(&velocity_m_per_s);
            velocity_square += velocity_m_per_s.norm_squared();
        }
        found.lag_ms = -error_by_velocity / velocity_square * 1e3;
        found
    }

    fn send_due(&mut self, late_ticks: u64, rng: &mut Rng, found: &mut Followed) {
        let now = self.leg.ticks();
        let telemetry = *self.leg.telemetry().unwrap();
        for command in self.sender.due(&telemetry) {
            let before = self.waiting.back().map_or(0, |waiting| waiting.1);
            let sent = before.max(now + rng.u64(0..=late_ticks));
            self.waiting.push_back((now, sent, command));
        }
        let mut burst = 0;
        while let Some((due, _, command)) = self.waiting.pop_front_if(|next| next.1 <= now) {
            self.leg.send(&command).unwrap();
            burst += 1;
            found.latest_ticks = found.latest_ticks.max(now - due);
        }
        found.burst = found.burst.max(burst);
        let refused = self.leg.answers().iter().find(|one| one.result.is_err());
        assert!(refused.is_none(), "{refused:?}");
    }
}

/// Up to 90 ms late of the 100 ms by which they are sent before their time, in bursts: the tip is on the circle as if they were not.
#[test]
fn points_that_come_late_and_in_bursts_are_followed_at_their_times() {
    const LATE_TICKS: u64 = 720;
    let mut in_time = Line::armed(1);
    let in_time = in_time.follow(0, &mut Rng::with_seed(1));
    for seed in 1..=6 {
        let mut line = Line::armed(seed);
        let found = line.follow(LATE_TICKS, &mut Rng::with_seed(seed));
        let what = format!(
            "seed {seed}: {:.3} mm and {:.3} ms off ({:.3} mm and {:.3} ms without a delay), bursts of {}, {} ticks late",
            found.off_mm,
            found.lag_ms,
            in_time.off_mm,
            in_time.lag_ms,
            found.burst,
            found.latest_ticks
        );
        println!("{what}");
        assert!(
            found.off_mm <= OFF_MM && found.lag_ms.abs() <= LAG_MS,
            "{what}"
        );
        assert!(found.burst > 4 && found.latest_ticks > 600, "{what}");
        assert_eq!(found.faults, FaultSet::NONE, "{what}");
        assert!(
            line.shadow.divergence.stays(),
            "{what}: {:?}",
            line.shadow.divergence
        );
    }
}
