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

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test may panic")]
mod tests {
    use super::{Drive, Leg};
    use crate::control::Measured;
    use crate::settings::Settings;

    /// Of each motor by itself, at the supply that was measured.
    #[test]
    fn a_shadow_goes_on_from_the_voltages_that_the_motors_had() {
        let mut leg = Leg::<f64>::new(&Settings::table_1().unwrap()).unwrap();
        let measured = Measured::resting([0.0; 3], [1.0; 3]);
        leg.measured = Some(measured);
        let duty = [0.25, -0.5, 0.0];
        leg.adopt_drive(&Drive {
            duty,
            enabled: true,
        });
        for (axis, duty) in leg.shared.axes.iter().zip(duty) {
            assert_eq!(axis.applied().voltage_v, duty * measured.supply_v);
        }
    }
}
