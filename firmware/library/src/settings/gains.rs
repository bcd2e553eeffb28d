//! Gains and limits of the control law as a whole.

use super::{Estimation, Field, Homing, Limits, Motion, Servo};

/// Every section of gains by its name in files.
pub const SECTIONS: [(&str, &[Field]); 5] = [
    ("motion", Motion::FIELDS),
    (SERVO, Servo::FIELDS),
    ("estimation", Estimation::FIELDS),
    ("limits", Limits::FIELDS),
    ("homing", Homing::FIELDS),
];

/// The section that each motor has for itself.
pub const SERVO: &str = "servo";

/// Gains and limits.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Gains {
    /// How the leg moves.
    pub motion: Motion,
    /// How each motor follows.
    pub servos: [Servo; 3],
    /// How pose and load are estimated.
    pub estimation: Estimation,
    /// What is taken as a fault.
    pub limits: Limits,
    /// How the zero is found.
    pub homing: Homing,
}

impl Gains {
    /// The value of every field, in the order of [`SECTIONS`]; the servo of each motor has its turn.
    pub fn values(&self) -> impl Iterator<Item = f32> {
        let servos = self.servos.iter().flat_map(Servo::values);
        let gains = self.motion.values().into_iter().chain(servos);
        let gains = gains.chain(self.estimation.values());
        gains
            .chain(self.limits.values())
            .chain(self.homing.values())
    }

    /// The same, to be changed.
    pub fn values_mut(&mut self) -> impl Iterator<Item = &mut f32> {
        let servos = self.servos.iter_mut().flat_map(Servo::values_mut);
        let gains = self.motion.values_mut().into_iter().chain(servos);
        let gains = gains.chain(self.estimation.values_mut());
        gains
            .chain(self.limits.values_mut())
            .chain(self.homing.values_mut())
    }
}
