//! Rank of the moment map, tension distribution and the twist of a ball joint.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use leg_model::{
    Bound, Direction, Distribution, Error, FreePlane, Geometry, Kinematics, Limit, Load, Rig,
    RigParameters, TensionBounds, Twist, ball_joint_torsion, distribute, inverse_kinematics,
};
use leg_tests::reference::poses;
use nalgebra::{SMatrix, SVector, Vector3};

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

fn distribution(
    azimuth: f64,
    tilt: f64,
    payload_kg: f64,
    bounds: &TensionBounds<f64>,
) -> Distribution<f64, 3> {
    let direction = direction(azimuth, tilt);
    let moment = Load::new(&Rig::new(&TABLE_1).unwrap(), payload_kg)
        .unwrap()
        .moment(&direction);
    let plane = FreePlane::torsion_free(&direction);
    distribute(
        &kinematics(&TABLE_1, &direction).moment_map,
        &plane,
        &moment,
        bounds,
    )
    .unwrap()
}

#[test]
fn the_moment_map_has_rank_2_at_the_vertical_and_in_the_planes_of_symmetry() {
    assert!(inverse_condition(&TABLE_1, &Direction::down()) < 1e-15);
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

/// Pretension per level without load at a tilt that may be beyond the 60° of `Direction::from_angles`.
fn least_pretension(tilt_deg: f64) -> f64 {
    let sin = tilt_deg.to_radians().sin();
    let of = |azimuth: u32| {
        let azimuth = f64::from(azimuth).to_radians();
        let direction = Direction::from_xy(sin * azimuth.cos(), sin * azimuth.sin()).unwrap();
        let plane = FreePlane::torsion_free(&direction);
        let moment_map = kinematics(&TABLE_1, &direction).moment_map;
        distribute(&moment_map, &plane, &Vector3::zeros(), &bounds())
            .unwrap()
            .per_level
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

#[test]
fn the_worst_pose_of_the_workspace_leaves_the_known_levels() {
    let known = [
        (0.0, 21.4, 140.3),
        (0.5, 33.3, 138.6),
        (1.0, 45.1, 116.0),
        (2.0, 68.8, 70.7),
    ];
    for (payload_kg, expected_lowest, expected_highest) in known {
        let (mut lowest, mut highest): (f64, f64) = (0.0, f64::MAX);
        for (azimuth, tilt) in poses(30, 1) {
            let distribution = distribution(azimuth, tilt, payload_kg, &bounds());
            lowest = lowest.max(distribution.lowest_level);
            highest = highest.min(distribution.highest_level);
        }
        assert!(
            (lowest - expected_lowest).abs() < 0.05,
            "{payload_kg} kg: {lowest} N"
        );
        assert!(
            (highest - expected_highest).abs() < 0.05,
            "{payload_kg} kg: {highest} N"
        );
    }
}

#[test]
fn at_45_newtons_a_tendon_goes_slack_with_2_kg_and_at_70_none_does() {
    let smallest = |level: f64| {
        let at = |(azimuth, tilt)| {
            distribution(azimuth, tilt, 2.0, &bounds())
                .tensions(level)
                .min()
        };
        poses(30, 2).map(at).fold(f64::MAX, f64::min)
    };
    assert!(smallest(45.0) < 0.0);
    assert!(smallest(70.0) > 8.0);
}

/// Asserts that the range of levels ends where the named tendons meet the named bounds, and no other exceeds its own.
fn assert_limits(distribution: &Distribution<f64, 3>, floor: f64, ceiling: f64) {
    let bounds = TensionBounds::new(floor, ceiling).unwrap();
    let limits = distribution.limits(&bounds);
    let ends = [distribution.lowest_level, distribution.highest_level];
    for (limit, level) in limits.into_iter().zip(ends) {
        let tensions = distribution.tensions(level);
        let met = tensions[usize::from(limit.tendon) - 1];
        let bound = if limit.bound == Bound::Floor {
            floor
        } else {
            ceiling
        };
        assert!(
            (met - bound).abs() < 1e-10,
            "tendon {} at {met} N, not {bound} N",
            limit.tendon
        );
        if distribution.feasible() {
            assert!(tensions.min() > floor - 1e-10 && tensions.max() < ceiling + 1e-10);
        }
    }
}

#[test]
fn the_levels_end_exactly_where_the_named_tendon_meets_the_named_bound() {
    for (azimuth, tilt) in poses(60, 5) {
        for (floor, ceiling) in [(8.0, 150.0), (60.0, 70.0), (0.0, 20.0), (30.0, 30.0)] {
            let bounds = TensionBounds::new(floor, ceiling).unwrap();
            assert_limits(&distribution(azimuth, tilt, 2.0, &bounds), floor, ceiling);
        }
    }
}

/// The leg leans towards tendon 1, which has to pull it back and so meets the ceiling, the others the floor.
#[test]
fn an_infeasible_load_names_both_tendons_and_bounds() {
    let bounds = TensionBounds::new(60.0, 70.0).unwrap();
    let distribution = distribution(0.1, 30_f64.to_radians(), 2.0, &bounds);
    assert!(!distribution.feasible());
    let [below, above] = distribution.limits(&bounds);
    assert_eq!(
        below,
        Limit {
            tendon: 3,
            bound: Bound::Floor
        }
    );
    assert_eq!(
        above,
        Limit {
            tendon: 1,
            bound: Bound::Ceiling
        }
    );
}

/// A symmetric rig with `N` tendons.
fn ring<const N: usize>() -> RigParameters<f64, N> {
    let anchors: [[f64; 2]; N] = std::array::from_fn(|i| {
        let angle = std::f64::consts::TAU * (i as f64) / (N as f64);
        [0.024 * angle.cos(), 0.024 * angle.sin()]
    });
    RigParameters {
        base_anchors_m: anchors,
        leg_anchors_m: anchors,
        upper_length_m: 0.006,
        joint_length_m: 0.029,
        leg_length_m: 0.190,
        leg_mass_kg: 1.5,
        leg_centroid_m: 0.091,
        gravity_m_per_s2: 9.81,
    }
}

/// The rows of PᵀA, from the plane's public face.
fn free_rows<const N: usize>(
    geometry: &Geometry<f64, N>,
    direction: &Direction<f64>,
    plane: &FreePlane<f64>,
) -> SMatrix<f64, 2, N> {
    let moment_map = inverse_kinematics(geometry, direction).unwrap().moment_map;
    SMatrix::from_fn(|row, i| plane.project(&moment_map.column(i).into())[row])
}

/// Asserts the balance, that f_p is the pseudo-inverse's answer, and that pretension does nothing.
fn assert_balance<const N: usize>() {
    let rig = Rig::new(&ring::<N>()).unwrap();
    let load = Load::new(&rig, 2.0).unwrap();
    for (azimuth, tilt) in poses(60, 15).chain([(0.0, 0.0)]) {
        let direction = direction(azimuth, tilt);
        let twisted = rig
            .geometry()
            .twisted(&Twist::universal(&direction.half_tangent()));
        let torsion_free = (*rig.geometry(), FreePlane::torsion_free(&direction));
        for (geometry, plane) in [torsion_free, (twisted, FreePlane::universal(&direction))] {
            let rows = free_rows(&geometry, &direction, &plane);
            let moment_map = inverse_kinematics(&geometry, &direction)
                .unwrap()
                .moment_map;
            let moment = load.moment(&direction);
            let found = distribute(&moment_map, &plane, &moment, &bounds()).unwrap();
            let wanted = -SVector::<f64, 2>::from(plane.project(&moment));
            let balance = rows * found.tensions(70.0) - wanted;
            assert!(balance.amax() < 1e-12, "{balance} N·m");
            assert!((rows * found.per_level).amax() < 1e-14);
            // The smallest solution is the one without a part in the null space of PᵀA.
            let least =
                rows.transpose() * (rows * rows.transpose()).try_inverse().unwrap() * wanted;
            assert!((found.particular - least).amax() < 1e-9);
            assert!((found.per_level.norm_squared() - N as f64).abs() < 1e-9);
            assert!(found.per_level.sum() > 0.0);
        }
    }
}

#[test]
fn tensions_of_three_four_five_and_six_tendons_balance_the_load_and_are_the_smallest() {
    assert_balance::<3>();
    assert_balance::<4>();
    assert_balance::<5>();
    assert_balance::<6>();
}

#[test]
fn tendons_that_cannot_turn_the_leg_are_called_singular() {
    let moment_map =
        SMatrix::<f64, 3, 3>::from_row_slice(&[1.0, 2.0, 3.0, 2.0, 4.0, 6.0, 0.0, 0.0, 0.0]);
    let plane = FreePlane::torsion_free(&Direction::down());
    let found = distribute(&moment_map, &plane, &Vector3::zeros(), &bounds());
    assert_eq!(found, Err(Error::Singular));
}

/// Torsion of a ball joint and the tendons' moment about the bisector there, N·m.
fn ball_joint(azimuth: f64, tilt: f64, level: f64) -> (f64, f64) {
    let rig = Rig::new(&TABLE_1).unwrap();
    let load = Load::new(&rig, 2.0).unwrap();
    let direction = direction(azimuth, tilt);
    let torsion = ball_joint_torsion(&rig, &direction, &load, &bounds(), level).unwrap();
    let geometry = rig.geometry().twisted(&Twist::from_torsion(torsion));
    let moment_map = inverse_kinematics(&geometry, &direction)
        .unwrap()
        .moment_map;
    let plane = FreePlane::torsion_free(&direction);
    let moment = load.moment(&direction);
    let tensions = distribute(&moment_map, &plane, &moment, &bounds())
        .unwrap()
        .tensions(level);
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
