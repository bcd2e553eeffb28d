//! Jacobian, stiffness and free rotations against numeric derivatives, in f64.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use crate::common::constant_tendons;
use crate::common::numeric::{derivative, derivative_by_rotation};
use crate::common::reference::{Tendons, load_moment, poses, rotation, turn};
use leg_model::{
    Direction, FreePlane, JointStiffness, Load, Query, Rig, RigParameters, StiffnessAt, Support,
    SupportKind, TendonStates, Twist, evaluate, full_pass, inverse_kinematics, solve3,
    structural_stiffness, tendon_stiffness,
};
use nalgebra::{Matrix3, Vector3};

const TABLE_1: RigParameters<f64, 3> = RigParameters::<f64, 3>::TABLE_1;

/// Tensions that differ, N: the derivatives hold at any.
const TENSIONS: Vector3<f64> = Vector3::new(110.0, 55.0, 20.0);

/// Stiffnesses that differ, N/m.
const STIFFNESSES: Vector3<f64> = Vector3::new(1.2e5, 0.9e5, 0.6e5);

const PAYLOAD_KG: f64 = 2.0;

/// Tendons of Table 1's rig at a pose that has been turned by `psi`.
fn turned(rotation: &Matrix3<f64>, psi: &Vector3<f64>) -> Tendons<3> {
    Tendons::new(&TABLE_1, &(turn(psi) * rotation))
}

/// Poses to 60° with three torsions each: azimuth, tilt, torsion, rad.
fn twisted_poses() -> impl Iterator<Item = (f64, f64, f64)> {
    poses(60, 10)
        .flat_map(|(azimuth, tilt)| [-0.2, 0.0, 0.2].map(|torsion| (azimuth, tilt, torsion)))
}

/// Asserts that an error, in SI, is below a bound, in a pose of an azimuth, a tilt and a torsion, rad.
#[track_caller]
fn assert_small(error: f64, bound: f64, pose: [f64; 3]) {
    assert!(error < bound, "{error:e} in {pose:?}");
}

fn rig() -> Rig<f64, 3> {
    Rig::new(&TABLE_1).unwrap()
}

#[test]
fn a_rotation_changes_the_lengths_by_minus_the_transposed_moment_map() {
    for (azimuth, tilt, torsion) in twisted_poses() {
        let pose = rotation(azimuth, tilt, torsion);
        let numeric = derivative_by_rotation(|psi| turned(&pose, &psi).lengths);
        let geometry = rig().geometry().twisted(&Twist::from_torsion(torsion));
        let direction = Direction::from_angles(azimuth, tilt).unwrap();
        let moment_map = inverse_kinematics(&geometry, &direction)
            .unwrap()
            .moment_map;
        // Entries reach 0.025 m; the differences are good for 1e-11 of the lengths.
        let error = (numeric + moment_map.transpose()).amax();
        assert_small(error, 1e-11, [azimuth, tilt, torsion]);
    }
}

#[test]
fn exact_k2_is_the_derivative_of_the_tendon_moment_at_constant_tensions() {
    for (azimuth, tilt, torsion) in twisted_poses() {
        let pose = rotation(azimuth, tilt, torsion);
        let numeric = -derivative_by_rotation(|psi| turned(&pose, &psi).moment_map() * TENSIONS);
        let geometry = rig().geometry().twisted(&Twist::from_torsion(torsion));
        let direction = Direction::from_angles(azimuth, tilt).unwrap();
        let error = (structural_stiffness(&geometry, &direction, &TENSIONS) - numeric).amax();
        assert_small(error, 1e-7, [azimuth, tilt, torsion]);
    }
}

#[test]
fn k1_and_exact_k2_are_the_derivative_of_the_moment_of_elastic_tendons() {
    for (azimuth, tilt) in poses(60, 10) {
        let pose = rotation(azimuth, tilt, 0.0);
        let lengths = turned(&pose, &Vector3::zeros()).lengths;
        let numeric = -derivative_by_rotation(|psi| {
            let tendons = turned(&pose, &psi);
            let stretch = tendons.lengths - lengths;
            tendons.moment_map() * (TENSIONS + STIFFNESSES.component_mul(&stretch))
        });
        let rig = rig();
        let direction = Direction::from_angles(azimuth, tilt).unwrap();
        let moment_map = inverse_kinematics(rig.geometry(), &direction)
            .unwrap()
            .moment_map;
        let stiffness = tendon_stiffness(&moment_map, &STIFFNESSES)
            + structural_stiffness(rig.geometry(), &direction, &TENSIONS);
        let error = (stiffness - numeric).amax();
        assert_small(error, 1e-7, [azimuth, tilt, 0.0]);
    }
}

#[test]
fn the_load_s_own_stiffness_is_the_derivative_of_its_moment() {
    let load = Load::new(&rig(), PAYLOAD_KG).unwrap();
    for (azimuth, tilt) in poses(60, 10) {
        let pose = rotation(azimuth, tilt, 0.0);
        let numeric =
            -derivative_by_rotation(|psi| load_moment(&TABLE_1, &(turn(&psi) * pose), PAYLOAD_KG));
        let direction = Direction::from_angles(azimuth, tilt).unwrap();
        let error = (load.stiffness(&direction) - numeric).amax();
        // Of 6 N·m/rad.
        assert_small(error, 1e-10, [azimuth, tilt, 0.0]);
    }
}

/// The fast path forms the sum of K₁, K₂ and K_load by other formulas, and keeps its symmetric part.
#[test]
fn the_full_pass_keeps_the_symmetric_part_of_the_derivative_of_all_moments() {
    let rig = rig();
    let load = Load::new(&rig, PAYLOAD_KG).unwrap();
    let states = TendonStates::new(TENSIONS, STIFFNESSES).unwrap();
    for (azimuth, tilt) in poses(60, 10) {
        let pose = rotation(azimuth, tilt, 0.0);
        let lengths = turned(&pose, &Vector3::zeros()).lengths;
        let numeric = -derivative_by_rotation(|psi| {
            let tendons = turned(&pose, &psi);
            let stretch = tendons.lengths - lengths;
            let tensions = TENSIONS + STIFFNESSES.component_mul(&stretch);
            tendons.moment_map() * tensions
                + load_moment(&TABLE_1, &(turn(&psi) * pose), PAYLOAD_KG)
        });
        let direction = Direction::from_angles(azimuth, tilt).unwrap();
        let stiffness = full_pass(&rig, &direction, &load, &states)
            .stiffness
            .matrix();
        let error = (stiffness - (numeric + numeric.transpose()) / 2.0).amax();
        assert_small(error, 1e-7, [azimuth, tilt, 0.0]);
    }
}

/// The rotation vector ω of a motion R(t) with R(0) = `pose`, from the differences of R: Ṙ Rᵀ = [ω×].
fn rate(pose: &Matrix3<f64>, motion: impl Fn(f64) -> Matrix3<f64>) -> Vector3<f64> {
    derivative(|t| {
        let spin = motion(t) * pose.transpose();
        Vector3::new(
            spin.m32 - spin.m23,
            spin.m13 - spin.m31,
            spin.m21 - spin.m12,
        ) / 2.0
    })
}

/// How far a rotation leaves a plane, for a rotation of 1 rad.
fn distance_to_plane(plane: &FreePlane<f64>, rate: &Vector3<f64>) -> f64 {
    (rate - plane.rotation([rate.x, rate.y])).norm() / rate.norm()
}

#[test]
fn a_leg_without_torsion_turns_in_the_plane_normal_to_the_bisector() {
    for (azimuth, tilt) in poses(60, 10) {
        let pose = rotation(azimuth, tilt, 0.0);
        let plane = FreePlane::torsion_free(&Direction::from_angles(azimuth, tilt).unwrap());
        let nod = rate(&pose, |t| rotation(azimuth, tilt + t, 0.0));
        let sway = rate(&pose, |t| rotation(azimuth + t, tilt, 0.0));
        assert!(
            distance_to_plane(&plane, &nod) < 1e-10 && distance_to_plane(&plane, &sway) < 1e-10
        );
        // The two motions are not the same, so that they span the plane.
        assert!(nod.normalize().cross(&sway.normalize()).norm() > 0.99);
        let bisector = Vector3::z() + pose * Vector3::z();
        assert!(nod.dot(&bisector).abs() < 1e-10 && sway.dot(&bisector).abs() < 1e-10);
    }
}

/// R = Rx(α)Ry(β).
fn universal(alpha: f64, beta: f64) -> Matrix3<f64> {
    turn(&(Vector3::x() * alpha)) * turn(&(Vector3::y() * beta))
}

/// Angles of a universal joint whose leg points to an azimuth and a tilt, rad.
fn universal_angles(azimuth: f64, tilt: f64) -> (f64, f64) {
    let p = rotation(azimuth, tilt, 0.0) * -Vector3::z();
    (p.y.atan2(-p.z), (-p.x).asin())
}

#[test]
fn a_universal_joint_turns_about_its_two_axes() {
    for (azimuth, tilt) in poses(60, 10) {
        let (alpha, beta) = universal_angles(azimuth, tilt);
        let plane = FreePlane::universal(&Direction::from_angles(azimuth, tilt).unwrap());
        let pose = universal(alpha, beta);
        let first = rate(&pose, |t| universal(alpha + t, beta));
        let second = rate(&pose, |t| universal(alpha, beta + t));
        assert!(
            distance_to_plane(&plane, &first) < 1e-10 && distance_to_plane(&plane, &second) < 1e-10
        );
        assert!((first - Vector3::x()).norm() < 1e-10);
    }
}

#[test]
fn a_universal_joint_twists_the_leg_by_the_formula_of_its_angles() {
    let mut largest: f64 = 0.0;
    for (azimuth, tilt) in poses(60, 5) {
        let (alpha, beta) = universal_angles(azimuth, tilt);
        let direction = Direction::from_angles(azimuth, tilt).unwrap();
        let torsion = Twist::universal(&direction.half_tangent()).torsion();
        let from_angles = (alpha.sin() * beta.sin()).atan2(alpha.cos() + beta.cos());
        assert!((torsion - from_angles).abs() < 1e-12);
        let error = (rotation(azimuth, tilt, torsion) - universal(alpha, beta)).amax();
        assert!(error < 1e-12, "azimuth {azimuth}, tilt {tilt}: {error:e}");
        if tilt < 30.1_f64.to_radians() {
            largest = largest.max(torsion.abs());
        }
    }
    assert!(
        (largest.to_degrees() - 4.1).abs() < 0.02,
        "{}°",
        largest.to_degrees()
    );
}

/// Under a stiffness without symmetry, the moment that is left over does nothing along the free rotations.
#[test]
fn the_solve_in_a_plane_balances_the_moment_along_two_orthonormal_axes() {
    let k = Matrix3::new(70.0, -9.0, 30.0, 2.0, 72.0, -4.0, 25.0, 7.0, 19.0);
    let moment = Vector3::new(1.0, -2.0, 0.5);
    for (azimuth, tilt) in poses(60, 30) {
        let plane = FreePlane::torsion_free(&Direction::from_angles(azimuth, tilt).unwrap());
        let bisector = (Vector3::z() + rotation(azimuth, tilt, 0.0) * Vector3::z()).normalize();
        let along = bisector.cross(&Vector3::x()).normalize();
        let psi = plane.solve(&k, &moment).unwrap();
        assert!(psi.dot(&bisector).abs() < 1e-14);
        for axis in [along, bisector.cross(&along)] {
            let rest = axis.dot(&(k * psi - moment));
            assert!(rest.abs() < 1e-12, "{rest} N·m");
        }
    }
}

/// What unit tensions pull the leg up along its own axis by: −n·p.
fn axial_pulls(tendons: &Tendons<3>, pose: &Matrix3<f64>) -> Vector3<f64> {
    let up = pose.column(2).into_owned();
    Vector3::from_fn(|i, _| tendons.pulls[i].dot(&up))
}

#[test]
fn the_pull_along_the_leg_is_that_of_the_tendons_directions() {
    for (azimuth, tilt, torsion) in twisted_poses() {
        let pose = rotation(azimuth, tilt, torsion);
        let geometry = rig().geometry().twisted(&Twist::from_torsion(torsion));
        let direction = Direction::from_angles(azimuth, tilt).unwrap();
        let kinematics = inverse_kinematics(&geometry, &direction).unwrap();
        let found = geometry.axial_pulls(&direction, &kinematics);
        let expected = axial_pulls(&Tendons::new(&TABLE_1, &pose), &pose);
        assert!((found - expected).amax() < 1e-12, "{found} {expected}");
    }
}

/// Joint and shaft give way to the weights along the leg, less what the tendons pull otherwise in the pose that has sagged.
#[test]
fn the_stretch_of_joint_and_shaft_is_that_of_the_change_of_the_force_along_the_leg() {
    const COMPLIANCE_M_PER_N: f64 = 1e-7;
    const STIFFNESS_N_PER_M: f64 = 1e5;
    let joint = JointStiffness {
        bending_nm_per_rad: 5.0,
        torsion_nm_per_rad: 4.0,
        axial_compliance_m_per_n: COMPLIANCE_M_PER_N,
    };
    for (azimuth_rad, tilt_rad) in poses(30, 10) {
        let query = Query {
            azimuth_rad,
            tilt_rad,
            payload_kg: PAYLOAD_KG,
            pretension_n: 70.0,
            f_min_n: 8.0,
            f_max_n: 150.0,
            tendons: constant_tendons(STIFFNESS_N_PER_M).unwrap(),
            stiffness_at: StiffnessAt::Pretension,
            support: Support::new(SupportKind::Spherical, joint).unwrap(),
            demand: None,
        };
        let found = evaluate(&TABLE_1, &query).unwrap();
        let direction = Direction::from_angles(azimuth_rad, tilt_rad).unwrap();
        let own = Load::new(&rig(), PAYLOAD_KG).unwrap().stiffness(&direction);
        let stiffness = own + Matrix3::from_fn(|i, j| found.stiffness_nm_per_rad[i][j]);
        let sagged = solve3(&stiffness, &found.load_moment_nm.into()).unwrap();
        let pose = rotation(azimuth_rad, tilt_rad, found.torsion_rad);
        let pull = |part: f64| {
            let turned = turn(&(sagged * part)) * pose;
            let tendons = Tendons::new(&TABLE_1, &turned);
            let stretched = tendons.lengths - Vector3::from(found.lengths_m);
            let tensions = Vector3::from(found.tensions_n) + stretched * STIFFNESS_N_PER_M;
            axial_pulls(&tendons, &turned).dot(&tensions)
        };
        let change_n = (pull(1e-3) - pull(-1e-3)) / 2e-3;
        let weight_n = (TABLE_1.leg_mass_kg + PAYLOAD_KG) * TABLE_1.gravity_m_per_s2;
        let expected_m = COMPLIANCE_M_PER_N * (weight_n * tilt_rad.cos() - change_n);
        let off = (found.axial_stretch_m - expected_m).abs() / COMPLIANCE_M_PER_N;
        assert!(off < 1e-4, "{off} N at {azimuth_rad}, {tilt_rad}");
    }
}
