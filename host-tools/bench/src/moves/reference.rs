//! Where the trajectory has the tip, for each tick.

use crate::stand::Stand;
use nalgebra::Vector3;

/// The last two targets. A target is led to within a cycle: the leg shall be there when the next one comes.
pub(super) struct Reference {
    tip_length_m: f64,
    last: Option<[f32; 2]>,
    tip_m: Option<Vector3<f64>>,
}

impl Reference {
    pub fn new(tip_length_m: f64) -> Self {
        Self {
            tip_length_m,
            last: None,
            tip_m: None,
        }
    }

    /// From the reference to the true tip, m, in the ticks in which the next target comes: the tip is that after the tick before.
    pub fn tip_error_m(&mut self, stand: &Stand) -> Option<Vector3<f64>> {
        let target = stand.telemetry.as_ref()?.target;
        let before_m = self.tip_m.replace(stand.truth.tip_m);
        if self.last == Some(target) {
            return None;
        }
        let last = self.last.replace(target)?;
        let [x, y] = last.map(f64::from);
        let z = -(1.0 - x * x - y * y).max(0.0).sqrt();
        Some(before_m? - Vector3::new(x, y, z) * self.tip_length_m)
    }
}
