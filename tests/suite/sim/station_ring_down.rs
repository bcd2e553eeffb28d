//! How a leg that keeps station comes to rest after it is pushed, or has a payload hung on it.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use super::half_swings::{RingDown, WITHIN_N, half_swings, ring_down, swings_of_mode};
use super::ring_down::{
    FAST_HZ, LOADING_S, Leg, MORE_KG, PAYLOAD_MAX_KG, RATIO, REST_M, TENTH_S, drawn,
};
use super::station_stand::{BACK_MM, faults, paper, ticks};
use fastrand::Rng;
use leg_bench::stand::Stand;
use leg_firmware::command::Command;
use leg_firmware::sensors::TICK_HZ;
use leg_firmware::supervisor::{FaultSet, State};
use leg_rig::ready_rigs::READY_RIGS;
use leg_rig::rig_file::RigFile;
use nalgebra::Vector3;

/// For how long a leg is watched after a disturbance, s: it rings down in the first part, and shall rest in the last one.
const WATCHED_S: f64 = 8.0;
const RINGING_S: f64 = 2.0;
const RESTING_S: f64 = 2.0;

/// The longest until such a leg is back, s: all are after 0.7 s.
const BACK_S: f64 = 1.5;

/// What became of a leg.
#[derive(Debug)]
struct Watched {
    /// Whether a true tension leaves [`WITHIN_N`] by the disturbance itself.
    left_out: bool,
    /// How it rings down about where it ends, which what it creeps by meanwhile changes; and about where it creeps to.
    ring_down: Option<RingDown>,
    about_creep: Option<RingDown>,
    /// The largest half swing in the end, m.
    last_m: f64,
    /// How far it is from where it was, mm, in the end; and the time after which it stays within [`BACK_MM`] of that, s.
    end_mm: f64,
    back_s: f64,
    state: State,
    faults: FaultSet,
}

impl Watched {
    /// Of a leg with a first mode, Hz, and a disturbance of some time, s, that begins now.
    fn new(stand: &mut Stand, for_s: f64, mode_hz: f64) -> Self {
        let home_m = stand.truth.tip_m;
        let given = ticks(for_s + 1.0 / mode_hz);
        let (mut left_out, mut tips_m, mut back_s) = (false, Vec::new(), 0.0);
        for tick in 0..ticks(for_s + WATCHED_S) {
            stand.tick().unwrap();
            let mut tensions_n = stand.truth.tensions_n.iter();
            left_out |= tick < given && !tensions_n.all(|tension_n| WITHIN_N.contains(tension_n));
            tips_m.push(stand.truth.tip_m - home_m);
            if stand.truth.tip_m.metric_distance(&home_m) > BACK_MM * 1e-3 {
                back_s = tick as f64 / f64::from(TICK_HZ);
            }
        }
        let rings = |tips_m: &[_]| ring_down(&swings_of_mode(&half_swings(tips_m), mode_hz));
        let begins = ticks(for_s) as usize;
        let swings_m = creep_removed(&tips_m, ticks(for_s), mode_hz);
        let last_m = half_swings(&tips_m[tips_m.len() - ticks(RESTING_S) as usize..]);
        Self {
            left_out,
            ring_down: rings(&tips_m[begins..begins + ticks(RINGING_S) as usize]),
            about_creep: rings(&swings_m),
            last_m: last_m.iter().fold(0.0, |a: f64, half| a.max(half.1)),
            end_mm: tips_m.last().unwrap().norm() * 1e3,
            back_s: (back_s - for_s).max(0.0),
            state: stand.state(),
            faults: faults(stand),
        }
    }
}

/// How a tip swings about its mean over a period of its first mode, from half a period after the disturbance on: a correction that goes on at
/// its speed is in that mean, and what is left of a swing that decays decays as it does.
fn creep_removed(tips_m: &[Vector3<f64>], begins: u64, mode_hz: f64) -> Vec<Vector3<f64>> {
    let half = ticks(0.5 / mode_hz) as usize;
    let mut sums_m = vec![Vector3::zeros()];
    for tip_m in tips_m {
        sums_m.push(sums_m.last().unwrap() + tip_m);
    }
    let first = begins as usize + half;
    let swing_m = |i: usize| {
        let sum_m: Vector3<f64> = sums_m[i + half + 1] - sums_m[i - half];
        tips_m[i] - sum_m / (2 * half + 1) as f64
    };
    (first..first + ticks(RINGING_S) as usize)
        .map(swing_m)
        .collect()
}

/// A leg that is left to itself: nothing is heard of its host from then on.
fn left(stand: &mut Stand) {
    stand.command(&Command::KeepStation).unwrap();
    stand.wait(0.01).unwrap();
    stand.silence();
    stand.wait(1.0).unwrap();
    assert_eq!(stand.state(), State::KeepingStation);
}

/// The leg pushed by 5 N for a tenth of a second, and with half a kilogram more where it may carry that: with the time of it, s, and the payload, kg.
fn disturbed(sound: &Stand, leg: &Leg, rng: &mut Rng) -> Vec<(Stand, f64, f64)> {
    let mut pushed = sound.clone();
    let plant = pushed.plant();
    plant.push(plant.transverse(360.0 * rng.f64()) * 5.0, 0.1, 0.0);
    let mut disturbed = vec![(pushed, 0.1, 0.0)];
    let payload_kg = leg.payload_kg + MORE_KG;
    if payload_kg <= PAYLOAD_MAX_KG {
        let mut loaded = sound.clone();
        loaded.plant().set_payload(payload_kg, LOADING_S);
        disturbed.push((loaded, LOADING_S, MORE_KG));
    }
    disturbed
}

/// What is beyond the bars of legs that are drawn, so many of a rig; and how many ring down so that it is measured.
fn failures(name: &str, rig: &RigFile, seed: u64, count: u32) -> (Vec<String>, u32) {
    let mut rng = Rng::with_seed(seed);
    let (mut failed, mut measured) = (Vec::new(), 0);
    for number in 0..count {
        let (mut sound, leg) = drawn(rig, &mut rng);
        left(&mut sound);
        for (mut stand, for_s, more_kg) in disturbed(&sound, &leg, &mut rng) {
            let hz = leg.first_mode_hz(rig, more_kg);
            let found = Watched::new(&mut stand, for_s, hz);
            let what = format!(
                "{name}, seed {seed} #{number}, {more_kg} kg more: {hz:.1} Hz, {found:.6?}, {leg:.2?}"
            );
            println!("{what}");
            let mut kept = if found.state == State::KeepingStation {
                found.last_m < REST_M && found.end_mm < BACK_MM && found.back_s < BACK_S
            } else {
                found.left_out && found.faults.stopping().any()
            };
            for ring_down in [found.ring_down, found.about_creep]
                .into_iter()
                .flatten()
                .filter(|_| !found.left_out)
            {
                measured += 1;
                kept &= if hz > FAST_HZ {
                    ring_down.tenth_s <= TENTH_S
                } else {
                    ring_down.ratio >= RATIO
                };
            }
            if !kept {
                failed.push(what);
            }
        }
    }
    (failed, measured)
}

/// By the bars of a leg that follows commands: the brake is the same, and no correction drives the swing on.
fn require_rings_down(name: &str, seed: u64, count: u32, least_measured: u32) {
    let rig = RigFile::load(Some(name.as_ref())).unwrap();
    let (failed, measured) = failures(name, &rig, seed, count);
    assert!(failed.is_empty(), "{failed:#?}");
    assert!(measured >= least_measured, "{name}: {measured} measured");
}

#[test]
fn a_leg_that_keeps_station_rings_down() {
    require_rings_down(READY_RIGS[0].name, 5, 8, 10);
}

#[test]
fn a_leg_with_another_support_that_keeps_station_rings_down() {
    for name in ["spherical", "leaf_spring_universal"] {
        require_rings_down(name, 29, 3, 6);
    }
}

/// Without the brake three of eight and more come back too late, or ring on: the bars can fail.
#[test]
fn a_leg_that_keeps_station_without_a_brake_rings_on() {
    let mut rig = paper();
    rig.gains.motion.damping_ratio = 0.0;
    let (failed, measured) = failures("no brake", &rig, 17, 4);
    assert!(measured > 0 && failed.len() >= 3, "{failed:#?}");
}
