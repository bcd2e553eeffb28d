//! Identities of the model on random mechanisms with three to six tendons, in f64.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use crate::common::constant_tendons;
use crate::common::numeric::{STEP_RAD, derivative_by_rotation};
use crate::common::reference::{Tendons, load_moment, skew, turn};
use leg_model::{
    Direction, FreePlane, Load, Query, Rig, RigParameters, StiffnessAt, SupportKind, Symmetric3,
    TendonStates, TensionBounds, distribute, evaluate, full_pass, full_pass_in_plane,
    inverse_kinematics, solve3, structural_stiffness, tendon_stiffness,
};
use nalgebra::{Matrix3, SVector, Vector2, Vector3};
use proptest::prelude::{Strategy, any, prop, proptest};

/// Distances of one pair of anchors from those of an even ring: angle of the pair, angle of the lower one (both as
/// parts of the spacing), radii (m).
type Jitter = ((f64, f64), (f64, f64));

/// A mechanism of the size of Table 1's, its anchors on no ring, in either order.
fn rigs<const N: usize>() -> impl Strategy<Value = RigParameters<f64, N>> {
    let jitter = (
        (-0.2..0.2_f64, -0.1..0.1_f64),
        (0.015..0.04_f64, 0.015..0.04_f64),
    );
    let anchors = (
        prop::array::uniform::<_, N>(jitter),
        -3.2..3.2_f64,
        any::<bool>(),
    );
    let lengths = (0.0..0.02_f64, 0.025..0.05_f64, 0.1..0.3_f64);
    let load = (0.0..2.0_f64, 0.0..0.2_f64, 1.0..10.0_f64);
    (anchors, lengths, load).prop_map(|((jitters, phase, clockwise), (upper, joint, leg), load)| {
        let turn = if clockwise { -1.0 } else { 1.0 };
        let spacing = turn * std::f64::consts::TAU / (N as f64);
        let anchor = |i: usize, angle: f64, radius: f64| {
            let (sin, cos) = (phase + spacing * (i as f64 + angle)).sin_cos();
            [radius * cos, radius * sin]
        };
        let base = |i: usize, ((angle, _), (radius, _)): Jitter| anchor(i, angle, radius);
        let lower =
            |i: usize, ((angle, twist), (_, radius)): Jitter| anchor(i, angle + twist, radius);
        RigParameters {
            base_anchors_m: std::array::from_fn(|i| base(i, jitters[i])),
            leg_anchors_m: std::array::from_fn(|i| lower(i, jitters[i])),
            upper_length_m: upper,
            joint_length_m: joint,
            leg_length_m: leg,
            leg_mass_kg: load.0,
            leg_centroid_m: load.1,
            gravity_m_per_s2: load.2,
        }
    })
}

fn directions() -> impl Strategy<Value = Direction<f64>> {
    let angles = (-3.2..3.2_f64, 0.0..40_f64.to_radians());
    angles.prop_map(|(azimuth, tilt)| Direction::from_angles(azimuth, tilt).unwrap())
}

fn states<const N: usize>() -> impl Strategy<Value = TendonStates<f64, N>> {
    let tensions = prop::array::uniform::<_, N>(5.0..150.0_f64);
    let stiffnesses = prop::array::uniform::<_, N>(2e4..2e5_f64);
    (tensions, stiffnesses).prop_map(|(tensions, stiffnesses)| {
        TendonStates::new(tensions.into(), stiffnesses.into()).unwrap()
    })
}

/// A mechanism at a pose, with a load (kg).
type State<const N: usize> = (
    RigParameters<f64, N>,
    Direction<f64>,
    TendonStates<f64, N>,
    f64,
);

fn all<const N: usize>() -> impl Strategy<Value = State<N>> {
    (rigs(), directions(), states(), 0.0..3.0_f64)
}

fn assert_kinematics<const N: usize>((parameters, direction, ..): &State<N>) {
    let rig = Rig::new(parameters).unwrap();
    let found = inverse_kinematics(rig.geometry(), direction).unwrap();
    let expected = Tendons::new(parameters, &direction.rotation());
    assert!((found.lengths - expected.lengths).amax() < 1e-15);
    assert!((found.moment_map - expected.moment_map()).amax() < 1e-15);
}

/// Σ f(−[n×][e×] + (1/l)[e×](I − nnᵀ)[e×]ᵀ).
fn k2<const N: usize>(tendons: &Tendons<N>, tensions: &SVector<f64, N>) -> Matrix3<f64> {
    let term = |i: usize| {
        let (e, n) = (skew(&tendons.ends[i]), tendons.pulls[i]);
        let across = Matrix3::identity() - n * n.transpose();
        (e * across * e.transpose() / tendons.lengths[i] - skew(&n) * e) * tensions[i]
    };
    (0..N).map(term).sum()
}

/// How far differences may be from the derivative of the tendons' moment, N·m/rad.
///
/// A tendon's moment is a power series in the angle that converges to l/|e|, where its end may meet its anchor: the terms
/// of fourth order and above are 4(h|e|/l)⁴ of f|e|²/l. Rounding is 1e-16 of f|e| over the step, some ten times.
fn differences_bound<const N: usize>(tendons: &Tendons<N>, tensions: &SVector<f64, N>) -> f64 {
    let term = |i: usize| {
        let (end_m, length_m) = (tendons.ends[i].norm(), tendons.lengths[i]);
        let truncated = 4.0 * (STEP_RAD * end_m / length_m).powi(4) * end_m / length_m;
        tensions[i] * end_m * (truncated + 1e-15 / STEP_RAD)
    };
    (0..N).map(term).sum()
}

fn assert_structural_stiffness<const N: usize>((parameters, direction, states, _): &State<N>) {
    let rig = Rig::new(parameters).unwrap();
    let found = structural_stiffness(rig.geometry(), direction, states.tensions());
    let pose = direction.rotation();
    let tendons = Tendons::new(parameters, &pose);
    assert!((found - k2(&tendons, states.tensions())).amax() < 1e-12 * states.tensions().norm());
    let moment =
        |psi| Tendons::new(parameters, &(turn(&psi) * pose)).moment_map() * states.tensions();
    let error = (found + derivative_by_rotation(moment)).amax();
    let bound = differences_bound(&tendons, states.tensions());
    assert!(error < bound, "{error:e} beyond {bound:e} N·m/rad");
    // Its antisymmetric part is half the moment of the tendons.
    let half = skew(&moment(Vector3::zeros())) / 2.0;
    let odd = (found - found.transpose()) / 2.0;
    assert!((odd - half).amax() < 1e-12 * states.tensions().norm());
}

/// The fast path against the sum of the three stiffnesses, and its solutions against the sum's.
fn assert_full_pass<const N: usize>((parameters, direction, states, payload_kg): &State<N>) {
    let rig = Rig::new(parameters).unwrap();
    let load = Load::new(&rig, *payload_kg).unwrap();
    let kinematics = inverse_kinematics(rig.geometry(), direction).unwrap();
    let total = tendon_stiffness(&kinematics.moment_map, states.stiffnesses())
        + structural_stiffness(rig.geometry(), direction, states.tensions())
        + load.stiffness(direction);
    let symmetric = Symmetric3::symmetric_part(&total).matrix();
    let pass = full_pass(&rig, direction, &load, states);
    assert_eq!(pass.kinematics, kinematics);
    assert!((pass.stiffness.matrix() - symmetric).amax() < 1e-12 * symmetric.amax());
    let moment = load.moment(direction);
    let plane = FreePlane::torsion_free(direction);
    let in_plane = full_pass_in_plane(&rig, direction, &plane, &load, states);
    let pairs = [
        (pass.deflection, solve3(&symmetric, &moment)),
        (in_plane.deflection, plane.solve(&symmetric, &moment)),
    ];
    for (deflection, rotation) in pairs {
        assert_eq!(deflection.err(), rotation.err());
        if let (Ok(deflection), Ok(rotation)) = (deflection, rotation) {
            let error = (deflection.rotation - rotation).norm();
            assert!(error <= 1e-9 * rotation.norm(), "{error:e} rad");
            let tip = rotation.cross(&direction.vector()) * rig.tip_m();
            assert!((deflection.tip_displacement - tip).norm() <= 1e-9 * tip.norm());
        }
    }
}

fn assert_balance<const N: usize>((parameters, direction, _, payload_kg): &State<N>) {
    let rig = Rig::new(parameters).unwrap();
    let moment_map = Tendons::new(parameters, &direction.rotation()).moment_map();
    let moment = load_moment(parameters, &direction.rotation(), *payload_kg);
    let plane = FreePlane::torsion_free(direction);
    let bounds = TensionBounds::new(8.0, 150.0).unwrap();
    let load = Load::new(&rig, *payload_kg).unwrap().moment(direction);
    assert!((load - moment).amax() < 1e-14);
    let found = distribute(&moment_map, &plane, &load, &bounds).unwrap();
    for pretension in [0.0, 70.0] {
        let rest =
            Vector2::from(plane.project(&(moment_map * found.tensions(pretension) + moment)));
        assert!(rest.amax() < 1e-11, "{rest} N·m");
    }
    // Pretension pulls, in whichever order the tendons stand.
    assert!(found.per_pretension.sum() > 0.0);
    // The smallest solution has no part along the pretension.
    let part = found.particular.dot(&found.per_pretension);
    assert!(
        part.abs() < 1e-10 * (1.0 + found.particular.norm()),
        "{part} N"
    );
    let ends =
        [found.pretension_min, found.pretension_max].map(|pretension| found.tensions(pretension));
    if found.feasible() {
        for tensions in ends {
            assert!(
                tensions.min() > 8.0 - 1e-9 && tensions.max() < 150.0 + 1e-9,
                "{tensions}"
            );
        }
    }
}

fn assert_all<const N: usize>(state: &State<N>) {
    assert_kinematics(state);
    assert_structural_stiffness(state);
    assert_full_pass(state);
    assert_balance(state);
}

proptest! {
    #[test]
    fn three_tendons_keep_every_identity(state in all::<3>()) {
        assert_all(&state);
    }

    #[test]
    fn four_tendons_keep_every_identity(state in all::<4>()) {
        assert_all(&state);
    }

    #[test]
    fn five_tendons_keep_every_identity(state in all::<5>()) {
        assert_all(&state);
    }

    #[test]
    fn six_tendons_keep_every_identity(state in all::<6>()) {
        assert_all(&state);
    }

    #[test]
    fn an_evaluation_has_the_stiffness_of_the_full_pass((parameters, direction, _, payload_kg) in all::<3>()) {
        let p = direction.vector();
        let query = Query {
            azimuth_rad: p.y.atan2(p.x),
            tilt_rad: (-p.z).acos(),
            payload_kg,
            pretension_n: 50.0,
            f_min_n: 8.0,
            f_max_n: 150.0,
            tendons: constant_tendons(1e5).unwrap(),
            stiffness_at: StiffnessAt::Pretension,
            support: SupportKind::TorsionFree.into(), demand: None,
        };
        let found = evaluate(&parameters, &query).unwrap();
        let rig = Rig::new(&parameters).unwrap();
        let load = Load::new(&rig, payload_kg).unwrap();
        let states = TendonStates::new(found.tensions_n.into(), Vector3::repeat(1e5)).unwrap();
        let pass = full_pass(&rig, &direction, &load, &states).stiffness.matrix();
        let rows = found.stiffness_nm_per_rad;
        let ours = Matrix3::from_fn(|i, j| rows[i][j]) + load.stiffness(&direction);
        let error = (ours + ours.transpose()) / 2.0 - pass;
        // The angles cost a few bits near the vertical.
        assert!(error.amax() < 1e-7 * pass.amax(), "{error}");
    }
}
