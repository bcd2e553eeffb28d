//! Poses that can be computed by hand: the vertical and the planes of symmetry.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use crate::common::constant_tendons;
use leg_model::{
    Direction, Evaluation, FreePlane, Load, Query, Rig, RigParameters, StiffnessAt, SupportKind,
    evaluate,
};
use nalgebra::Matrix3;

const TABLE_1: RigParameters<f64, 3> = RigParameters::<f64, 3>::TABLE_1;
const RING_M: f64 = 0.024;
const STIFFNESS_N_PER_M: f64 = 1e5;
const PRETENSION_N: f64 = 70.0;

fn evaluated(azimuth_deg: f64, tilt_deg: f64, support: SupportKind) -> Evaluation<f64> {
    let query = Query {
        azimuth_rad: azimuth_deg.to_radians(),
        tilt_rad: tilt_deg.to_radians(),
        payload_kg: 1.0,
        pretension_n: PRETENSION_N,
        f_min_n: 8.0,
        f_max_n: 150.0,
        tendons: constant_tendons(STIFFNESS_N_PER_M).unwrap(),
        stiffness_at: StiffnessAt::Pretension,
        support: support.into(),
        demand: None,
    };
    evaluate(&TABLE_1, &query).unwrap()
}

fn assert_near(found: f64, expected: f64, scale: f64) {
    // Each closed form loses a few bits of its largest term.
    assert!(
        (found - expected).abs() <= 1e-12 * scale,
        "{found} instead of {expected}"
    );
}

fn assert_matrix(found: &[[f64; 3]; 3], expected: [[f64; 3]; 3]) {
    let scale = expected
        .as_flattened()
        .iter()
        .fold(0.0, |a: f64, b| a.max(b.abs()));
    for (found, expected) in found.as_flattened().iter().zip(expected.as_flattened()) {
        assert_near(*found, *expected, scale);
    }
}

fn diagonal(bending: f64, torsion: f64) -> [[f64; 3]; 3] {
    [
        [bending, 0.0, 0.0],
        [0.0, bending, 0.0],
        [0.0, 0.0, torsion],
    ]
}

#[test]
fn a_hanging_leg_has_vertical_tendons() {
    let hanging = evaluated(0.0, 0.0, SupportKind::TorsionFree);
    for length in hanging.lengths_m {
        assert_near(length, TABLE_1.upper_length_m + TABLE_1.joint_length_m, 1.0);
    }
    // e × z = (e_y, −e_x, 0).
    let [x, y] = [0, 1].map(|axis| TABLE_1.leg_anchors_m.map(|anchor| anchor[axis]));
    assert_matrix(&hanging.moment_map_m, [y, x.map(|x| -x), [0.0; 3]]);
    for tension in hanging.tensions_n {
        assert_near(tension, PRETENSION_N, 100.0);
    }
    assert_eq!(hanging.deviation_m, 0.0);
}

/// K₁ = 1.5kr² about x and y, nothing about z. K₂ = −3f·L_joint·L_upper/l about x and y, 3fr²/l about z: pretension
/// softens bending and alone holds the torsion.
#[test]
fn the_stiffness_of_a_hanging_leg_is_that_of_its_ring_and_of_two_pendulums() {
    let (upper, joint) = (TABLE_1.upper_length_m, TABLE_1.joint_length_m);
    let per_metre = 3.0 * PRETENSION_N / (upper + joint);
    let (bending, torsion) = (-per_metre * joint * upper, per_metre * RING_M * RING_M);
    let hanging = evaluated(0.0, 0.0, SupportKind::TorsionFree);
    assert_matrix(
        &hanging.stiffness_k2_exact_nm_per_rad,
        diagonal(bending, torsion),
    );
    let k1 = 1.5 * STIFFNESS_N_PER_M * RING_M * RING_M;
    assert_matrix(
        &hanging.stiffness_nm_per_rad,
        diagonal(k1 + bending, torsion),
    );
    // Eq. (15): Σ f[z×][e×] = 3f·L_joint about x and y, nothing about z.
    let printed = diagonal(3.0 * PRETENSION_N * joint, 0.0);
    assert_matrix(&hanging.stiffness_k2_printed_nm_per_rad, printed);
}

#[test]
fn the_load_s_own_stiffness_at_the_vertical_is_that_of_a_pendulum() {
    let rig = Rig::new(&TABLE_1).unwrap();
    let stiffness = Load::new(&rig, 1.0)
        .unwrap()
        .stiffness(&Direction::straight_down());
    let pendulum = 9.81 * (1.5 * 0.091 + 1.0 * 0.219);
    let expected = Matrix3::new(pendulum, 0.0, 0.0, 0.0, pendulum, 0.0, 0.0, 0.0, 0.0);
    assert!((stiffness - expected).amax() < 1e-14);
}

/// A tendon in the plane in which the leg tilts, its anchors at ±`x` from the axis: l² = 2x²(1 − cos θ) + L_u² + L_j²
/// + 2L_uL_j cos θ − 2x(L_u + L_j) sin θ.
struct Planar {
    length: f64,
    /// dl/dθ.
    slope: f64,
    /// d²l/dθ².
    curvature: f64,
}

impl Planar {
    fn new(x: f64, tilt: f64) -> Self {
        let (upper, joint) = (TABLE_1.upper_length_m, TABLE_1.joint_length_m);
        let (sin, cos) = tilt.sin_cos();
        let (even, odd) = (x * x - upper * joint, x * (upper + joint));
        let constant = 2.0 * x * x + upper * upper + joint * joint;
        let length = (constant - 2.0 * (even * cos + odd * sin)).sqrt();
        let slope = (even * sin - odd * cos) / length;
        let curvature = (even * cos + odd * sin - slope * slope) / length;
        Self {
            length,
            slope,
            curvature,
        }
    }
}

/// Tilts in the planes of symmetry, which hold a tendon each: (tendon, azimuth, tilt), deg.
fn symmetric_poses() -> impl Iterator<Item = (usize, f64, f64)> {
    let tilts = (-12..=12).map(|step| 5.0 * f64::from(step));
    tilts.flat_map(|tilt| [(0, 0.0), (1, 120.0), (2, 240.0)].map(|(i, azimuth)| (i, azimuth, tilt)))
}

#[test]
fn lengths_in_a_plane_of_symmetry_are_those_of_a_flat_mechanism() {
    for (single, azimuth, tilt) in symmetric_poses() {
        let found = evaluated(azimuth, tilt, SupportKind::TorsionFree);
        for (i, length) in found.lengths_m.into_iter().enumerate() {
            let x = if i == single { RING_M } else { -RING_M / 2.0 };
            assert_near(length, Planar::new(x, tilt.to_radians()).length, 1.0);
        }
    }
}

/// The leg sags in the plane: L·M/K with K = Σ (kl'² + fl''), and with M' on top when the load turns, too.
#[test]
fn the_deviation_in_a_plane_of_symmetry_is_that_of_a_flat_mechanism() {
    let lever = 9.81 * (1.5 * 0.091 + 1.0 * 0.219);
    for (single, azimuth, tilt) in symmetric_poses() {
        let found = evaluated(azimuth, tilt, SupportKind::TorsionFree);
        let mut stiffness = 0.0;
        for (i, tension) in found.tensions_n.into_iter().enumerate() {
            let x = if i == single { RING_M } else { -RING_M / 2.0 };
            let tendon = Planar::new(x, tilt.to_radians());
            stiffness += STIFFNESS_N_PER_M * tendon.slope.powi(2) + tension * tendon.curvature;
        }
        let (sin, cos) = tilt.to_radians().sin_cos();
        let moment = 0.219 * lever * sin.abs();
        assert_near(found.deviation_m, moment / stiffness, 1.0);
        let with_load = moment / (stiffness + lever * cos);
        assert_near(found.deviation_with_load_stiffness_m, with_load, 1.0);
    }
}

#[test]
fn the_pair_of_tendons_beside_a_plane_of_symmetry_pulls_alike_and_balances_the_load() {
    let lever = 9.81 * (1.5 * 0.091 + 1.0 * 0.219);
    for (single, azimuth, tilt) in symmetric_poses() {
        let found = evaluated(azimuth, tilt, SupportKind::TorsionFree);
        let pair = [0, 1, 2].map(|i| found.tensions_n[(single + i) % 3]);
        assert_near(pair[1], pair[2], 100.0);
        let [alone, beside] =
            [RING_M, -RING_M / 2.0].map(|x| Planar::new(x, tilt.to_radians()).slope);
        // Virtual work of one radian of tilt.
        let work = pair[0] * alone + 2.0 * pair[1] * beside;
        assert_near(work, -lever * tilt.to_radians().sin(), 100.0);
    }
}

#[test]
fn no_support_twists_the_leg_in_a_plane_of_symmetry_of_its_own() {
    for (_, azimuth, tilt) in symmetric_poses() {
        assert_near(
            evaluated(azimuth, tilt, SupportKind::Spherical).torsion_rad,
            0.0,
            1.0,
        );
    }
    // A universal joint's planes are those of its axes.
    for azimuth in [0.0, 90.0, 180.0, 270.0] {
        assert_near(
            evaluated(azimuth, 30.0, SupportKind::Universal).torsion_rad,
            0.0,
            1.0,
        );
    }
}

#[test]
fn the_free_planes_of_all_supports_are_horizontal_at_the_vertical() {
    let down = Direction::straight_down();
    for plane in [FreePlane::torsion_free(&down), FreePlane::universal(&down)] {
        assert_eq!(plane.rotation([1.0, 2.0]).z, 0.0_f64);
    }
}
