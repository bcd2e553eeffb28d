//! Rank of the moment map, sign of the pretension and twist of a ball joint.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use crate::common::reference::poses;
use leg_model::{
    Direction, FreePlane, Kinematics, Load, Rig, RigParameters, SupportKind, TensionBounds, Twist,
    distribute, elastic_torsion, inverse_kinematics,
};
use nalgebra::Vector3;

const TABLE_1: RigParameters<f64, 3> = RigParameters::<f64, 3>::TABLE_1;

fn kinematics(
    parameters: &RigParameters<f64, 3>,
    direction: &Direction<f64>,
) -> Kinematics<f64, 3> {
    inverse_kinematics(Rig::new(parameters).unwrap().geometry(), direction).unwrap()
}

fn direction(azimuth: f64, tilt: f64) -> Direction<f64> {
    Direction::from_angles(azimuth, tilt).unwrap()
}

/// Smallest singular value of A beside the largest.
fn inverse_condition(parameters: &RigParameters<f64, 3>, direction: &Direction<f64>) -> f64 {
    let values = kinematics(parameters, direction)
        .moment_map
        .singular_values();
    values.min() / values.max()
}

fn bounds() -> TensionBounds<f64> {
    TensionBounds::new(8.0, 150.0).unwrap()
}

#[test]
fn the_moment_map_has_rank_2_at_the_vertical_and_in_the_planes_of_symmetry() {
    assert!(inverse_condition(&TABLE_1, &Direction::straight_down()) < 1e-15);
    for azimuth in (0..360).step_by(60) {
        for tilt in (5..=60).step_by(5) {
            let direction = direction(
                f64::from(azimuth).to_radians(),
                f64::from(tilt).to_radians(),
            );
            assert!(
                inverse_condition(&TABLE_1, &direction) < 1e-15,
                "{azimuth}°, {tilt}°"
            );
        }
    }
}

#[test]
fn the_moment_map_has_rank_2_everywhere_with_plates_at_equal_distances() {
    let parameters = RigParameters {
        upper_length_m: TABLE_1.joint_length_m,
        ..TABLE_1
    };
    for (azimuth, tilt) in poses(60, 7) {
        let value = inverse_condition(&parameters, &direction(azimuth, tilt));
        assert!(value < 1e-15, "azimuth {azimuth}, tilt {tilt}: {value:e}");
    }
}

/// Rank 3, but far from well: this is why the three rows are never solved for three tensions.
#[test]
fn the_condition_number_of_the_moment_map_is_at_least_272_at_30_degrees() {
    let tilt = 30_f64.to_radians();
    let best = (0..3600)
        .map(|step| {
            inverse_condition(
                &TABLE_1,
                &direction(f64::from(step).to_radians() / 10.0, tilt),
            )
        })
        .fold(0.0, f64::max);
    assert!((1.0 / best - 272.6).abs() < 0.1, "{}", 1.0 / best);
}

/// Pretension per pretension without load at a tilt that may be beyond the 60° of `Direction::from_angles`.
fn least_pretension(tilt_deg: f64) -> f64 {
    let sin = tilt_deg.to_radians().sin();
    let of = |azimuth: u32| {
        let azimuth = f64::from(azimuth).to_radians();
        let direction = Direction::from_xy(sin * azimuth.cos(), sin * azimuth.sin()).unwrap();
        let plane = FreePlane::torsion_free(&direction);
        let moment_map = kinematics(&TABLE_1, &direction).moment_map;
        distribute(&moment_map, &plane, &Vector3::zeros(), &bounds())
            .unwrap()
            .per_pretension
            .min()
    };
    (0..360).map(of).fold(f64::MAX, f64::min)
}

#[test]
fn pretension_pulls_all_tendons_up_to_64_25_degrees() {
    for tilt_deg in [1.0, 15.0, 30.0, 45.0, 60.0, 64.25] {
        assert!(least_pretension(tilt_deg) > 0.0, "{tilt_deg}°");
    }
    assert!(least_pretension(64.5) < 0.0);
}

/// Torsion of a ball joint and the tendons' moment about the bisector there, N·m.
fn ball_joint(azimuth: f64, tilt: f64, pretension: f64) -> (f64, f64) {
    let rig = Rig::new(&TABLE_1).unwrap();
    let load = Load::new(&rig, 2.0).unwrap();
    let direction = direction(azimuth, tilt);
    let support = SupportKind::Spherical.into();
    let moment = load.moment(&direction);
    let torsion =
        elastic_torsion(&rig, &support, &direction, &moment, &bounds(), pretension).unwrap();
    let geometry = rig.geometry().twisted(&Twist::from_torsion(torsion));
    let moment_map = inverse_kinematics(&geometry, &direction)
        .unwrap()
        .moment_map;
    let plane = FreePlane::torsion_free(&direction);
    let tensions = distribute(&moment_map, &plane, &moment, &bounds())
        .unwrap()
        .tensions(pretension);
    let bisector = (Vector3::z() - direction.vector()).normalize();
    (torsion, bisector.dot(&(moment_map * tensions)))
}

#[test]
fn a_ball_joint_twists_until_the_torsion_moment_vanishes() {
    let mut largest: f64 = 0.0;
    for (azimuth, tilt) in poses(30, 2) {
        let (torsion, moment) = ball_joint(azimuth, tilt, 60.0);
        assert!(
            moment.abs() < 1e-10,
            "azimuth {azimuth}, tilt {tilt}: {moment:e} N·m"
        );
        largest = largest.max(torsion.abs());
    }
    assert!(
        (largest.to_degrees() - 1.55).abs() < 0.005,
        "{}°",
        largest.to_degrees()
    );
}
