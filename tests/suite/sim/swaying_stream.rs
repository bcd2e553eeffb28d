//! Streams that sway near the first mode of a leg whose load is left out: it deviates, and that is no swing of its own.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use super::station_stand::{armed, faults, paper, pass};
use leg_bench::stand::Stand;
use leg_firmware::command::{Command, Compensation};
use leg_firmware::set_point::{SetPoint, StreamPart};
use leg_firmware::supervisor::{FaultSet, State};
use leg_rig::rig_file::RigFile;
use std::f64::consts::TAU;

/// Time between two points, s and ticks, and from one to its time, ticks.
const POINT_S: f64 = 0.01;
const POINT_TICKS: u32 = 80;
const AHEAD_TICKS: u32 = 4_000;

/// Time in which the sway begins, and that of the stream, s.
const BEGIN_S: f64 = 1.5;
const STREAMED_S: f64 = 6.0;

/// Part of what the limits on motion allow.
const PART: f64 = 0.5;

/// A sway about the vertical, in half-tangents.
struct Sway {
    amplitude: f64,
    hz: f64,
}

impl Sway {
    fn new(rig: &RigFile, hz: f64) -> Self {
        let (motion, omega) = (&rig.gains.motion, TAU * hz);
        let speed = f64::from(motion.speed_rad_per_s) / omega;
        let acceleration = f64::from(motion.acceleration_rad_per_s2) / omega.powi(2);
        let jerk = f64::from(motion.jerk_rad_per_s3) / omega.powi(3);
        let amplitude = PART * speed.min(acceleration).min(jerk).min(0.35);
        Self { amplitude, hz }
    }

    fn place(&self, time_s: f64) -> f64 {
        let begun = (time_s / BEGIN_S).clamp(0.0, 1.0);
        let envelope = begun.powi(3) * (10.0 - 15.0 * begun + 6.0 * begun * begun);
        self.amplitude * envelope * (TAU * self.hz * time_s).sin()
    }

    /// Place, rate and acceleration.
    fn point(&self, time_s: f64) -> [f64; 3] {
        const STEP_S: f64 = 1e-4;
        let [before, now, after] = [-STEP_S, 0.0, STEP_S].map(|step| self.place(time_s + step));
        let rate = (after - before) / (2.0 * STEP_S);
        [now, rate, (after - 2.0 * now + before) / STEP_S.powi(2)]
    }
}

fn stream(stand: &mut Stand, sway: &Sway) {
    let first = stand.telemetry.unwrap().tick + AHEAD_TICKS;
    for i in 0..(STREAMED_S / POINT_S) as u32 {
        let [place, rate, acceleration] = sway.point(f64::from(i) * POINT_S);
        let along = |value: f64| [value as f32, 0.0];
        let point = SetPoint {
            part: if i == 0 {
                StreamPart::First
            } else {
                StreamPart::Next
            },
            tick: first + i * POINT_TICKS,
            direction: along(place),
            rate: along(rate),
            acceleration: Some(along(acceleration)),
            tension: None,
        };
        stand.command(&Command::Follow(point)).unwrap();
        pass(stand, POINT_S);
    }
}

#[test]
fn a_stream_that_sways_near_the_first_mode_goes_on() {
    let rig = paper();
    for compensation in [
        Compensation::Off,
        Compensation::Frozen,
        Compensation::Estimated,
    ] {
        for hz in [1.0, 2.0, 3.0, 4.0] {
            let mut stand = armed(&rig, [0.0, 0.0], 2.0, 7);
            stand.command(&Command::Compensation(compensation)).unwrap();
            pass(&mut stand, 1.0);
            let sway = Sway::new(&rig, hz);
            stream(&mut stand, &sway);
            let what = format!("{compensation:?}, {hz} Hz, ±{:.4}", sway.amplitude);
            println!("{what}: {:?} {:?}", stand.state(), faults(&stand));
            assert_eq!(stand.state(), State::Active, "{what}");
            assert_eq!(faults(&stand), FaultSet::NONE, "{what}");
            assert!(stand.moving(), "{what}");
        }
    }
}
