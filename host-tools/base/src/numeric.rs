//! Derivatives by differences.

use nalgebra::{SMatrix, SVector, Vector3};

/// Step of the differences, rad: the truncation of fourth order (1e-12 times the fifth derivative) and the rounding
/// (1e-16 over the step) are about equal.
const STEP_RAD: f64 = 1e-3;

/// Derivative of `f` at zero, by central differences of fourth order.
#[must_use]
pub fn derivative<const M: usize>(f: impl Fn(f64) -> SVector<f64, M>) -> SVector<f64, M> {
    let slope = |step: f64| (f(step) - f(-step)) / (2.0 * step);
    (slope(STEP_RAD) * 4.0 - slope(2.0 * STEP_RAD)) / 3.0
}

/// Derivative of `f` by its rotation vector, at zero.
#[must_use]
pub fn by_rotation<const M: usize>(
    f: impl Fn(Vector3<f64>) -> SVector<f64, M>,
) -> SMatrix<f64, M, 3> {
    let column = |axis: usize| {
        derivative(|angle| f(Vector3::from_fn(|i, _| if i == axis { angle } else { 0.0 })))
    };
    SMatrix::from_columns(&[column(0), column(1), column(2)])
}

#[cfg(test)]
mod tests {
    use super::{by_rotation, derivative};
    use nalgebra::{Matrix3, Vector1};

    #[test]
    fn the_derivative_of_a_quartic_is_exact() {
        let slope = derivative(|x: f64| Vector1::new(3.0 * x + x.powi(2) + x.powi(4)));
        assert!((slope.x - 3.0).abs() < 1e-12);
    }

    #[test]
    fn columns_belong_to_the_axes() {
        let matrix = Matrix3::new(1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0);
        assert!((by_rotation(|psi| matrix * psi) - matrix).amax() < 1e-12);
    }
}
