//! The way that the tip of an unstruck leg takes.

use nalgebra::Vector3;

/// Distance of neighbouring points, m: small against what is judged.
const SPACING_M: f64 = 5e-5;

/// Where the tip of an unstruck leg comes by.
#[derive(Clone, Debug, Default)]
pub(super) struct Way {
    points: Vec<Vector3<f64>>,
}

impl Way {
    pub fn begin(tip_m: Vector3<f64>) -> Self {
        Self {
            points: vec![tip_m],
        }
    }

    pub fn add(&mut self, tip_m: Vector3<f64>) {
        let last = self.points.last();
        if last.is_none_or(|last| (tip_m - last).norm() >= SPACING_M) {
            self.points.push(tip_m);
        }
    }

    /// Distance of a tip from it, mm.
    pub fn distance_mm(&self, tip_m: &Vector3<f64>) -> f64 {
        let squares = self
            .points
            .iter()
            .map(|point| (point - tip_m).norm_squared());
        1000.0 * squares.fold(f64::INFINITY, f64::min).sqrt()
    }
}
