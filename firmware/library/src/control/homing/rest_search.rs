//! The pose in which a hanging leg rests on one tendon.

use crate::control::Mechanism;
use leg_model::{Direction, Elasticity, Error, Scalar, estimate_load, inverse_kinematics};
use nalgebra::SVector;

/// Steps of the search. Each divides what is out of balance by the stiffness of the weight alone, so it converges linearly;
/// the scenarios `homing` and `homing_again` hold the zero that twelve of them find.
const STEPS: u8 = 12;

/// Searches the pose in which a hanging leg rests on one tendon, one step a tick.
#[derive(Clone, Copy, Debug)]
pub struct RestSearch<T> {
    direction: Direction<T>,
    tension_n: T,
    pulled_m: T,
    steps: u8,
}

impl<T: Scalar> RestSearch<T> {
    /// Starts straight down, with the averages of tension, N, and travel, m.
    pub fn new(tension_n: T, pulled_m: T) -> Self {
        Self {
            direction: Direction::straight_down(),
            tension_n,
            pulled_m,
            steps: 0,
        }
    }

    /// The next step; at the end, the length of tendon `i` without tension when the board started, m.
    pub fn step(&mut self, mechanism: &Mechanism<T>, i: usize) -> Result<Option<T>, Error> {
        if self.steps < STEPS {
            self.steps += 1;
            self.direction = self.next_direction(mechanism, i)?;
            return Ok(None);
        }
        let mut twisted = None;
        let geometry = mechanism.geometry(&self.direction, T::zero(), &mut twisted);
        let kinematics = inverse_kinematics(geometry, &self.direction)?;
        let elongation = mechanism.tendons[i].elongation(self.tension_n)?;
        Ok(Some(kinematics.lengths[i] - elongation + self.pulled_m))
    }

    fn next_direction(&self, mechanism: &Mechanism<T>, i: usize) -> Result<Direction<T>, Error> {
        let direction = self.direction;
        let mut pull = SVector::<T, 3>::zeros();
        pull[i] = self.tension_n;
        let mut twisted = None;
        let geometry = mechanism.geometry(&direction, T::zero(), &mut twisted);
        let load = estimate_load(geometry, &mechanism.support, &direction, T::zero(), &pull)?;
        let plane = mechanism.support.plane(&direction);
        let [x, y] = plane.project(&load);
        let own = mechanism.leg.moment(&direction);
        // The moment out of balance over the stiffness of the weight and of the joint: the smallest stiffness that the leg has.
        let stiffness = mechanism.leg.stiffness(&direction)[(0, 0)]
            + mechanism.support.joint().bending_nm_per_rad;
        if !(stiffness > T::zero()) {
            return Err(Error::Unstable);
        }
        let (turn_x, turn_y) = ((own.x - x) / stiffness, (own.y - y) / stiffness);
        // A turn about x moves the tip along −p_z y, one about y along p_z x.
        let vector = direction.vector();
        Direction::from_xy(vector.x + vector.z * turn_y, vector.y - vector.z * turn_x)
    }
}
