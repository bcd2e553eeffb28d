//! What the defects of load cells and their wires make of the signals.

use super::defect::{Defect, Defects};
use super::noise::{gaussian, of_defects};
use fastrand::Rng;
use leg_base::tick_time::tick_s;
use std::f64::consts::TAU;

/// How far a floating input wanders in a second, N; in t seconds it is √t times that.
const WANDERING_N: f64 = 20.0;

/// Amplitude of hum, N, and its frequency, Hz.
const HUM_N: f64 = 10.0;
const HUM_HZ: f64 = 50.0;

/// Part by which a gain is off.
const GAIN_ERROR: f64 = 0.2;

const OFFSET_STEP_N: f64 = 10.0;

/// Times in which a gain fades to nothing, and in which it drifts, s.
const FADE_S: f64 = 0.5;
const GAIN_DRIFT_S: f64 = 10.0;

/// What the defects know of the past.
#[derive(Clone, Debug)]
pub(super) struct CellDefects {
    rng: Rng,
    range_n: [f64; 2],
    /// What each cell showed last, N, or to where it has wandered.
    shown_n: [f64; 3],
    /// Turns that the hum is ahead.
    hum_phase: f64,
}

impl CellDefects {
    pub fn new(range_n: [f64; 2], offsets_n: [f64; 3], seed: u64) -> Self {
        let mut rng = of_defects(seed);
        Self {
            hum_phase: rng.f64(),
            rng,
            range_n,
            shown_n: offsets_n,
        }
    }

    /// A tick of wandering.
    pub fn advance(&mut self, defects: &Defects) {
        for i in 0..3 {
            if defects.has(Defect::CellWanders(i)) {
                let step_n = WANDERING_N * tick_s().sqrt() * gaussian(&mut self.rng);
                let [low, high] = self.range_n;
                self.shown_n[i] = (self.shown_n[i] + step_n).clamp(low, high);
            }
        }
    }

    /// What the cells show but for their noise at a tick, N, of tensions with each cell's gain, and each cell's offset.
    pub fn shown_n(
        &mut self,
        pulls_n: [f64; 3],
        offsets_n: [f64; 3],
        defects: &Defects,
        tick: u64,
    ) -> [f64; 3] {
        let own_n =
            |i: usize| pulls_n[i] * gain(i, defects, tick) + offset_n(i, offsets_n, defects);
        for i in 0..3 {
            if defects.has(Defect::CellHum(i)) {
                let turns = HUM_HZ * tick as f64 * tick_s() + self.hum_phase;
                let middle_n = 0.5 * (self.range_n[0] + self.range_n[1]);
                self.shown_n[i] = middle_n + HUM_N * (TAU * turns).sin();
            } else if defects.has(Defect::CellFollows(i)) {
                self.shown_n[i] = own_n((i + 1) % 3);
            } else if !defects.has(Defect::CellWanders(i)) {
                self.shown_n[i] = own_n(i);
            }
        }
        self.shown_n
    }
}

/// Part of a tension that a cell shows.
fn gain(cell: usize, defects: &Defects, tick: u64) -> f64 {
    let since_s = |defect| {
        defects
            .since(defect)
            .map(|began| (tick - began) as f64 * tick_s())
    };
    let lost = defects.has(Defect::CellExcitationLost(cell));
    let faded = since_s(Defect::CellFades(cell)).map_or(0.0, |s| s / FADE_S);
    let drifted = |defect| since_s(defect).map_or(0.0, |s| (s / GAIN_DRIFT_S).min(1.0));
    let step = |defect| f64::from(defects.has(defect));
    let off = step(Defect::CellGainStep(cell)) - step(Defect::CellGainStepDown(cell))
        + drifted(Defect::CellGainDrift(cell))
        - drifted(Defect::CellGainDriftDown(cell));
    let left = if lost { 0.0 } else { (1.0 - faded).max(0.0) };
    left * (1.0 + GAIN_ERROR * off)
}

fn offset_n(cell: usize, offsets_n: [f64; 3], defects: &Defects) -> f64 {
    let step = |defect| f64::from(defects.has(defect));
    let off = step(Defect::CellOffsetStep(cell)) - step(Defect::CellOffsetStepDown(cell));
    offsets_n[cell] + OFFSET_STEP_N * off
}
