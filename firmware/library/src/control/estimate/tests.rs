#![allow(clippy::unwrap_used, reason = "a test may panic")]

use super::{Estimator, LoadEstimation};
use crate::control::Mechanism;
use crate::settings::Settings;
use leg_model::nalgebra::Vector3;
use leg_model::{Direction, Elasticity, SupportKind, inverse_kinematics};

/// From straight down, and whatever joint turns the leg about its own axis as it leans.
#[test]
fn a_pose_is_found_in_one_cycle() {
    for support in [SupportKind::TorsionFree, SupportKind::Universal] {
        let settings = Settings {
            support,
            ..Settings::for_table_1().unwrap()
        };
        let mechanism = Mechanism::<f64>::new(&settings).unwrap();
        for azimuth_deg in (0..360).step_by(25) {
            let azimuth = f64::from(azimuth_deg).to_radians();
            let direction = Direction::from_angles(azimuth, 0.5).unwrap();
            let mut twisted = None;
            let geometry = mechanism.geometry(&direction, 0.0, &mut twisted);
            let lengths = inverse_kinematics(geometry, &direction).unwrap().lengths;
            let elongation = mechanism.tendons[0].elongation(70.0).unwrap();
            let unstretched_m = <[f64; 3]>::from(lengths).map(|length| length - elongation);
            let mut estimator = Estimator::new(&settings);
            let slack = LoadEstimation::Slack;
            let found = estimator
                .update(
                    &mechanism,
                    &unstretched_m,
                    &[70.0; 3],
                    0.0,
                    slack,
                    &Vector3::zeros(),
                )
                .unwrap();
            let off = found.direction.vector() - direction.vector();
            assert!(off.dot(&off) < 1e-12, "{support:?}, {azimuth_deg}°: {off}");
        }
    }
}

/// A push across the way to which a leg on a ball joint leans twists it: tensions without a moment about the leg.
#[test]
fn a_push_that_twists_a_leg_moves_neither_the_pose_nor_the_length_error() {
    let mut settings = Settings::for_table_1().unwrap();
    settings.support = SupportKind::Spherical;
    let mechanism = Mechanism::<f64>::new(&settings).unwrap();
    for (x, y, torsion) in [(0.3, 0.1, 0.02), (-0.1, 0.45, -0.03)] {
        let direction = Direction::from_xy(x, y).unwrap();
        let mut twisted = None;
        let geometry = mechanism.geometry(&direction, torsion, &mut twisted);
        let kinematics = inverse_kinematics(geometry, &direction).unwrap();
        let turning = kinematics.moment_map.transpose() * direction.vector();
        let even = Vector3::repeat(70.0);
        let tensions = even - turning * (turning.dot(&even) / turning.dot(&turning));
        assert!(tensions.min() > 5.0, "{tensions}");
        let unstretched_m = [0, 1, 2]
            .map(|i| kinematics.lengths[i] - mechanism.tendons[i].elongation(tensions[i]).unwrap());
        let mut estimator = Estimator::new(&settings);
        estimator.direction = direction;
        let mut estimate = None;
        for _ in 0..200 {
            let (tensions, load) = (tensions.into(), LoadEstimation::Filtered);
            let found = estimator.update(
                &mechanism,
                &unstretched_m,
                &tensions,
                0.0,
                load,
                &Vector3::zeros(),
            );
            estimate = Some(found.unwrap());
        }
        let estimate = estimate.unwrap();
        let off = estimate.direction.vector() - direction.vector();
        let off = off.dot(&off);
        assert!(
            (estimator.torsion - torsion).abs() < 1e-6,
            "{}",
            estimator.torsion
        );
        assert!(
            off < 1e-14 && estimate.residual_m < 1e-8,
            "{off} {estimate:?}"
        );
        assert!(estimate.length_error.unwrap().mean_m.abs() < 1e-8);
    }
}
