//! What the defects of load cells and their wires make of the signals.

use super::defect::{Defect, Defects};
use super::noise::{defect_rng, gaussian};
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

/// Part of the next cell's tension that crosses over.
const CROSSTALK: f64 = 0.15;

/// How far the tension is ahead of a cell that sticks, N.
const STICKING_N: f64 = 5.0;

/// How late a slow cell is, ticks.
const LATE_TICKS: usize = 160;

/// Noise beside a motor's wire at its full duty, and the offset, N.
const PWM_N: f64 = 20.0;

/// What the defects know of the past.
#[derive(Clone, Debug)]
pub(super) struct CellDefects {
    rng: Rng,
    ranges_n: [[f64; 2]; 3],
    /// What each cell showed last, N, or to where it has wandered.
    shown_n: [f64; 3],
    /// Turns that the hum is ahead.
    hum_phase: f64,
    /// What each cell has shown in the last ticks, N.
    history_n: [[f64; LATE_TICKS]; 3],
}

impl CellDefects {
    pub fn new(ranges_n: [[f64; 2]; 3], offsets_n: [f64; 3], seed: u64) -> Self {
        let mut rng = defect_rng(seed);
        Self {
            hum_phase: rng.f64(),
            rng,
            ranges_n,
            shown_n: offsets_n,
            history_n: offsets_n.map(|offset| [offset; LATE_TICKS]),
        }
    }

    /// A tick of wandering.
    pub fn advance(&mut self, defects: &Defects) {
        for i in 0..3 {
            if defects.has(Defect::CellWanders(i)) {
                let step_n = WANDERING_N * tick_s().sqrt() * gaussian(&mut self.rng);
                let [low, high] = self.ranges_n[i];
                self.shown_n[i] = (self.shown_n[i] + step_n).clamp(low, high);
            }
        }
    }

    /// What the cells show but for their noise at a tick, N, of tensions with each cell's gain, each cell's offset
    /// and the duties of the motors.
    pub fn shown_n(
        &mut self,
        pulls_n: [f64; 3],
        offsets_n: [f64; 3],
        duties: [f64; 3],
        defects: &Defects,
        tick: u64,
    ) -> [f64; 3] {
        let own_n = |i: usize| {
            let own = pulls_n[i] * gain(i, defects, tick);
            let crosses = defects.has(Defect::CellCrosstalk(i));
            let next = if crosses { CROSSTALK } else { 0.0 } * pulls_n[(i + 1) % 3];
            own + next + offset_n(i, offsets_n, defects)
        };
        let slot = (tick % LATE_TICKS as u64) as usize;
        for (i, duty) in duties.into_iter().enumerate() {
            let now_n = own_n(source(i, defects));
            let late_n = std::mem::replace(&mut self.history_n[i][slot], now_n);
            self.shown_n[i] = if defects.has(Defect::CellHum(i)) {
                self.hum_n(i, tick)
            } else if defects.has(Defect::CellWanders(i)) {
                self.shown_n[i]
            } else if defects.has(Defect::CellLate(i)) {
                late_n
            } else if defects.has(Defect::CellSticks(i)) {
                self.shown_n[i].clamp(now_n - STICKING_N, now_n + STICKING_N)
            } else if defects.has(Defect::CellPwmNoise(i)) {
                now_n + PWM_N * duty * (1.0 + gaussian(&mut self.rng))
            } else {
                now_n
            };
        }
        self.shown_n
    }

    fn hum_n(&self, cell: usize, tick: u64) -> f64 {
        let turns = HUM_HZ * tick as f64 * tick_s() + self.hum_phase;
        let [low_n, high_n] = self.ranges_n[cell];
        let middle_n = 0.5 * (low_n + high_n);
        middle_n + HUM_N * libm::sin(TAU * turns)
    }
}

/// The cell whose signal is read in the place of a cell's.
fn source(cell: usize, defects: &Defects) -> usize {
    if defects.has(Defect::CellFollows(cell)) {
        (cell + 1) % 3
    } else if defects.has(Defect::CellsSwapped) && cell < 2 {
        1 - cell
    } else {
        cell
    }
}

/// Part of a tension that a cell shows.
fn gain(cell: usize, defects: &Defects, tick: u64) -> f64 {
    let since_s = |defect| {
        defects
            .first_tick(defect)
            .map(|began| (tick - began) as f64 * tick_s())
    };
    let lost = defects.has(Defect::CellExcitationLost(cell)) || defects.has(Defect::ExcitationLost);
    let faded = since_s(Defect::CellFades(cell)).map_or(0.0, |s| s / FADE_S);
    let drifted = |defect| since_s(defect).map_or(0.0, |s| (s / GAIN_DRIFT_S).min(1.0));
    let step = |defect| f64::from(defects.has(defect));
    let off = step(Defect::CellGainStep(cell)) - step(Defect::CellGainStepDown(cell))
        + drifted(Defect::CellGainDrift(cell))
        - drifted(Defect::CellGainDriftDown(cell))
        - step(Defect::ExcitationSags);
    let left = if lost { 0.0 } else { (1.0 - faded).max(0.0) };
    let sign = if defects.has(Defect::CellReversed(cell)) {
        -1.0
    } else {
        1.0
    };
    sign * left * (1.0 + GAIN_ERROR * off)
}

fn offset_n(cell: usize, offsets_n: [f64; 3], defects: &Defects) -> f64 {
    let step = |defect| f64::from(defects.has(defect));
    let off = step(Defect::CellOffsetStep(cell)) - step(Defect::CellOffsetStepDown(cell));
    offsets_n[cell] + OFFSET_STEP_N * off
}
