//! How a leg that is pushed, or has a payload hung on it, comes to rest.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use super::half_swings::Disturbed;
use super::station_stand::paper;
use crate::common::require_said;
use crate::common::unlike::{
    has_other_tendons, rigs_with_a_cell_off, rigs_with_other_tendons_like, unlike_rigs,
};
use fastrand::Rng;
use leg_bench::stand::{Stand, move_to};
use leg_firmware::command::Command;
use leg_firmware::supervisor::State;
use leg_model::{StiffnessAt, evaluate};
use leg_rig::ready_rigs::READY_RIGS;
use leg_rig::rig_file::RigFile;
use leg_sim::plant::Start;

/// What a tip may still swing in the end, from farthest to farthest, m.
pub const REST_M: f64 = 6e-5;

/// First mode, Hz, below which the ratio is asked for; above it the time to a tenth.
pub const FAST_HZ: f64 = 8.0;

/// The least damping ratio, and the longest time to a tenth, s.
pub const RATIO: f64 = 0.2;
pub const TENTH_S: f64 = 0.4;

/// Time in which a payload is hung on, s.
pub const LOADING_S: f64 = 0.05;

/// The part of the pushed, and of the loaded, that may leave the tensions within which a leg rings down: 5 N at the tip change a tension by up
/// to 45 N at once, and any feasible pretension is drawn.
const LEFT_OUT_PARTS: [f64; 2] = [0.7, 0.2];

/// A leg at rest.
#[derive(Clone, Debug)]
pub struct Leg {
    pose_deg: [f64; 2],
    pub payload_kg: f64,
    pretension_n: f64,
}

impl Leg {
    /// Its first mode by the model with so much more payload, kg, Hz.
    pub fn first_mode_hz(&self, rig: &RigFile, more_kg: f64) -> f64 {
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

/// The heaviest payload, and what is hung on beside it, kg.
pub const PAYLOAD_MAX_KG: f64 = 2.0;
pub const MORE_KG: f64 = 0.5;

/// How far from the lowest and the highest pretension that the pose allows with either payload, N. What the estimate of the load is off by
/// shall not end a feasible one, and no tendon is pulled by more than 4 N below its maximum. Of 600 legs of the paper's rig two that are
/// pushed have less than 0.2: 0.137 (seed 23, #72), with 1.9 kg near the vertical, where nothing shows that, and 0.187 (seed 17, #0).
const ROOM_N: [f64; 2] = [4.0, 5.0];

/// A leg that follows commands at rest, at a pose with a payload and a pretension that are drawn.
pub fn drawn(rig: &RigFile, rng: &mut Rng) -> (Stand, Leg) {
    loop {
        let tilt_max_deg = rig.tilt_deg.min(30.0);
        let pose_deg @ [azimuth_deg, tilt_deg] = [360.0 * rng.f64(), tilt_max_deg * rng.f64()];
        let payload_kg = PAYLOAD_MAX_KG * rng.f64();
        let loads_kg = [payload_kg, payload_kg + MORE_KG];
        let ranges_n = loads_kg
            .into_iter()
            .filter(|&load_kg| load_kg <= PAYLOAD_MAX_KG)
            .map(|load_kg| {
                let query = rig.query(azimuth_deg, tilt_deg, load_kg);
                let found = evaluate(&rig.parameters, &query);
                found.unwrap().pretension_range_n
            });
        let both = |a: [f64; 2], b: [f64; 2]| [a[0].max(b[0]), a[1].min(b[1])];
        let [low, high] = ranges_n.reduce(both).unwrap();
        let (low, high) = (low + ROOM_N[0], high - ROOM_N[1]);
        if low > high {
            continue;
        }
        let pretension_n = low + (high - low) * rng.f64();
        let leg = Leg {
            pose_deg,
            payload_kg,
            pretension_n,
        };
        let mut stand = started(rig, &leg, rng.u64(..));
        let pretension = Command::Pretension(pretension_n as f32);
        stand.command(&pretension).unwrap();
        stand.command(&move_to(pose_deg)).unwrap();
        stand.wait(2.5).unwrap();
        assert_eq!(stand.state(), State::Active);
        return (stand, leg);
    }
}

/// A leg that follows commands: armed where it is drawn, or homed, and loaded then, where it has to measure its tendons.
fn started(rig: &RigFile, leg: &Leg, seed: u64) -> Stand {
    let [azimuth_deg, tilt_deg] = leg.pose_deg;
    let homes = has_other_tendons(rig);
    let (start, command) = if homes {
        (Start::Slack { slack_mm: 2.0 }, Command::Home)
    } else {
        let held = Start::Held {
            azimuth_deg,
            tilt_deg,
            pretension_n: leg.pretension_n,
            payload_kg: leg.payload_kg,
        };
        (held, Command::Arm)
    };
    let mut stand = Stand::new(rig, &rig.plant, start, seed).unwrap();
    stand.wait(0.1).unwrap();
    stand.command(&command).unwrap();
    if homes {
        stand
            .tick_until(30.0, "active", |stand| stand.state() == State::Active)
            .unwrap();
        stand.wait(3.0).unwrap();
        stand.plant().set_payload(leg.payload_kg, 0.4);
        stand.wait(1.0).unwrap();
    }
    stand.wait(0.4).unwrap();
    stand
}

/// What becomes of legs that are drawn, pushed by 5 N for a tenth of a second, or loaded by half a kilogram in 50 ms.
#[derive(Default)]
struct Found {
    /// Damping ratios of those whose first mode is below 8 Hz, from the lowest, for pushes and for payloads.
    ratios: [Vec<f64>; 2],
    /// The time to a tenth of those with a faster mode, s.
    fast_s: Vec<f64>,
    /// The farthest that any that is still active swings in the end, m.
    last_m: f64,
    /// What is beyond its bar.
    failures: Vec<String>,
    /// How many were pushed and how many loaded, and how many of each leave the tensions within which they ring down.
    disturbed: [usize; 2],
    left_out: [usize; 2],
}

impl Found {
    /// A third of the disturbed have a ratio or a time.
    fn require_enough(&self, name: &str) {
        let counted = self.ratios.iter().flatten().count() + self.fast_s.len();
        let disturbed: usize = self.disturbed.iter().sum();
        assert!(
            3 * counted >= disturbed,
            "{name}: {counted} of {disturbed} swing"
        );
    }

    /// No more than a part of the pushed and of the loaded leave the tensions within which they ring down.
    fn require_few_left_out(&self, name: &str) {
        let part = |(&left_out, &disturbed): (&usize, &usize)| left_out as f64 / disturbed as f64;
        let parts = self.left_out.iter().zip(&self.disturbed).map(part);
        let kept = parts.zip(LEFT_OUT_PARTS).all(|(part, bar)| part <= bar);
        assert!(
            kept,
            "{name}: {:?} of {:?} left out",
            self.left_out, self.disturbed
        );
    }

    /// A leg whose swing takes a tendon out of what it rings down within only comes to rest, or is held. By so many times the bars.
    fn add(&mut self, i: usize, hz: f64, found: &Disturbed, times: f64, what: &str) {
        self.disturbed[i] += 1;
        self.left_out[i] += usize::from(found.left_out);
        let active = found.state == State::Active;
        if active {
            self.last_m = self.last_m.max(found.last_m);
        }
        let mut kept = if active {
            found.last_m < times * REST_M
        } else {
            found.left_out && found.faults.stopping().any()
        };
        match found.ring_down.filter(|_| !found.left_out) {
            Some(found) if hz > FAST_HZ => {
                self.fast_s.push(found.tenth_s);
                kept &= found.tenth_s <= times * TENTH_S;
            }
            Some(found) => {
                self.ratios[i].push(found.ratio);
                kept &= found.ratio >= RATIO / times;
            }
            None => {}
        }
        if !kept {
            self.failures.push(what.into());
        }
    }
}

/// How legs ring down that are drawn from these seeds, so many of each, and which keep not so many times the bars.
fn ring_downs(rig: &RigFile, seeds: &[u64], count: u32, times: f64) -> Found {
    let mut all = Found::default();
    for &seed in seeds {
        let mut rng = Rng::with_seed(seed);
        for number in 0..count {
            let drawn = drawn(rig, &mut rng);
            let what = format!("seed {seed}, {number}");
            add_ring_downs(rig, drawn, &mut rng, times, &what, &mut all);
        }
    }
    for ratios in &mut all.ratios {
        ratios.sort_by(f64::total_cmp);
    }
    println!("damping ratios {:.3?}", all.ratios);
    println!(
        "fast modes to a tenth in {:.2?} s; {:?} of {:?} pushed and loaded left out",
        all.fast_s, all.left_out, all.disturbed
    );
    all
}

/// Pushes a leg, and hangs a payload on it if it may carry that.
fn add_ring_downs(
    rig: &RigFile,
    (sound, leg): (Stand, Leg),
    rng: &mut Rng,
    times: f64,
    what: &str,
    all: &mut Found,
) {
    let mut pushed = sound.clone();
    let plant = pushed.plant();
    plant.push(plant.transverse(360.0 * rng.f64()) * 5.0, 0.1, 0.0);
    let mut disturbances = vec![(pushed, 0.1, 0.0)];
    if leg.payload_kg + MORE_KG <= PAYLOAD_MAX_KG {
        let mut loaded = sound;
        loaded
            .plant()
            .set_payload(leg.payload_kg + MORE_KG, LOADING_S);
        disturbances.push((loaded, LOADING_S, MORE_KG));
    }
    for (i, (mut stand, for_s, more_kg)) in disturbances.into_iter().enumerate() {
        let hz = leg.first_mode_hz(rig, more_kg);
        let found = Disturbed::new(&mut stand, for_s, hz);
        let what = format!("{what}, {i}: {hz:.1} Hz, {found:.6?}, {leg:.2?}");
        println!("{what}");
        all.add(i, hz, &found, times, &what);
    }
}

#[test]
fn a_leg_that_is_pushed_or_loaded_rings_down() {
    let [low_n, high_n] = ROOM_N;
    require_said(
        "host-tools/docs/scenarios.md",
        &[
            format!("a damping ratio of {RATIO} or more"),
            format!("falls to a tenth within {TENTH_S} s"),
            format!("up to {PAYLOAD_MAX_KG} kg, and from {low_n} N above the lowest"),
            format!("to {high_n} N below the highest"),
        ],
    );
    const SEEDS: [u64; 3] = [5, 101, 102];
    const COUNT: u32 = 40;
    let found = ring_downs(&paper(), &SEEDS, COUNT, 1.0);
    let disturbed = COUNT as usize * SEEDS.len();
    assert!(found.disturbed[0] == disturbed && found.disturbed[1] > disturbed / 2);
    found.require_few_left_out("table1");
    for (ratios, disturbed) in found.ratios.iter().zip(found.disturbed) {
        assert!(ratios.len() >= disturbed / 3, "{} swing", ratios.len());
        assert!(ratios[ratios.len() / 2] > 0.3);
    }
    assert!(found.fast_s.len() > 4);
    assert!(found.failures.is_empty(), "{:#?}", found.failures);
}

/// Without the brake the ratios are 0.02 to 0.06, and some swing for longer than is watched: the bounds above can fail.
#[test]
fn a_leg_that_is_not_braked_rings_on() {
    let mut rig = paper();
    rig.gains.motion.damping_ratio = 0.0;
    let found = ring_downs(&rig, &[17], 6, 1.0);
    for ratios in &found.ratios {
        assert!(ratios[ratios.len() / 2] < 0.07);
    }
    assert!(found.last_m > REST_M);
}

/// The same of the legs with other supports.
#[test]
fn a_leg_with_any_support_rings_down() {
    const SEEDS: [u64; 2] = [29, 37];
    const COUNT: u32 = 12;
    for ready in &READY_RIGS[1..] {
        let rig = RigFile::load(Some(ready.name.as_ref())).unwrap();
        println!("{}:", ready.name);
        let found = ring_downs(&rig, &SEEDS, COUNT, 1.0);
        found.require_few_left_out(ready.name);
        found.require_enough(ready.name);
        assert!(
            found.failures.is_empty(),
            "{}: {:#?}",
            ready.name,
            found.failures
        );
    }
}

/// Legs that their settings do not describe, or with a cell that is off, keep the bars by one and a half. Of seed 41 one, without play, still
/// swings by 0.0908 mm in the end (#13).
#[test]
fn a_leg_unlike_its_settings_rings_down() {
    const SEEDS: [u64; 1] = [43];
    const COUNT: u32 = 16;
    let unlike = unlike_rigs()
        .chain(rigs_with_a_cell_off())
        .chain(rigs_with_other_tendons_like(READY_RIGS[0].name));
    for (unlike, rig) in unlike {
        println!("{unlike}:");
        let found = ring_downs(&rig, &SEEDS, COUNT, 1.5);
        found.require_few_left_out(&unlike);
        found.require_enough(&unlike);
        assert!(found.failures.is_empty(), "{unlike}: {:#?}", found.failures);
    }
}
