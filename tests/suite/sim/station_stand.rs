//! A leg on a stand that keeps station, and how far its tip goes.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use leg_bench::stand::{Stand, move_to};
use leg_firmware::command::Command;
use leg_firmware::sensors::TICK_HZ;
use leg_firmware::supervisor::{FaultSet, State};
use leg_rig::rig_file::RigFile;
use leg_sim::plant::Start;
use nalgebra::Vector3;

/// How near to where it was a leg that has come back is, mm.
pub const BACK_MM: f64 = 0.1;

pub fn paper() -> RigFile {
    RigFile::load(None).unwrap()
}

/// At rest at a pose, armed, with a payload.
pub fn armed(
    rig: &RigFile,
    [azimuth_deg, tilt_deg]: [f64; 2],
    payload_kg: f64,
    seed: u64,
) -> Stand {
    let start = Start::Held {
        azimuth_deg,
        tilt_deg,
        pretension_n: rig.pretension_n,
        payload_kg,
    };
    println!("seed {seed}: azimuth {azimuth_deg}°, tilt {tilt_deg}°, {payload_kg} kg");
    let mut stand = Stand::new(rig, &rig.plant, start, seed).unwrap();
    stand.wait(0.1).unwrap();
    stand.command(&Command::Arm).unwrap();
    stand.wait(0.4).unwrap();
    stand.command(&move_to([azimuth_deg, tilt_deg])).unwrap();
    stand.wait(3.0).unwrap();
    assert_eq!(stand.state(), State::Active);
    stand
}

/// The same, left to itself: nothing is heard of its host from then on.
pub fn keeping(rig: &RigFile, pose_deg: [f64; 2], payload_kg: f64, seed: u64) -> Stand {
    let mut stand = armed(rig, pose_deg, payload_kg, seed);
    stand.command(&Command::KeepStation).unwrap();
    stand.wait(0.01).unwrap();
    stand.silence();
    stand.wait(1.0).unwrap();
    assert_eq!(stand.state(), State::KeepingStation);
    stand
}

/// Lets a time pass, whatever comes.
pub fn pass(stand: &mut Stand, time_s: f64) {
    for _ in 0..ticks(time_s) {
        stand.tick().unwrap();
    }
}

/// All faults, limits too.
pub fn faults(stand: &Stand) -> FaultSet {
    stand.telemetry.unwrap().faults
}

pub fn ticks(time_s: f64) -> u64 {
    (time_s * f64::from(TICK_HZ)) as u64
}

/// How far the tip goes at most from where it was, and how far it is from there in the end, mm; the time after which it stays within
/// 0.1 mm, s; and the fastest mean speed over half a second once the leg has swung, mm/s.
#[derive(Clone, Copy, Debug)]
pub struct Excursion {
    pub largest_mm: f64,
    pub end_mm: f64,
    pub back_s: f64,
    pub mm_per_s: f64,
}

impl Excursion {
    pub fn new(stand: &mut Stand, home_m: Vector3<f64>, time_s: f64) -> Self {
        const SPAN_S: f64 = 0.5;
        const SWINGS_S: f64 = 0.8;
        let mut tips_m = Vec::new();
        let mut found = Self {
            largest_mm: 0.0,
            end_mm: 0.0,
            back_s: 0.0,
            mm_per_s: 0.0,
        };
        for tick in 1..=ticks(time_s) {
            stand.tick().unwrap();
            let tip_m = stand.truth.tip_m;
            tips_m.push(tip_m);
            found.end_mm = (tip_m - home_m).norm() * 1e3;
            found.largest_mm = found.largest_mm.max(found.end_mm);
            if found.end_mm > BACK_MM {
                found.back_s = tick as f64 / f64::from(TICK_HZ);
            }
            if tick > ticks(SPAN_S + SWINGS_S) {
                let before_m = tips_m[(tick - 1 - ticks(SPAN_S)) as usize];
                let mm_per_s = (tip_m - before_m).norm() * 1e3 / SPAN_S;
                found.mm_per_s = found.mm_per_s.max(mm_per_s);
            }
        }
        found
    }
}
