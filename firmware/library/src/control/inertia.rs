//! What it takes to turn the leg.

use super::quintic::MotionState;
use leg_model::Scalar;
use nalgebra::Vector3;

impl<T: Scalar> MotionState<T> {
    /// The angular acceleration p × p̈ of a leg that moves so in half-tangent coordinates, 1/s². Times the inertia across the leg it
    /// is the moment that the motion takes: the leg has next to none about its own axis.
    ///
    /// The directions p(q) are conformal to q, by γ = 2/(1 + q²): a = q̈ + γ(q̇²q − 2(q·q̇)q̇) is the acceleration along the sphere.
    #[inline(always)]
    pub fn angular_acceleration(&self) -> Vector3<T> {
        let ([x, y], [x_rate, y_rate]) = (self.position, self.rate);
        let gain = T::TWO / (T::one() + x * x + y * y);
        let square = x_rate * x_rate + y_rate * y_rate;
        let along = T::TWO * (x * x_rate + y * y_rate);
        let a_x = self.acceleration[0] + gain * (square * x - along * x_rate);
        let a_y = self.acceleration[1] + gain * (square * y - along * y_rate);
        let outwards = gain * gain * (x * a_x + y * a_y);
        let across = gain * (gain - T::one());
        Vector3::new(
            y * outwards + across * a_y,
            -(x * outwards + across * a_x),
            gain * gain * (x * a_y - y * a_x),
        )
    }
}

#[cfg(test)]
mod tests {
    use crate::control::{MotionState, Quintic};
    use leg_model::HalfTangent;
    use nalgebra::Vector3;

    /// Against differences of the directions along a path.
    #[test]
    fn the_angular_acceleration_is_that_of_the_direction() {
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
            let found = path.motion(part).angular_acceleration();
            assert!(
                (found - now.cross(&change)).norm() < 1e-5,
                "{part}: {found}"
            );
        }
    }
}
