#![allow(clippy::unwrap_used, reason = "a test may panic")]

use super::{Estimator, LoadEstimation};
use crate::control::Mechanism;
use crate::settings::Settings;
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
                .update(&mechanism, &unstretched_m, &[70.0; 3], 0.0, slack)
                .unwrap();
            let off = (found.direction.vector() - direction.vector()).norm();
            assert!(off < 1e-6, "{support:?}, {azimuth_deg}°: {off}");
        }
    }
}
