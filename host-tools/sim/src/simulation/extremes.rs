//! The extremes since a mark.

use crate::plant::Truth;
use leg_base::tick_time::tick_s;
use nalgebra::Vector3;

/// How far beyond its bounds a tension may be for a short time, as a part of the bound.
const BEYOND: f64 = 0.05;

/// Lowest and highest of no tension.
pub(super) const NO_RANGE: [f64; 2] = [f64::INFINITY, f64::NEG_INFINITY];

/// The lowest and the highest of a range and the tensions, N.
pub(super) fn range_with_tensions([low, high]: [f64; 2], truth: &Truth) -> [f64; 2] {
    let tensions = truth.tensions_n.into_iter();
    [
        tensions.clone().fold(low, f64::min),
        tensions.fold(high, f64::max),
    ]
}

/// The extremes since a mark.
#[derive(Clone, Copy, Debug)]
pub(super) struct Extremes {
    /// Lowest and highest tension, N.
    pub tensions_n: [f64; 2],
    /// Longest time outside the bounds, ms.
    pub outside_ms: f64,
    pub tip_moved_mm: f64,
    tip_m: Vector3<f64>,
    outside_now_ms: f64,
}

impl Extremes {
    pub fn new(truth: &Truth) -> Self {
        Self {
            tensions_n: NO_RANGE,
            outside_ms: 0.0,
            tip_moved_mm: 0.0,
            tip_m: truth.tip_m,
            outside_now_ms: 0.0,
        }
    }

    pub fn take(&mut self, truth: &Truth, [f_min_n, f_max_n]: [f64; 2]) {
        self.tensions_n = range_with_tensions(self.tensions_n, truth);
        let [lowest, highest] = range_with_tensions(NO_RANGE, truth);
        let outside = lowest < f_min_n * (1.0 - BEYOND) || highest > f_max_n * (1.0 + BEYOND);
        self.outside_now_ms = if outside {
            self.outside_now_ms + tick_s() * 1000.0
        } else {
            0.0
        };
        self.outside_ms = self.outside_ms.max(self.outside_now_ms);
        self.tip_moved_mm = self
            .tip_moved_mm
            .max((truth.tip_m - self.tip_m).norm() * 1000.0);
    }
}
