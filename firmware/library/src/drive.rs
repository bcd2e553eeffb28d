//! What a tick asks of the motors.

use crate::control::bounds::clamp_symmetric;
use leg_model::Scalar;
use postcard_schema::Schema;
use serde::{Deserialize, Serialize};

/// The motors' drivers until the next tick.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, Schema)]
pub struct Drive<T> {
    /// Part of the supply at each motor, −1 to 1; positive pulls the tendon in.
    pub duty: [T; 3],
    /// Whether the drivers' outputs are on. Off, the motors are open and the screws hold.
    pub enabled: bool,
}

impl<T: Scalar> Drive<T> {
    /// Puts a voltage at a motor, from 0, V.
    pub(crate) fn push(&mut self, motor: usize, voltage_v: T, supply_v: T) {
        if let Some(duty) = self.duty.get_mut(motor)
            && supply_v > T::one()
        {
            *duty = clamp_symmetric(voltage_v / supply_v, T::one());
        }
    }
}
