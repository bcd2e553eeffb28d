//! How a leg that is pushed, or has a payload hung on it, comes to rest.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use super::station_stand::{paper, pass, ticks};
use crate::common::unlike::{rigs_with_a_cell_off, unlike_rigs};
use fastrand::Rng;
use leg_bench::stand::{Stand, move_to};
use leg_firmware::command::Command;
use leg_firmware::sensors::TICK_HZ;
use leg_firmware::supervisor::State;
use leg_model::{StiffnessAt, evaluate};
use leg_rig::ready_rigs::READY_RIGS;
use leg_rig::rig_file::RigFile;
use leg_sim::plant::Start;
use nalgebra::Vector3;

/// The half swings of a tip, farthest to farthest, are told apart from what it creeps by this much, m.
const NOISE_M: f64 = 6e-6;

/// A half swing of less than this is not counted any more, m: half of what a move may swing to both sides. What friction and play of the
/// motors leave is less.
const LEAST_M: f64 = 1e-4;

/// What a tip may still swing in the end, from farthest to farthest, m.
const REST_M: f64 = 6e-5;

/// A half swing that takes so many times as long as one of the first mode is none of it: the leg creeps to where its load is compensated.
const CREEP: f64 = 2.0;

/// First mode, Hz, below which the ratio is asked for; above it the time to a tenth.
const FAST_HZ: f64 = 8.0;

/// The true tensions within which a leg rings down by its brake, N: below them a tendon is slack, and in the last 4 N below the maximum of
/// 150 N a motor is slowed down.
const WITHIN_N: std::ops::Range<f64> = 2.0..146.0;

/// Half swings of a tip along the direction in which it goes farthest from where it ends: time, s, and size, m.
fn half_swings(tips_m: &[Vector3<f64>]) -> Vec<(f64, f64)> {
    let end_m = tips_m[tips_m.len() - 1];
    let farthest = |a: &Vector3<f64>, b: &Vector3<f64>| a.norm().total_cmp(&b.norm());
    let axis = tips_m.iter().map(|tip| tip - end_m).max_by(farthest);
    let axis = axis.unwrap().normalize();
    let mut ends: Vec<(usize, f64)> = Vec::new();
    let (mut at, mut sign) = ((0, tips_m[0].dot(&axis)), 0.0);
    for (tick, tip) in tips_m.iter().enumerate() {
        let place_m = tip.dot(&axis);
        let away_m = place_m - at.1;
        if away_m * sign >= 0.0 && (sign != 0.0 || away_m.abs() > NOISE_M) {
            (at, sign) = (
                (tick, place_m),
                if sign == 0.0 { away_m.signum() } else { sign },
            );
        } else if sign != 0.0 && away_m.abs() > NOISE_M {
            ends.push(at);
            (at, sign) = ((tick, place_m), -sign);
        }
    }
    let half = |pair: &[(usize, f64)]| {
        let time_s = (pair[1].0 - pair[0].0) as f64 / f64::from(TICK_HZ);
        (time_s, (pair[1].1 - pair[0].1).abs())
    };
    ends.windows(2).map(half).collect()
}

/// Half swings from the largest one: before it the leg still comes back from what it has given way to. Of a leg with a first mode, Hz; none of
/// it are those of a leg that creeps to where its load is compensated, and the largest takes no time where it is such a one.
fn swings_of_mode(halves: &[(f64, f64)], mode_hz: f64) -> Vec<(f64, f64)> {
    let longest_s = CREEP * 0.5 / mode_hz;
    let by_size = |a: &(usize, f64), b: &(usize, f64)| a.1.total_cmp(&b.1);
    let sizes = halves.iter().map(|half| half.1).enumerate();
    let largest = sizes.max_by(by_size).map_or(0, |largest| largest.0);
    let of_mode = |(i, &(time_s, size_m)): (usize, &(f64, f64))| {
        let swings = time_s < longest_s;
        (i == 0 || swings).then_some((if swings { time_s } else { 0.0 }, size_m))
    };
    let later = halves.iter().skip(largest).enumerate();
    later.filter_map(of_mode).collect()
}

/// How a leg rings down.
#[derive(Clone, Copy, Debug)]
struct RingDown {
    /// Damping ratio by the mean logarithmic decrement of half swings.
    ratio: f64,
    /// The time after which half swings are less than a tenth of the first, s.
    tenth_s: f64,
}

/// None without two half swings, or where the first is not twice as much as is counted: one of 0.11 mm before one of 10 µm would have a
/// ratio of 0.03.
fn ring_down(halves: &[(f64, f64)]) -> Option<RingDown> {
    let first_m = halves
        .first()
        .map(|half| half.1)
        .filter(|&first_m| first_m > 2.0 * LEAST_M)?;
    let last = halves.iter().rposition(|half| half.1 > LEAST_M)?;
    // A part of the step down to what is counted no more: one from 0.101 mm to nothing, which friction ends, is almost no half swing.
    let decrement = if let Some(below) = halves.get(last + 1) {
        let part = (halves[last].1 / LEAST_M).ln() / (halves[last].1 / below.1.max(1e-6)).ln();
        (first_m / LEAST_M).ln() / (last as f64 + part)
    } else if last > 0 {
        (first_m / halves[last].1).ln() / last as f64
    } else {
        return None;
    };
    let tenth = |half: &&(f64, f64)| half.1 > 0.1 * first_m;
    Some(RingDown {
        ratio: decrement / decrement.hypot(std::f64::consts::PI),
        tenth_s: halves.iter().take_while(tenth).map(|half| half.0).sum(),
    })
}

/// A leg at rest.
#[derive(Clone, Debug)]
struct Leg {
    pose_deg: [f64; 2],
    payload_kg: f64,
    pretension_n: f64,
}

impl Leg {
    /// Its first mode by the model with so much more payload, kg, Hz.
    fn first_mode_hz(&self, rig: &RigFile, more_kg: f64) -> f64 {
        let payload_kg = self.payload_kg + more_kg;
        let mut query = rig.query(self.pose_deg[0], self.pose_deg[1], payload_kg);
        query.pretension_n = self.pretension_n;
        query.stiffness_at = StiffnessAt::Tension;
        let [least, _] = evaluate(&rig.parameters, &query)
            .unwrap()
            .bending_stiffness_nm_per_rad;
        let leg = rig.plant.transverse_inertia_kg_m2(&rig.parameters);
        let tip_m = rig.parameters.joint_length_m + rig.parameters.leg_length_m;
        let inertia = leg + payload_kg * tip_m * tip_m;
        (least / inertia).sqrt() / std::f64::consts::TAU
    }
}

/// A leg that follows commands at rest, at a pose with a payload and a pretension that are drawn.
fn drawn(rig: &RigFile, rng: &mut Rng) -> (Stand, Leg) {
    /// Room for the push and for the payload that is hung on, N and kg.
    const ROOM: (f64, f64) = (8.0, 0.5);
    loop {
        let tilt_max_deg = rig.tilt_deg.min(30.0);
        let pose_deg @ [azimuth_deg, tilt_deg] = [360.0 * rng.f64(), tilt_max_deg * rng.f64()];
        let payload_kg = 1.5 * rng.f64();
        let query = rig.query(azimuth_deg, tilt_deg, payload_kg + ROOM.1);
        let [low, high] = evaluate(&rig.parameters, &query)
            .unwrap()
            .pretension_range_n;
        let (low, high) = (low + ROOM.0, high - ROOM.0);
        if low > high {
            continue;
        }
        let pretension_n = low + (high - low) * rng.f64();
        let start = Start::Held {
            azimuth_deg,
            tilt_deg,
            pretension_n,
            payload_kg,
        };
        let mut stand = Stand::new(rig, &rig.plant, start, rng.u64(..)).unwrap();
        stand.wait(0.1).unwrap();
        stand.command(&Command::Arm).unwrap();
        stand.wait(0.4).unwrap();
        let pretension = Command::Pretension(pretension_n as f32);
        stand.command(&pretension).unwrap();
        stand.command(&move_to(pose_deg)).unwrap();
        stand.wait(2.5).unwrap();
        assert_eq!(stand.state(), State::Active);
        let leg = Leg {
            pose_deg,
            payload_kg,
            pretension_n,
        };
        return (stand, leg);
    }
}

/// How a leg with a first mode, Hz, rings down for two seconds from when a disturbance of some time, s, is over, and by how much the tip still swings in the last
/// half a second, m; none where a true tension leaves [`WITHIN_N`] meanwhile.
fn disturbed(stand: &mut Stand, for_s: f64, mode_hz: f64) -> Option<(Option<RingDown>, f64)> {
    pass(stand, for_s);
    let mut within = true;
    let mut tip_m = || {
        stand.tick().unwrap();
        let mut tensions_n = stand.truth.tensions_n.iter();
        within &= tensions_n.all(|tension_n| WITHIN_N.contains(tension_n));
        stand.truth.tip_m
    };
    let tips_m: Vec<_> = (0..ticks(2.0)).map(|_| tip_m()).collect();
    let last_m = half_swings(&tips_m[ticks(1.5) as usize..]);
    let largest_m = last_m.iter().fold(0.0, |a: f64, half| a.max(half.1));
    within.then(|| {
        (
            ring_down(&swings_of_mode(&half_swings(&tips_m), mode_hz)),
            largest_m,
        )
    })
}

/// What becomes of legs that are drawn, pushed by 5 N for a tenth of a second, or loaded by half a kilogram in 50 ms.
#[derive(Default)]
struct Found {
    /// Damping ratios of those whose first mode is below 8 Hz, from the lowest, for pushes and for payloads.
    ratios: [Vec<f64>; 2],
    /// The time to a tenth of those with a faster mode, s.
    fast_s: Vec<f64>,
    /// The farthest that any of them swings in the end, m.
    last_m: f64,
    /// How many leave the tensions within which they ring down.
    left_out: usize,
}

impl Found {
    fn add(&mut self, i: usize, hz: f64, found: Option<RingDown>, last_m: f64) {
        self.last_m = self.last_m.max(last_m);
        match found {
            Some(found) if hz > FAST_HZ => self.fast_s.push(found.tenth_s),
            Some(found) => self.ratios[i].push(found.ratio),
            None => {}
        }
    }
}

fn ring_downs(rig: &RigFile, seeds: &[u64], count: u32) -> Found {
    let mut all = Found::default();
    for &seed in seeds {
        add_ring_downs(rig, seed, count, &mut all);
    }
    for ratios in &mut all.ratios {
        ratios.sort_by(f64::total_cmp);
    }
    println!("damping ratios {:.3?}", all.ratios);
    println!(
        "fast modes to a tenth in {:.2?} s; {} left out",
        all.fast_s, all.left_out
    );
    all
}

fn add_ring_downs(rig: &RigFile, seed: u64, count: u32, all: &mut Found) {
    let mut rng = Rng::with_seed(seed);
    for number in 0..count {
        let (sound, leg) = drawn(rig, &mut rng);
        let mut pushed = sound.clone();
        let plant = pushed.plant();
        plant.push(plant.transverse(360.0 * rng.f64()) * 5.0, 0.1, 0.0);
        let mut loaded = sound;
        loaded.plant().set_payload(leg.payload_kg + 0.5, 0.05);
        let disturbances = [(pushed, 0.1, 0.0), (loaded, 0.05, 0.5)];
        for (i, (mut stand, for_s, more_kg)) in disturbances.into_iter().enumerate() {
            let hz = leg.first_mode_hz(rig, more_kg);
            let Some((found, last_m)) = disturbed(&mut stand, for_s, hz) else {
                all.left_out += 1;
                continue;
            };
            println!("seed {seed}, {number}, {i}: {hz:.1} Hz, {found:?}, {last_m} m in the end");
            all.add(i, hz, found, last_m);
        }
    }
}

#[test]
fn a_leg_that_is_pushed_or_loaded_rings_down() {
    const SEEDS: [u64; 3] = [17, 5, 23];
    const COUNT: u32 = 16;
    let found = ring_downs(&paper(), &SEEDS, COUNT);
    let disturbed = 2 * COUNT as usize * SEEDS.len();
    assert!(
        found.left_out <= disturbed / 4,
        "{} left out",
        found.left_out
    );
    for ratios in &found.ratios {
        assert!(ratios.len() >= disturbed / 6, "{} swing", ratios.len());
        assert!(ratios[0] >= 0.2 && ratios[ratios.len() / 2] > 0.3);
    }
    assert!(found.fast_s.len() > 4 && found.fast_s.iter().all(|&tenth_s| tenth_s <= 0.4));
    assert!(found.last_m < REST_M, "one swings on by {} m", found.last_m);
}

/// Without the brake the ratios are 0.02 to 0.06, and some swing for longer than is watched: the bounds above can fail.
#[test]
fn a_leg_that_is_not_braked_rings_on() {
    let mut rig = paper();
    rig.gains.motion.damping_ratio = 0.0;
    let found = ring_downs(&rig, &[17], 6);
    for ratios in &found.ratios {
        assert!(ratios[ratios.len() / 2] < 0.07);
    }
    assert!(found.last_m > REST_M);
}

/// The same of the legs with other supports.
#[test]
fn a_leg_with_any_support_rings_down() {
    const SEEDS: [u64; 1] = [29];
    const COUNT: u32 = 5;
    let mut counted = 0;
    for ready in &READY_RIGS[1..] {
        let rig = RigFile::load(Some(ready.name.as_ref())).unwrap();
        let found = ring_downs(&rig, &SEEDS, COUNT);
        let ratios = found.ratios.iter().flatten();
        assert!(ratios.clone().all(|&ratio| ratio >= 0.2), "{}", ready.name);
        assert!(found.fast_s.iter().all(|&tenth_s| tenth_s <= 0.4));
        assert!(found.last_m < REST_M, "{}: {} m", ready.name, found.last_m);
        counted += ratios.count() + found.fast_s.len();
    }
    assert!(counted >= 4 * (READY_RIGS.len() - 1), "{counted}");
}

/// Legs that their settings do not describe, or with a cell that is off, keep the bars by one and a half.
#[test]
fn a_leg_unlike_its_settings_rings_down() {
    const SEEDS: [u64; 1] = [41];
    const COUNT: u32 = 6;
    for (unlike, rig) in unlike_rigs().chain(rigs_with_a_cell_off()) {
        let found = ring_downs(&rig, &SEEDS, COUNT);
        let ratios = found.ratios.iter().flatten();
        assert!(ratios.clone().all(|&ratio| ratio >= 0.2 / 1.5), "{unlike}");
        assert!(
            found.fast_s.iter().all(|&tenth_s| tenth_s <= 0.6),
            "{unlike}"
        );
        assert!(found.last_m < 1.5 * REST_M, "{unlike}: {} m", found.last_m);
        assert!(ratios.count() + found.fast_s.len() >= 6, "{unlike}");
    }
}
