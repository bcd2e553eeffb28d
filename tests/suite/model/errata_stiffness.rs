//! The errors of the paper's print in the structural stiffness: each is shown to be one, and the model to be right.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use crate::common::numeric::derivative_by_rotation;
use crate::common::reference::{Tendons, poses, rotation, skew, turn};
use leg_model::{
    Direction, Distribution, FreePlane, Geometry, Load, Rig, RigParameters, TensionBounds,
    distribute, inverse_kinematics, printed, structural_stiffness,
};
use nalgebra::{Matrix3, Vector3};

const TABLE_1: RigParameters<f64, 3> = RigParameters::<f64, 3>::TABLE_1;

fn rig() -> Rig<f64, 3> {
    Rig::new(&TABLE_1).unwrap()
}

/// The distribution of a load at a pose.
fn distribution(direction: &Direction<f64>, payload_kg: f64) -> Distribution<f64, 3> {
    let rig = rig();
    let moment = Load::new(&rig, payload_kg).unwrap().moment(direction);
    let moment_map = inverse_kinematics(rig.geometry(), direction)
        .unwrap()
        .moment_map;
    let bounds = TensionBounds::new(8.0, 150.0).unwrap();
    distribute(
        &moment_map,
        &FreePlane::torsion_free(direction),
        &moment,
        &bounds,
    )
    .unwrap()
}

/// The tensions at a pose with a pretension of 70 N.
fn tensions(direction: &Direction<f64>, payload_kg: f64) -> Vector3<f64> {
    distribution(direction, payload_kg).tensions(70.0)
}

/// ∂n/∂ψ of a tendon, from differences.
fn change_of_pull(pose: &Matrix3<f64>, tendon: usize) -> Matrix3<f64> {
    derivative_by_rotation(|psi| Tendons::new(&TABLE_1, &(turn(&psi) * pose)).pulls[tendon])
}

#[test]
fn equations_12_and_14_call_a_derivative_zero_that_is_not() {
    for (azimuth, tilt) in poses(30, 10) {
        let pose = rotation(azimuth, tilt, 0.0);
        for i in 0..3 {
            let change = change_of_pull(&pose, i);
            // A turn of the leg by 1 rad moves e by about its own length, which is that of the tendon.
            assert!(change.norm() > 0.5, "{change}");
            let e = Tendons::new(&TABLE_1, &pose).ends[i];
            assert!((skew(&e) * change).norm() > 0.01, "{}", skew(&e) * change);
        }
    }
}

#[test]
fn equation_15_is_right_with_the_other_sign_and_the_change_of_n() {
    for (azimuth, tilt) in poses(30, 10) {
        let direction = Direction::from_angles(azimuth, tilt).unwrap();
        let pose = rotation(azimuth, tilt, 0.0);
        let f = tensions(&direction, 2.0);
        let tendons = Tendons::new(&TABLE_1, &pose);
        let (mut printed, mut missing) = (Matrix3::zeros(), Matrix3::zeros());
        for i in 0..3 {
            let e = skew(&tendons.ends[i]);
            printed += skew(&tendons.pulls[i]) * e * f[i];
            missing += e * change_of_pull(&pose, i) * f[i];
        }
        let rig = rig();
        let ours = structural_stiffness(rig.geometry(), &direction, &f);
        assert!((ours + printed + missing).amax() < 1e-7);
        let ours_printed = printed::structural_stiffness(rig.geometry(), &direction, &f);
        assert!((ours_printed - printed).amax() < 1e-12);
    }
}

/// The largest tension allowed makes the most of it: 3f·L_joint printed, −3f·L_joint·L_upper/l exactly.
#[test]
fn equation_15_is_off_by_15_newton_metres_per_radian_at_150_newtons() {
    let down = Direction::straight_down();
    let f = Vector3::repeat(150.0);
    let [exact, printed] = stiffnesses(rig().geometry(), &down, &f).map(|k2| k2.m11);
    assert!((printed - 13.05).abs() < 0.005, "{printed} N·m/rad");
    assert!((exact + 2.24).abs() < 0.005, "{exact} N·m/rad");
}

#[test]
fn equation_15_is_off_by_7_newton_metres_per_radian_at_70_newtons() {
    let states =
        poses(30, 5).flat_map(|pose| [0.0, 0.5, 1.0, 2.0].map(|payload_kg| (pose, payload_kg)));
    let errors = states.map(|((azimuth, tilt), payload_kg)| {
        let direction = Direction::from_angles(azimuth, tilt).unwrap();
        let f = tensions(&direction, payload_kg);
        let [exact, printed] = stiffnesses(rig().geometry(), &direction, &f);
        (printed - exact).amax()
    });
    let largest = errors.fold(0.0, f64::max);
    assert!((largest - 7.5).abs() < 0.05, "{largest} N·m/rad");
}

/// K₂, exact and printed.
fn stiffnesses(
    geometry: &Geometry<f64, 3>,
    direction: &Direction<f64>,
    f: &Vector3<f64>,
) -> [Matrix3<f64>; 2] {
    [structural_stiffness, printed::structural_stiffness].map(|k2| k2(geometry, direction, f))
}

/// At constant k. What pretension does to k is another matter.
#[test]
fn equation_15_says_that_pretension_stiffens_bending_where_it_softens_it() {
    for (azimuth, tilt) in poses(10, 5) {
        let direction = Direction::from_angles(azimuth, tilt).unwrap();
        let pretension = distribution(&direction, 0.0).per_pretension * 70.0;
        let [exact, printed] = stiffnesses(rig().geometry(), &direction, &pretension);
        let plane = FreePlane::torsion_free(&direction);
        // The mean over the two free axes.
        let bending = |k: &Matrix3<f64>| {
            let [x, y] = [[1.0, 0.0], [0.0, 1.0]].map(|axis| plane.rotation(axis));
            (x.dot(&(k * x)) + y.dot(&(k * y))) / 2.0
        };
        assert!(bending(&printed) > 1.0, "{}", bending(&printed));
        assert!(bending(&exact) < 0.0, "{}", bending(&exact));
    }
}
