//! How a tip swings about where it comes to rest, and its damping ratio.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use super::station_stand::ticks;
use leg_bench::stand::Stand;
use leg_firmware::sensors::TICK_HZ;
use leg_firmware::supervisor::{FaultSet, State};
use nalgebra::Vector3;

/// The half swings of a tip, farthest to farthest, are told apart from what it creeps by this much, m.
const NOISE_M: f64 = 6e-6;

/// A half swing of less than this is not counted any more, m: half of what a move may swing to both sides. What friction and play of the
/// motors leave is less.
const LEAST_M: f64 = 1e-4;

/// A half swing that takes so many times as long as one of the first mode is none of it: the leg creeps to where its load is compensated.
const CREEP: f64 = 2.0;

/// For how much longer a leg on which a tendon was slack is watched, s.
const LEFT_OUT_S: f64 = 2.0;

/// The true tensions within which a leg rings down by its brake, N: below them a tendon is slack, and in the last 4 N below the maximum of
/// 150 N a motor is slowed down.
pub const WITHIN_N: std::ops::Range<f64> = 2.0..146.0;

/// Half swings of a tip along the direction in which it goes farthest from where it ends: time, s, and size, m.
pub fn half_swings(tips_m: &[Vector3<f64>]) -> Vec<(f64, f64)> {
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
pub fn swings_of_mode(halves: &[(f64, f64)], mode_hz: f64) -> Vec<(f64, f64)> {
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
pub struct RingDown {
    /// Damping ratio by the mean logarithmic decrement of half swings.
    pub ratio: f64,
    /// The time after which half swings are less than a tenth of the first, s.
    pub tenth_s: f64,
}

/// None without two half swings, or where the first is not twice as much as is counted: one of 0.11 mm before one of 10 µm would have a
/// ratio of 0.03.
pub fn ring_down(halves: &[(f64, f64)]) -> Option<RingDown> {
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

/// What becomes of a leg that was disturbed.
#[derive(Debug)]
pub struct Disturbed {
    /// Whether a true tension leaves [`WITHIN_N`] by the disturbance itself: from its begin to a period of the first mode after its end.
    pub left_out: bool,
    /// How it rings down for two seconds from when the disturbance is over.
    pub ring_down: Option<RingDown>,
    /// By how much the tip still swings in the last half a second of these two, or of [`LEFT_OUT_S`] more where it is left out, m.
    pub last_m: f64,
    /// What the leg does in the end, and its faults: a leg that is held does not brake its swing.
    pub state: State,
    pub faults: FaultSet,
}

impl Disturbed {
    /// Of a leg with a first mode, Hz, and a disturbance of some time, s, that begins now.
    pub fn new(stand: &mut Stand, for_s: f64, mode_hz: f64) -> Self {
        let (begins, given) = (ticks(for_s), ticks(for_s + 1.0 / mode_hz));
        let (mut left_out, mut tips_m) = (false, Vec::new());
        for tick in 0..ticks(for_s + 2.0) {
            stand.tick().unwrap();
            let mut tensions_n = stand.truth.tensions_n.iter();
            left_out |= tick < given && !tensions_n.all(|tension_n| WITHIN_N.contains(tension_n));
            if tick >= begins {
                tips_m.push(stand.truth.tip_m);
            }
        }
        let ring_down = ring_down(&swings_of_mode(&half_swings(&tips_m), mode_hz));
        if left_out {
            // It swings farther than a tendon is taut, and comes to rest later.
            let tip_m = |_| {
                stand.tick().unwrap();
                stand.truth.tip_m
            };
            tips_m.extend((0..ticks(LEFT_OUT_S)).map(tip_m));
        }
        let last_m = half_swings(&tips_m[tips_m.len() - ticks(0.5) as usize..]);
        Self {
            left_out,
            ring_down,
            last_m: last_m.iter().fold(0.0, |a: f64, half| a.max(half.1)),
            state: stand.state(),
            faults: stand.telemetry.unwrap().faults,
        }
    }
}
