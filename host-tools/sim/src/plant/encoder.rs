//! An encoder and its counter.

use super::defect::{Defect, Defects};
use fastrand::Rng;
use leg_base::tick_time::tick_s;
use std::f64::consts::TAU;

/// Counts of a burst that are none, and bursts in a second.
const BURST: u16 = 50;
const BURSTS_PER_S: f64 = 20.0;

/// The counter of one motor; it wraps.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Encoder {
    /// Its motor.
    motor: usize,
    /// What it shows.
    pub counter: u16,
    /// Counts that passed its head.
    passed: i64,
    /// Whether it is wired to count down while the tendon is pulled in.
    downwards: bool,
    /// Counts since the last one that slipped, without their sign.
    since_slip: i64,
}

impl Encoder {
    /// At zero; `sign` is negative if it counts down while the tendon is pulled in.
    pub fn new(motor: usize, sign: f64) -> Self {
        Self {
            motor,
            downwards: sign < 0.0,
            ..Self::default()
        }
    }

    /// Follows the rotor, whose angle since the start is `angle_rad`.
    pub fn follow(&mut self, angle_rad: f64, counts_per_turn: f64, defects: &Defects) {
        // Far below 2⁵³ counts.
        let now = (angle_rad * (counts_per_turn / TAU)).floor() as i64;
        let mut seen = now - self.passed;
        self.passed = now;
        if defects.has(Defect::EncoderSlipping(self.motor)) {
            seen -= self.slipped(seen);
        }
        if defects.has(Defect::EncoderReversed(self.motor)) != self.downwards {
            seen = -seen;
        }
        if !defects.has(Defect::EncoderLost(self.motor)) {
            // The counter wraps: only the lowest bits of the sum matter.
            self.counter = self.counter.wrapping_add(seen as u16);
        }
    }

    /// Counts a burst now and then while it jumps.
    pub fn jump(&mut self, defects: &Defects, rng: &mut Rng) {
        if defects.has(Defect::EncoderJumps(self.motor)) && rng.f64() < BURSTS_PER_S * tick_s() {
            let burst = if rng.bool() {
                BURST
            } else {
                BURST.wrapping_neg()
            };
            self.counter = self.counter.wrapping_add(burst);
        }
    }

    /// How many of these counts slip.
    fn slipped(&mut self, seen: i64) -> i64 {
        self.since_slip += seen.abs();
        let lost = self.since_slip / 10;
        self.since_slip %= 10;
        lost * seen.signum()
    }
}
