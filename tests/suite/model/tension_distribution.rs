//! Tension distribution: balance, bounds and pretensions.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use crate::common::constant_tendons;
use crate::common::reference::poses;
use leg_model::{
    Bound, Direction, Distribution, Error, FreePlane, Geometry, HoldError, Limit, Load, Rig,
    RigParameters, SupportKind, TensionBounds, Twist, distribute, inverse_kinematics,
    inverse_statics,
};
use nalgebra::{SMatrix, SVector, Vector3};

const TABLE_1: RigParameters<f64, 3> = RigParameters::<f64, 3>::TABLE_1;

fn direction(azimuth: f64, tilt: f64) -> Direction<f64> {
    Direction::from_angles(azimuth, tilt).unwrap()
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
    let rig = Rig::new(&TABLE_1).unwrap();
    let moment = Load::new(&rig, payload_kg).unwrap().moment(&direction);
    let moment_map = inverse_kinematics(rig.geometry(), &direction)
        .unwrap()
        .moment_map;
    distribute(
        &moment_map,
        &FreePlane::torsion_free(&direction),
        &moment,
        bounds,
    )
    .unwrap()
}

#[test]
fn the_worst_pose_of_the_workspace_leaves_the_known_pretensions() {
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
            lowest = lowest.max(distribution.pretension_min);
            highest = highest.min(distribution.pretension_max);
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
    let smallest = |pretension: f64| {
        let at = |(azimuth, tilt)| {
            distribution(azimuth, tilt, 2.0, &bounds())
                .tensions(pretension)
                .min()
        };
        poses(30, 2).map(at).fold(f64::MAX, f64::min)
    };
    assert!(smallest(45.0) < 0.0);
    assert!(smallest(70.0) > 8.0);
}

/// Asserts that the range of pretensions ends where the named tendons meet the named bounds, and no other exceeds its own.
fn assert_limits(distribution: &Distribution<f64, 3>, floor: f64, ceiling: f64) {
    let bounds = TensionBounds::new(floor, ceiling).unwrap();
    let limits = distribution.limits(&bounds);
    let ends = [distribution.pretension_min, distribution.pretension_max];
    for (limit, pretension) in limits.into_iter().zip(ends) {
        let tensions = distribution.tensions(pretension);
        let met = tensions[usize::from(limit.tendon) - 1];
        let bound = if limit.bound == Bound::Min {
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
fn the_pretensions_end_exactly_where_the_named_tendon_meets_the_named_bound() {
    for (azimuth, tilt) in poses(60, 5) {
        for (floor, ceiling) in [(8.0, 150.0), (60.0, 70.0), (0.0, 20.0), (30.0, 30.0)] {
            let bounds = TensionBounds::new(floor, ceiling).unwrap();
            assert_limits(&distribution(azimuth, tilt, 2.0, &bounds), floor, ceiling);
        }
    }
}

/// The leg leans towards tendon 1, which has to hold it there and so meets the maximum tension, another one the minimum tension.
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
            bound: Bound::Min
        }
    );
    assert_eq!(
        above,
        Limit {
            tendon: 1,
            bound: Bound::Max
        }
    );
}

/// Beyond 64.25° a tendon loses tension while the pretension rises, and meets the bounds in the other order.
#[test]
fn a_tendon_that_falls_with_the_pretension_is_named_with_its_bound() {
    let rig = Rig::new(&TABLE_1).unwrap();
    let mut lower_ends_at_max = 0;
    let mut upper_ends_at_min = 0;
    for azimuth_deg in (0..360).step_by(10) {
        let azimuth = f64::from(azimuth_deg).to_radians();
        let sine = 70_f64.to_radians().sin();
        let direction = Direction::from_xy(sine * azimuth.cos(), sine * azimuth.sin()).unwrap();
        let plane = FreePlane::torsion_free(&direction);
        let moment_map = inverse_kinematics(rig.geometry(), &direction)
            .unwrap()
            .moment_map;
        let weight = Load::new(&rig, 10.0).unwrap().moment(&direction);
        for part in [0.0, 1.0, -1.0, -5.0] {
            let moment = weight * part;
            let found = distribute(&moment_map, &plane, &moment, &bounds()).unwrap();
            assert_limits(&found, 8.0, 150.0);
            let [below, above] = found.limits(&bounds());
            lower_ends_at_max += u32::from(below.bound == Bound::Max);
            upper_ends_at_min += u32::from(above.bound == Bound::Min);
        }
    }
    assert!(
        lower_ends_at_max > 0 && upper_ends_at_min > 0,
        "{lower_ends_at_max}, {upper_ends_at_min}"
    );
}

/// A pretension that is no answer is refused with the tendon and the bound that it breaks.
#[test]
fn inverse_statics_name_the_bound_that_a_pretension_breaks() {
    let rig = Rig::new(&TABLE_1).unwrap();
    let leaning = direction(0.1, 30_f64.to_radians());
    let moment = Load::new(&rig, 2.0).unwrap().moment(&leaning);
    let tendons = constant_tendons(1e5).unwrap();
    let support = SupportKind::TorsionFree.into();
    let held = |bounds: &TensionBounds<f64>, pretension: f64| {
        inverse_statics(
            &rig, &support, &leaning, &moment, bounds, &tendons, pretension,
        )
    };
    let found = distribution(0.1, 30_f64.to_radians(), 2.0, &bounds());
    let [lowest, highest] = found.limits(&bounds());
    let (min, max) = (found.pretension_min, found.pretension_max);
    for pretension in [min + 1e-9, 0.5 * (min + max), max - 1e-9] {
        let tensions = held(&bounds(), pretension).unwrap().tensions;
        assert!(tensions.min() > 8.0 - 1e-6 && tensions.max() < 150.0 + 1e-6);
    }
    for (pretension, limit) in [(min - 0.01, lowest), (max + 0.01, highest), (0.0, lowest)] {
        let refused = HoldError::OutOfBounds(limit);
        assert_eq!(held(&bounds(), pretension), Err(refused), "{pretension} N");
    }
    let narrow = TensionBounds::new(60.0, 70.0).unwrap();
    let limits = distribution(0.1, 30_f64.to_radians(), 2.0, &narrow).limits(&narrow);
    for pretension in [60.0, 65.0, 70.0] {
        let refused = HoldError::Infeasible(limits);
        assert_eq!(held(&narrow, pretension), Err(refused));
    }
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
            assert!((rows * found.per_pretension).amax() < 1e-14);
            // The smallest solution is the one without a part in the null space of PᵀA.
            let least =
                rows.transpose() * (rows * rows.transpose()).try_inverse().unwrap() * wanted;
            assert!((found.particular - least).amax() < 1e-9);
            assert!((found.per_pretension.norm_squared() - N as f64).abs() < 1e-9);
            assert!(found.per_pretension.sum() > 0.0);
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
    // The third one takes no part in the pretension of the other two.
    let [alone_last, alone_first] = [
        [1.0, -1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0],
        [0.0, 1.0, -1.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0],
    ]
    .map(|rows| SMatrix::<f64, 3, 3>::from_row_slice(&rows));
    let plane = FreePlane::torsion_free(&Direction::straight_down());
    for moment_map in [moment_map, alone_last, alone_first] {
        let found = distribute(&moment_map, &plane, &Vector3::zeros(), &bounds());
        assert_eq!(found, Err(Error::Singular));
    }
}
