//! The supply of all motors, which sags under their currents.

use super::motor::{Motor, MotorType};

/// A voltage behind a resistance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Supply {
    /// Without a current, V.
    pub open_v: f64,
    pub resistance_ohm: f64,
}

impl Supply {
    /// The voltage at the drivers, V.
    pub fn voltage_v(&self, motors: &[Motor; 3]) -> f64 {
        self.loaded_voltage_v(motors, motors.map(|motor| motor.current_a))
    }

    fn loaded_voltage_v(&self, motors: &[Motor; 3], currents_a: [f64; 3]) -> f64 {
        let pairs = motors.iter().zip(currents_a);
        let drawn: f64 = pairs.map(|(motor, current)| motor.duty * current).sum();
        (self.open_v - self.resistance_ohm * drawn).max(0.0)
    }

    /// Takes the currents on by half a step, at the mean of the voltages before and after it.
    pub fn drive(&self, motors: &mut [Motor; 3], kinds: &[MotorType; 3]) {
        let before = self.voltage_v(motors);
        let tried = std::array::from_fn(|i| motors[i].next_current_a(&kinds[i], before));
        let mean = 0.5 * (before + self.loaded_voltage_v(motors, tried));
        for (motor, kind) in motors.iter_mut().zip(kinds) {
            motor.current_a = motor.next_current_a(kind, mean);
        }
    }
}
