#![allow(clippy::unwrap_used, reason = "a test may panic")]

use super::{Estimator, LoadEstimation, torsion_m_per_rad};
use crate::control::{Mechanism, Turn};
use crate::settings::Settings;
use leg_model::nalgebra::Vector3;
use leg_model::{Direction, Elasticity, SupportKind, inverse_kinematics};

/// From straight down, and whatever joint turns the leg about its own axis as it leans.
#[test]
fn a_pose_is_found_in_one_cycle() {
    for support in [SupportKind::TorsionFree, SupportKind::Universal] {
        let settings = Settings {
            support,
            ..Settings::table_1().unwrap()
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
            let off = found.direction.vector() - direction.vector();
            assert!(off.dot(&off) < 1e-12, "{support:?}, {azimuth_deg}°: {off}");
        }
    }
}

/// Tendons that are too long for any pose of a leg with narrow anchors leave it where it was; ones that are taut, and no lengths, are an error.
#[test]
fn a_pose_stays_while_slack_tendons_show_none() {
    let mut settings = Settings::table_1().unwrap();
    for anchors_m in [
        &mut settings.rig.base_anchors_m,
        &mut settings.rig.leg_anchors_m,
    ] {
        *anchors_m = anchors_m.map(|anchor| anchor.map(|m| 0.25 * m));
    }
    let mechanism = Mechanism::<f64>::new(&settings).unwrap();
    let hanging = Direction::straight_down();
    let lengths = inverse_kinematics(mechanism.rig.geometry(), &hanging)
        .unwrap()
        .lengths;
    let update = |longer_m: [f64; 3], load_estimation| {
        let unstretched_m = [0, 1, 2].map(|i| lengths[i] + longer_m[i]);
        Estimator::new(&settings).update(
            &mechanism,
            &unstretched_m,
            &[0.0; 3],
            0.0,
            load_estimation,
        )
    };
    // As sensors with noise show it.
    let longer_m = [6e-3, 6.01e-3, 5.98e-3];
    let kept = update(longer_m, LoadEstimation::Slack).unwrap();
    assert_eq!(kept.direction.vector(), hanging.vector());
    assert!(update(longer_m, LoadEstimation::Filtered).is_err());
    for no_m in [[f64::NAN, 6e-3, 6e-3], [-0.05, 6e-3, 6e-3]] {
        assert!(update(no_m, LoadEstimation::Slack).is_err(), "{no_m:?}");
    }
}

/// A push across the way to which a leg on a ball joint leans twists it: tensions without a moment about the leg.
#[test]
fn a_push_that_twists_a_leg_moves_neither_the_pose_nor_the_length_error() {
    let mut settings = Settings::table_1().unwrap();
    settings.support = SupportKind::Spherical;
    let mechanism = Mechanism::<f64>::new(&settings).unwrap();
    // Whether its load is estimated or stays as it is.
    for (x, y, torsion, load) in [
        (0.3, 0.1, 0.02, LoadEstimation::Filtered),
        (-0.1, 0.45, -0.03, LoadEstimation::Filtered),
        (-0.1, 0.45, -0.03, LoadEstimation::Frozen),
    ] {
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
            let tensions = tensions.into();
            let found = estimator.update(&mechanism, &unstretched_m, &tensions, 0.0, load);
            estimator.step_load(&mechanism, &direction, &Turn::none());
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

/// Where the load is frozen, or the tendons are slack, it stays as it is, whatever they show.
#[test]
fn a_load_that_is_frozen_stays_as_it_is() {
    use LoadEstimation::{Filtered, Frozen, Moving, Slack};
    for support in [SupportKind::TorsionFree, SupportKind::Spherical] {
        let settings = Settings {
            support,
            ..Settings::table_1().unwrap()
        };
        let mechanism = Mechanism::<f64>::new(&settings).unwrap();
        let direction = Direction::from_xy(0.3, 0.1).unwrap();
        let mut twisted = None;
        let geometry = mechanism.geometry(&direction, 0.0, &mut twisted);
        let lengths = inverse_kinematics(geometry, &direction).unwrap().lengths;
        let tensions_n = [90.0, 70.0, 60.0];
        let unstretched_m =
            [0, 1, 2].map(|i| lengths[i] - mechanism.tendons[i].elongation(tensions_n[i]).unwrap());
        for (estimation, stays) in [
            (Frozen, true),
            (Slack, true),
            (Filtered, false),
            (Moving, false),
        ] {
            let mut estimator = Estimator::new(&settings);
            estimator.direction = direction;
            let before = estimator.load.estimate();
            for _ in 0..2_000 {
                estimator
                    .update(&mechanism, &unstretched_m, &tensions_n, 0.0, estimation)
                    .unwrap();
                estimator.step_load(&mechanism, &direction, &Turn::none());
            }
            let same = estimator.load.estimate() == before;
            assert_eq!(same, stays, "{support:?} {estimation:?}");
        }
    }
}

/// The search for the torsion goes by it: a slope of another size takes too long a step, or too short a one.
#[test]
fn the_moment_about_a_hanging_leg_is_that_of_its_tendons() {
    let mut settings = Settings::table_1().unwrap();
    settings.support = SupportKind::Spherical;
    let mechanism = Mechanism::<f64>::new(&settings).unwrap();
    let down = Direction::straight_down();
    let torsion = 1e-3;
    let mut twisted = None;
    let geometry = mechanism.geometry(&down, torsion, &mut twisted);
    let moment_map = inverse_kinematics(geometry, &down).unwrap().moment_map;
    let mean_m = (moment_map.transpose() * down.vector()).sum() / 3.0;
    let off = f64::from(torsion_m_per_rad(&settings)) * torsion / mean_m.abs() - 1.0;
    assert!(off.abs() < 1e-4, "{off}");
}

/// A push on a leg with a fast mode is taken up as the settings say; the first of the two filters is slower by as much as a mode is.
#[test]
fn a_push_is_taken_up_as_the_mode_allows() {
    let settings = Settings::table_1().unwrap();
    let mechanism = Mechanism::<f64>::new(&settings).unwrap();
    let kinematics =
        inverse_kinematics(mechanism.rig.geometry(), &Direction::straight_down()).unwrap();
    let elongation = mechanism.tendons[0].elongation(70.0).unwrap();
    let pulled = mechanism.tendons[0].elongation(80.0).unwrap();
    let [free, other] = [elongation, pulled].map(|stretch| kinematics.lengths[0] - stretch);
    // Steps until half of a push shows in the load.
    let steps = |time_constant_s: f64| {
        let mut estimator = Estimator::new(&settings);
        estimator.load.follow_mode(time_constant_s);
        let mut push_nm = move || {
            let lengths_m = [other, free, free];
            let tensions_n = [80.0, 70.0, 70.0];
            let load = LoadEstimation::Filtered;
            let still = Turn::none();
            let found = estimator.update(&mechanism, &lengths_m, &tensions_n, 0.0, load);
            let direction = found.unwrap().direction;
            estimator.step_load(&mechanism, &direction, &still);
            let [x, y] = estimator.excess_nm(&mechanism);
            x.hypot(y)
        };
        let pushes_nm: Vec<_> = (0..20_000).map(|_| push_nm()).collect();
        let half_nm = 0.5 * pushes_nm[19_999];
        assert!(half_nm > 0.1, "{half_nm}");
        pushes_nm.iter().position(|&nm| nm > half_nm).unwrap()
    };
    let [fast, edge, slow] = [0.01, 0.03, 0.12].map(steps);
    assert_eq!(fast, edge);
    assert!(
        (2.0..4.0).contains(&(slow as f64 / edge as f64)),
        "{edge} {slow}"
    );
}

/// A payload that is found where a leg was pushed to, off its target, changes what a target there holds by no more than its filters: one
/// whose tensions jump moves the leg.
#[test]
fn a_payload_that_is_found_does_not_move_the_load_at_the_target() {
    let settings = Settings::table_1().unwrap();
    let mechanism = Mechanism::<f64>::new(&settings).unwrap();
    let direction = Direction::from_xy(-0.27, -0.2).unwrap();
    let target = Direction::from_xy(-0.3, -0.24).unwrap();
    let kinematics = inverse_kinematics(mechanism.rig.geometry(), &direction).unwrap();
    let mut estimator = Estimator::new(&settings);
    estimator.direction = direction;
    let mut held = |tensions_n: [f64; 3], load| {
        let unstretched_m = [0, 1, 2].map(|i| {
            kinematics.lengths[i] - mechanism.tendons[i].elongation(tensions_n[i]).unwrap()
        });
        estimator
            .update(&mechanism, &unstretched_m, &tensions_n, 0.0, load)
            .unwrap();
        estimator.step_load(&mechanism, &target, &Turn::none());
        let load = estimator.load.estimate();
        let moment = load.moment(&target, mechanism.payload_lever);
        (load.payload_kg, moment)
    };
    let (pushed_kg, pushed_nm) = held([90.0, 80.0, 20.0], LoadEstimation::Immediate);
    let (found_kg, found_nm) = held([52.0, 56.0, 62.0], LoadEstimation::Filtered);
    assert!((found_kg - pushed_kg).abs() > 1.0, "{pushed_kg} {found_kg}");
    for (pushed_nm, found_nm) in pushed_nm.into_iter().zip(found_nm) {
        let moved_nm = (found_nm - pushed_nm).abs();
        assert!(moved_nm < 1e-3, "{pushed_nm} {found_nm}");
    }
}
