//! Forward kinematics after inverse kinematics, and what it says of lengths that fit no pose.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use crate::common::reference::{Tendons, rotation};
use leg_model::{
    Direction, Error, ForwardKinematics, Quantity, Reason, Rig, RigParameters, Twist,
    forward_kinematics, forward_kinematics_universal, inverse_kinematics,
};
use nalgebra::{Matrix3x2, SMatrix, SVector, Vector2, Vector3};
use proptest::prelude::{Strategy, prop, proptest};

const TABLE_1: RigParameters<f64, 3> = RigParameters::<f64, 3>::TABLE_1;

fn rig() -> Rig<f64, 3> {
    Rig::new(&TABLE_1).unwrap()
}

/// A pose to 60° and another 5° away at most, from which the search starts.
fn pose_and_start() -> impl Strategy<Value = (Direction<f64>, Direction<f64>)> {
    let away = 5_f64.to_radians().sin() / 2_f64.sqrt();
    let pose = (-3.2..3.2_f64, 0.0..60_f64.to_radians());
    (pose, -away..away, -away..away).prop_map(|((azimuth, tilt), x, y)| {
        let direction = Direction::from_angles(azimuth, tilt).unwrap();
        let [px, py, _]: [f64; 3] = direction.vector().into();
        (direction, Direction::from_xy(px + x, py + y).unwrap())
    })
}

fn assert_found(found: &ForwardKinematics<f64>, expected: &Direction<f64>) {
    let error = (found.direction.vector() - expected.vector()).norm();
    assert!(
        error < 1e-12,
        "off by {error:e} rad after {} steps",
        found.steps
    );
    // The root of a sum of squares that cancels to about 1e-16 of its terms.
    assert!(found.residual_m < 1e-9, "{:e} m", found.residual_m);
}

proptest! {
    #[test]
    fn true_lengths_give_the_direction_back((direction, start) in pose_and_start()) {
        let rig = rig();
        let lengths = inverse_kinematics(rig.geometry(), &direction).unwrap().lengths;
        assert_found(&forward_kinematics(rig.geometry(), &lengths, &start).unwrap(), &direction);
    }

    #[test]
    fn a_known_twist_makes_no_difference((direction, start) in pose_and_start(), torsion in -0.3..0.3_f64) {
        let geometry = rig().geometry().twisted(&Twist::from_torsion(torsion));
        let lengths = inverse_kinematics(&geometry, &direction).unwrap().lengths;
        assert_found(&forward_kinematics(&geometry, &lengths, &start).unwrap(), &direction);
    }

    #[test]
    fn a_universal_joint_gives_the_direction_back((direction, start) in pose_and_start()) {
        let rig = rig();
        let geometry = rig.geometry().twisted(&Twist::universal(&direction.half_tangent()));
        let lengths = inverse_kinematics(&geometry, &direction).unwrap().lengths;
        let found = forward_kinematics_universal(rig.geometry(), &lengths, &start).unwrap();
        assert_found(&found, &direction);
    }

    #[test]
    fn lengths_follow_the_vectors_at_any_twist((direction, _) in pose_and_start(), torsion in -0.3..0.3_f64) {
        let geometry = rig().geometry().twisted(&Twist::from_torsion(torsion));
        let lengths = inverse_kinematics(&geometry, &direction).unwrap().lengths;
        let twist = rotation(0.0, 0.0, torsion);
        let expected = Tendons::new(&TABLE_1, &(direction.rotation() * twist)).lengths;
        assert!((lengths - expected).amax() < 1e-15);
    }

    #[test]
    fn the_search_goes_through_the_vertical(azimuth in -3.2..3.2_f64, tilt in -0.05..0.05_f64) {
        let rig = rig();
        let pose = |tilt| Direction::from_angles(azimuth, tilt).unwrap();
        let lengths = inverse_kinematics(rig.geometry(), &pose(tilt)).unwrap().lengths;
        let found = forward_kinematics(rig.geometry(), &lengths, &pose(-tilt)).unwrap();
        assert_found(&found, &pose(tilt));
    }

    #[test]
    fn f32_gives_the_direction_back_within_2e_6_rad((direction, start) in pose_and_start()) {
        let rig = Rig::new(&RigParameters::<f32, 3>::TABLE_1).unwrap();
        let single = |d: &Direction<f64>| Direction::from_xy(d.vector().x as f32, d.vector().y as f32).unwrap();
        let direction = single(&direction);
        let lengths = inverse_kinematics(rig.geometry(), &direction).unwrap().lengths;
        let found = forward_kinematics(rig.geometry(), &lengths, &single(&start)).unwrap();
        let error = (found.direction.vector() - direction.vector()).abs().max();
        assert!(error < 2e-6, "off by {error:e} after {} steps", found.steps);
    }

    /// One tendon is off by up to 0.1 mm, as after a jump or a lost count.
    #[test]
    fn the_residual_is_that_of_the_best_direction(
        (direction, start) in pose_and_start(), tendon in 0..3_usize, error_m in 2e-5..1e-4_f64, shorter: bool,
    ) {
        let rig = rig();
        let mut lengths = inverse_kinematics(rig.geometry(), &direction).unwrap().lengths;
        lengths[tendon] += if shorter { -error_m } else { error_m };
        let found = forward_kinematics(rig.geometry(), &lengths, &start).unwrap();
        let best = least_residual(&lengths, &direction);
        assert!(best > 0.1 * error_m, "the lengths fit a pose: {best:e} m");
        // The search weighs l² − L², the reference l − L: they differ by the error beside the length, 1 % at most.
        assert!((found.residual_m / best - 1.0).abs() < 0.01, "{:e} m, not {best:e} m", found.residual_m);
    }

    #[test]
    fn any_lengths_give_a_direction_below_the_horizon_or_a_named_error(
        lengths in prop::array::uniform3(1e-3..1.0_f64), (start, _) in pose_and_start(),
    ) {
        match forward_kinematics(rig().geometry(), &SVector::from(lengths), &start) {
            Ok(found) => {
                assert!(found.direction.vector().z < 0.0 && found.residual_m.is_finite());
                assert!((found.direction.vector().norm() - 1.0).abs() < 1e-12);
            }
            Err(error) => assert!(matches!(error, Error::NotConverged | Error::Singular), "{error}"),
        }
    }
}

/// Lengths by vectors at the direction (x, y, −√(1 − x² − y²)).
fn lengths_at(p: &Vector2<f64>) -> Vector3<f64> {
    Tendons::new(&TABLE_1, &Direction::from_xy(p.x, p.y).unwrap().rotation()).lengths
}

/// The smallest |l − L| over all directions, by Gauss–Newton on numeric derivatives.
fn least_residual(lengths: &Vector3<f64>, near: &Direction<f64>) -> f64 {
    let step = 1e-6;
    let mut p = near.vector().xy();
    for _ in 0..20 {
        let slope = |axis: Vector2<f64>| {
            (lengths_at(&(p + axis * step)) - lengths_at(&(p - axis * step))) / (2.0 * step)
        };
        let jacobian = Matrix3x2::from_columns(&[slope(Vector2::x()), slope(Vector2::y())]);
        let normal: SMatrix<f64, 2, 2> = jacobian.transpose() * jacobian;
        p -= normal.try_inverse().unwrap() * jacobian.transpose() * (lengths_at(&p) - lengths);
    }
    (lengths_at(&p) - lengths).norm()
}

/// The step that shows that nothing is left to go is counted.
#[test]
fn a_search_from_the_direction_itself_takes_one_step() {
    let rig = rig();
    let direction = Direction::from_angles(0.7, 0.4).unwrap();
    let kinematics = inverse_kinematics(rig.geometry(), &direction).unwrap();
    let found = forward_kinematics(rig.geometry(), &kinematics.lengths, &direction).unwrap();
    assert_eq!(found.steps, 1);
}

#[test]
fn lengths_that_are_not_positive_are_refused() {
    let refused = Err(Error::Refused {
        quantity: Quantity::TendonLength,
        reason: Reason::NotPositive,
    });
    for bad in [0.0, -0.035, f64::NAN, f64::NEG_INFINITY] {
        for tendon in 0..3 {
            let mut lengths = Vector3::repeat(0.035);
            lengths[tendon] = bad;
            let (geometry, start) = (*rig().geometry(), Direction::straight_down());
            assert_eq!(
                forward_kinematics(&geometry, &lengths, &start),
                refused,
                "{bad}"
            );
            assert_eq!(
                forward_kinematics_universal(&geometry, &lengths, &start),
                refused,
                "{bad}"
            );
        }
    }
}

#[test]
fn an_infinite_length_is_no_pose() {
    let lengths = Vector3::new(0.035, f64::INFINITY, 0.035);
    assert!(forward_kinematics(rig().geometry(), &lengths, &Direction::straight_down()).is_err());
}

/// All tendons ten times too long, or hardly there: no direction below the horizon fits, and the residual tells.
#[test]
fn lengths_far_from_any_pose_are_not_taken_for_one() {
    for length in [0.35, 0.001] {
        let lengths = Vector3::new(length, 1.1 * length, 0.9 * length);
        match forward_kinematics(rig().geometry(), &lengths, &Direction::straight_down()) {
            Ok(found) => assert!(found.residual_m > 0.01, "{} m", found.residual_m),
            Err(error) => assert!(
                matches!(error, Error::NotConverged | Error::Singular),
                "{error}"
            ),
        }
    }
}
