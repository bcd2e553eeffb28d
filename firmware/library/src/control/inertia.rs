//! How the leg turns, and what that takes.

use super::quintic::MotionState;
use leg_model::Scalar;
use nalgebra::Vector3;

/// How a leg turns. It has next to no inertia about its own axis: what it does across it takes a moment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Turn<T> {
    /// The angular acceleration p × p̈, 1/s²: times the inertia across the leg it is the moment that it takes.
    pub acceleration: Vector3<T>,
    /// The moment that the damping of the joint takes by the angular velocity p × ṗ, N·m.
    pub damping: Vector3<T>,
}

impl<T: Scalar> Turn<T> {
    /// At rest.
    pub fn none() -> Self {
        Self {
            acceleration: Vector3::zeros(),
            damping: Vector3::zeros(),
        }
    }
}

impl<T: Scalar> MotionState<T> {
    /// How a leg turns that moves so in half-tangent coordinates, on a joint with a damping, N·m·s/rad.
    ///
    /// The directions p(q) are conformal to q, by γ = 2/(1 + q²): q̇ is the velocity along the sphere, and
    /// a = q̈ + γ(q̇²q − 2(q·q̇)q̇) the acceleration.
    #[inline(always)]
    pub fn turn(&self, joint_damping: T) -> Turn<T> {
        let ([x, y], [x_rate, y_rate]) = (self.position, self.rate);
        let gain = T::TWO / (T::one() + x * x + y * y);
        let square = x_rate * x_rate + y_rate * y_rate;
        let along = T::TWO * (x * x_rate + y * y_rate);
        let a_x = self.acceleration[0] + gain * (square * x - along * x_rate);
        let a_y = self.acceleration[1] + gain * (square * y - along * y_rate);
        let (square, across) = (gain * gain, gain * (gain - T::one()));
        let (x_square, y_square) = (square * x, square * y);
        // p × v of a v along the sphere.
        let about_joint = |x_along: T, y_along: T| {
            let outwards = x_square * x_along + y_square * y_along;
            Vector3::new(
                y * outwards + across * y_along,
                -(x * outwards + across * x_along),
                x_square * y_along - y_square * x_along,
            )
        };
        Turn {
            acceleration: about_joint(a_x, a_y),
            damping: about_joint(x_rate * joint_damping, y_rate * joint_damping),
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::control::{MotionState, Quintic};
    use leg_model::HalfTangent;
    use nalgebra::Vector3;

    /// Against differences of the directions along a path.
    #[test]
    fn the_turn_is_that_of_the_direction() {
        let motion = |position, rate, acceleration| MotionState {
            position,
            rate,
            acceleration,
        };
        let path = Quintic::connect(
            &motion([0.3, -0.2], [0.9, 0.4], [-2.0, 3.0]),
            &motion([-0.1, 0.45], [-0.5, 0.8], [1.0, 4.0]),
            1.3,
        );
        let direction = |part: f64| -> Vector3<f64> {
            let [x, y] = path.position(part);
            HalfTangent::new(x, y).direction().vector()
        };
        let step = 1e-4;
        for part in [0.05, 0.2, 0.4, 0.6, 0.8, 0.95] {
            let [before, now, after] = [part - step, part, part + step].map(direction);
            let change = (before + after - now * 2.0) / (step * 1.3_f64).powi(2);
            let rate = (after - before) / (2.0 * step * 1.3);
            let found = path.motion(part).turn(0.5);
            for (found, along) in [(found.acceleration, change), (found.damping, rate * 0.5)] {
                assert!((found - now.cross(&along)).norm() < 1e-5, "{part}: {found}");
            }
        }
    }
}
