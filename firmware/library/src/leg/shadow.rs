//! What a host's f64 shadow of the control law needs; no board has one.

use super::Leg;
use crate::drive::Drive;

impl Leg<f64> {
    /// Goes on from the duties that the leg on the motors has applied in this tick: the shadow's integrals are not on its own
    /// motors, and would wander.
    pub fn adopt_drive(&mut self, applied: &Drive<f64>) {
        let supply_v = self.measured.map_or(0.0, |measured| measured.supply_v);
        for (axis, &duty) in self.shared.axes.iter_mut().zip(&applied.duty) {
            axis.adopt_voltage(duty * supply_v);
        }
    }
}
