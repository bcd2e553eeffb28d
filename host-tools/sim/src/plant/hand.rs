//! What a user does to actuators and sensors by hand: turning screws and hanging weights on load cells.

use super::Plant;
use leg_base::tick_time::tick_s;
use std::f64::consts::TAU;

/// How fast a hand turns a motor, rad/s.
const TURNING_RAD_PER_S: f64 = TAU;

/// What is being done by hand.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Hand {
    /// How far each motor is still turned, rad.
    pub left_rad: [f64; 3],
    /// What hangs on each load cell in the place of its tendon, N.
    pub hung_n: [Option<f64>; 3],
}

impl Hand {
    /// What pulls at the load cells.
    pub fn pulls_n(&self, tensions_n: [f64; 3]) -> [f64; 3] {
        std::array::from_fn(|i| self.hung_n[i].unwrap_or(tensions_n[i]))
    }
}

impl Plant {
    /// Lets a hand turn a motor, one turn a second; positive turns pull the tendon in. The motor is counted from 0; for
    /// another than the three nothing happens.
    pub fn turn_motor(&mut self, motor: usize, turns: f64) {
        if let Some(left) = self.hand.left_rad.get_mut(motor)
            && turns.is_finite()
        {
            *left += turns * TAU;
        }
    }

    /// Takes a tendon off its load cell and hangs a weight there, N, or puts the tendon back. The cell is counted from 0.
    /// The leg does not feel it.
    pub fn hang_on_cell(&mut self, cell: usize, weight_n: Option<f64>) {
        if let Some(hung) = self.hand.hung_n.get_mut(cell) {
            *hung = weight_n;
        }
    }

    /// A tick of turning.
    pub(super) fn turn_by_hand(&mut self) {
        for (motor, left) in self.motors.iter_mut().zip(&mut self.hand.left_rad) {
            let step_rad = TURNING_RAD_PER_S * tick_s();
            let turned = left.clamp(-step_rad, step_rad);
            *left -= turned;
            motor.turn(turned);
        }
    }
}
