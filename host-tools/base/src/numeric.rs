//! Derivatives by differences.

use nalgebra::{SMatrix, SVector, Vector3};

/// Step of the differences, rad: the truncation of fourth order (1e-12 times the fifth derivative) and the rounding
/// (1e-16 over the step) are about equal.
pub const STEP_RAD: f64 = 1e-3;

/// Derivative of `f` at zero, by central differences of fourth order.
#[must_use]
pub fn derivative<const M: usize>(f: impl Fn(f64) -> SVector<f64, M>) -> SVector<f64, M> {
    let slope = |step: f64| (f(step) - f(-step)) / (2.0 * step);
    (slope(STEP_RAD) * 4.0 - slope(2.0 * STEP_RAD)) / 3.0
}

/// Derivative of `f` by its rotation vector, at zero.
#[must_use]
pub fn derivative_by_rotation<const M: usize>(
    f: impl Fn(Vector3<f64>) -> SVector<f64, M>,
) -> SMatrix<f64, M, 3> {
    let column = |axis: usize| {
        derivative(|angle| f(Vector3::from_fn(|i, _| if i == axis { angle } else { 0.0 })))
    };
    SMatrix::from_columns(&[column(0), column(1), column(2)])
}
