//! What a user does to actuators and sensors by hand: turning screws and hanging weights on load cells.

use super::Plant;
use leg_base::tick_time::tick_s;
use nalgebra::Vector3;
use std::f64::consts::TAU;

/// How fast a hand turns a motor, rad/s.
const TURNING_RAD_PER_S: f64 = TAU;

/// How a hand holds the tip: stiffness, N/m, and damping, N·s/m.
const GRASP_N_PER_M: f64 = 5e3;
const GRASP_N_S_PER_M: f64 = 10.0;

/// What is being done by hand.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Hand {
    /// How far each motor is still turned, rad.
    pub left_rad: [f64; 3],
    /// What hangs on each load cell in the place of its tendon, N.
    pub hung_n: [Option<f64>; 3],
    /// Where the tip is held, m.
    pub grasped_m: Option<Vector3<f64>>,
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

    /// Puts a new tendon on in the place of a cut one: it has no tension where the leg is.
    pub(super) fn replace_tendon(&mut self, tendon: usize) {
        let kinematics = self.dynamics.kinematics(&self.leg);
        let elongations_m = self
            .dynamics
            .elongations_m(&kinematics, self.unstretched_m());
        let replaced = self.unstretched_at_zero_m.get_mut(tendon);
        if let (Some(unstretched_m), Some(elongation_m)) = (replaced, elongations_m.get(tendon)) {
            *unstretched_m += elongation_m;
        }
    }

    /// What a hand that holds the tip pulls at it, N.
    pub(super) fn grasp_n(&self) -> Vector3<f64> {
        let tip_m = self.tip_m();
        let speed = self.leg.rate.cross(&tip_m);
        self.hand.grasped_m.map_or(Vector3::zeros(), |held_m| {
            (held_m - tip_m) * GRASP_N_PER_M - speed * GRASP_N_S_PER_M
        })
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
