//! Derivatives by differences, of functions whose derivatives are known.

use leg_base::numeric::{derivative, derivative_by_rotation};
use nalgebra::{Matrix3, Vector1};

#[test]
fn the_derivative_of_a_quartic_is_exact() {
    let slope = derivative(|x: f64| Vector1::new(3.0 * x + x.powi(2) + x.powi(4)));
    assert!((slope.x - 3.0).abs() < 1e-12);
}

#[test]
fn columns_belong_to_the_axes() {
    let matrix = Matrix3::new(1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0);
    assert!((derivative_by_rotation(|psi| matrix * psi) - matrix).amax() < 1e-12);
}
