//! Whatever bits arrive, the model in f32 gives finite numbers or a named error.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use leg_firmware::settings::TendonParameters;
use leg_firmware_bench::query::QueryMessage;
use leg_model::{
    CURVE_POINTS_MAX, CurvePoint, Direction, Evaluation, FreePlane, JointStiffness, Load, Rig,
    RigParameters, StiffnessAt, StiffnessDemand, SupportKind, TendonStates, TensionBounds,
    distribute, evaluate, forward_kinematics, full_pass, full_pass_in_plane, inverse_kinematics,
};
use nalgebra::Vector3;
use proptest::prelude::{Just, ProptestConfig, Strategy, any, prop, prop_oneof, proptest};
use proptest::strategy::ValueTree;
use proptest::test_runner::TestRunner;

/// Any bits, the values at which something changes, and what a user may mean.
fn numbers() -> impl Strategy<Value = f32> {
    const SPECIAL: [f32; 12] = [
        0.0,
        -0.0,
        1.0,
        -1.0,
        f32::NAN,
        f32::INFINITY,
        f32::NEG_INFINITY,
        f32::MAX,
        f32::MIN,
        f32::MIN_POSITIVE,
        1e-45,
        1e19,
    ];
    prop_oneof![
        any::<u32>().prop_map(f32::from_bits),
        prop::sample::select(&SPECIAL[..]),
        -1.0..1.0_f32,
        0.0..200.0_f32,
    ]
}

/// Numbers of which most are sensible, so that the rest meets every part of the model and not the first check only.
fn perturbed(sensible: f32) -> impl Strategy<Value = f32> {
    prop_oneof![7 => Just(sensible), 1 => numbers()]
}

/// Moments up to those that a distribution takes, and those that are no numbers.
fn moment_near(sensible: f32) -> impl Strategy<Value = f32> {
    perturbed(sensible).prop_filter("beyond 10¹² N·m", |m| !m.is_finite() || m.abs() <= 1e12)
}

fn rigs() -> impl Strategy<Value = RigParameters<f32, 3>> {
    let p = RigParameters::<f32, 3>::TABLE_1;
    let anchors = |a: [[f32; 2]; 3]| a.map(|[x, y]| [perturbed(x), perturbed(y)]);
    let lengths = [p.upper_length_m, p.joint_length_m, p.leg_length_m].map(perturbed);
    let load = [p.leg_mass_kg, p.leg_centroid_m, p.gravity_m_per_s2].map(perturbed);
    let anchors = (anchors(p.base_anchors_m), anchors(p.leg_anchors_m));
    (anchors, lengths, load).prop_map(|((base, leg), lengths, load)| RigParameters {
        base_anchors_m: base,
        leg_anchors_m: leg,
        upper_length_m: lengths[0],
        joint_length_m: lengths[1],
        leg_length_m: lengths[2],
        leg_mass_kg: load[0],
        leg_centroid_m: load[1],
        gravity_m_per_s2: load[2],
    })
}

fn queries() -> impl Strategy<Value = QueryMessage> {
    let numbers = [0.5, 0.5, 1.0, 70.0, 8.0, 150.0].map(perturbed);
    let readings = prop::sample::select(&[StiffnessAt::Pretension, StiffnessAt::Tension][..]);
    let demand = (
        perturbed(100.0),
        prop_oneof![Just(None), perturbed(1.0).prop_map(Some)],
    )
        .prop_map(|(stiffness_nm_per_rad, towards_rad)| StiffnessDemand {
            stiffness_nm_per_rad,
            towards_rad,
        });
    let demand = prop_oneof![Just(None), demand.prop_map(Some)];
    (numbers, tendons(), readings, supports(), demand).prop_map(
        |(n, tendons, stiffness_at, (support, joint), demand)| QueryMessage {
            azimuth_rad: n[0],
            tilt_rad: n[1],
            payload_kg: n[2],
            pretension_n: n[3],
            f_min_n: n[4],
            f_max_n: n[5],
            tendons,
            stiffness_at,
            support,
            joint,
            demand,
        },
    )
}

fn supports() -> impl Strategy<Value = (SupportKind, JointStiffness<f32>)> {
    const KINDS: [SupportKind; 4] = [
        SupportKind::TorsionFree,
        SupportKind::Universal,
        SupportKind::Spherical,
        SupportKind::ElasticUniversal,
    ];
    let joint = [1.0, 5.0, 1e-7].map(|value| prop_oneof![Just(0.0), perturbed(value)]);
    (prop::sample::select(&KINDS[..]), joint).prop_map(|(kind, joint)| {
        let [
            bending_nm_per_rad,
            torsion_nm_per_rad,
            axial_compliance_m_per_n,
        ] = joint;
        let joint = JointStiffness {
            bending_nm_per_rad,
            torsion_nm_per_rad,
            axial_compliance_m_per_n,
        };
        (kind, joint)
    })
}

/// Constant tendons, and curves of which one point is anything.
fn tendons() -> impl Strategy<Value = [TendonParameters; 3]> {
    let curve =
        (0..CURVE_POINTS_MAX, [10.0, 5e-4, 2e4].map(perturbed)).prop_map(|(at, strange)| {
            let mut points = CurvePoint::<f32>::PAPER;
            if strange[0].to_bits() % 2 == 0 {
                points[at] = CurvePoint {
                    tension_n: strange[0],
                    elongation_m: strange[1],
                    stiffness_n_per_m: strange[2],
                };
            }
            TendonParameters::Curve(points.into_iter().collect())
        });
    let tendon = prop_oneof![perturbed(1e5).prop_map(TendonParameters::Constant), curve];
    tendon.prop_map(|tendon| [tendon.clone(), tendon.clone(), tendon])
}

fn assert_finite(evaluation: &Evaluation<f32>) {
    let e = evaluation;
    let commanded = e
        .commanded
        .map_or([0.0; 2], |c| [c.pretension_n, c.stiffness_nm_per_rad]);
    let numbers = [
        &e.lengths_m[..],
        e.moment_map_m.as_flattened(),
        &e.pretension_direction,
        &e.load_moment_nm,
        &e.tensions_n,
        &e.tensions_min_n,
        &e.pretension_range_n,
        e.stiffness_nm_per_rad.as_flattened(),
        e.stiffness_k2_exact_nm_per_rad.as_flattened(),
        e.stiffness_k2_printed_nm_per_rad.as_flattened(),
        &[
            e.deviation_m,
            e.deviation_with_load_stiffness_m,
            e.torsion_rad,
        ],
        &e.unstretched_m,
        &e.joint_moment_nm,
        e.stiffness_joint_nm_per_rad.as_flattened(),
        &e.bending_stiffness_nm_per_rad,
        &[e.axial_stretch_m],
        &commanded,
    ];
    assert!(
        numbers.concat().iter().all(|number| number.is_finite()),
        "{e:?}"
    );
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(4_096))]

    #[test]
    fn an_evaluation_is_finite_or_an_error(rig in rigs(), query in queries()) {
        if let Ok(evaluation) = query.query().and_then(|query| evaluate(&rig, &query)) {
            assert_finite(&evaluation);
        }
    }

    #[test]
    fn a_direction_is_a_unit_vector_or_an_error(x in numbers(), y in numbers()) {
        let directions = [Direction::from_xy(x, y), Direction::from_angles(x, y)];
        for direction in directions.into_iter().flatten() {
            let norm = direction.vector().norm();
            assert!((norm - 1.0).abs() < 1e-6 && direction.vector().z < 0.0, "{direction:?}");
            assert!(direction.rotation().iter().all(|entry| entry.is_finite()));
        }
    }

    #[test]
    fn forward_kinematics_is_finite_or_an_error(
        rig in rigs(), lengths in [0.035, 0.03, 0.04].map(perturbed), x in perturbed(0.1), y in perturbed(-0.2),
    ) {
        let (Ok(rig), Ok(start)) = (Rig::new(&rig), Direction::from_xy(x, y)) else { return Ok(()) };
        if let Ok(found) = forward_kinematics(rig.geometry(), &lengths.into(), &start) {
            let p = found.direction.vector();
            assert!((p.norm() - 1.0).abs() < 1e-6 && p.z < 0.0, "{found:?}");
            assert!(found.residual_m.is_finite() && found.residual_m >= 0.0, "{found:?}");
        }
    }

    #[test]
    fn the_fast_path_is_finite_or_an_error(
        rig in rigs(), (x, y) in (perturbed(0.1), perturbed(-0.2)), payload_kg in perturbed(1.0),
        tensions in [70.0, 50.0, 90.0].map(perturbed), stiffnesses in [1e5, 1.1e5, 0.9e5].map(perturbed),
    ) {
        let (Ok(rig), Ok(direction)) = (Rig::new(&rig), Direction::from_xy(x, y)) else { return Ok(()) };
        let Ok(load) = Load::new(&rig, payload_kg) else { return Ok(()) };
        let Ok(states) = TendonStates::new(tensions.into(), stiffnesses.into()) else { return Ok(()) };
        let plane = FreePlane::torsion_free(&direction);
        let passes = [
            full_pass(&rig, &direction, &load, &states),
            full_pass_in_plane(&rig, &direction, &plane, &load, &states),
        ];
        for pass in passes {
            if let Ok(deflection) = pass.deflection {
                let vectors = [deflection.rotation, deflection.tip_displacement, pass.kinematics.lengths];
                assert!(vectors.iter().all(|v| v.iter().all(|c| c.is_finite())), "{pass:?}");
            }
        }
    }

    /// The weights of the greatest mechanism that the model serves have a moment of 4e11 N·m.
    #[test]
    fn a_distribution_is_finite_or_an_error(
        rig in rigs(), (x, y) in (perturbed(0.1), perturbed(-0.2)), moment in [1.0, 2.0, 0.1].map(moment_near),
        (floor, ceiling) in (perturbed(8.0), perturbed(150.0)),
    ) {
        let (Ok(rig), Ok(direction)) = (Rig::new(&rig), Direction::from_xy(x, y)) else { return Ok(()) };
        let Ok(bounds) = TensionBounds::new(floor, ceiling) else { return Ok(()) };
        let Ok(kinematics) = inverse_kinematics(rig.geometry(), &direction) else { return Ok(()) };
        if moment.iter().any(|m| m.is_finite() && m.abs() > 1e12) { return Ok(()) }
        let plane = FreePlane::torsion_free(&direction);
        if let Ok(found) = distribute(&kinematics.moment_map, &plane, &Vector3::from(moment), &bounds) {
            let pretensions = [found.pretension_min, found.pretension_max];
            let finite = |v: &[f32]| v.iter().all(|number| number.is_finite());
            assert!(finite(found.particular.as_slice()) && finite(found.per_pretension.as_slice()), "{found:?}");
            assert!(finite(&pretensions), "{found:?}");
        }
    }
}

/// What is checked above is not all refused.
#[test]
fn some_of_these_inputs_have_a_result() {
    let mut runner = TestRunner::deterministic();
    let inputs = (rigs(), queries());
    let mut results = 0;
    for _ in 0..4_096 {
        let (rig, query) = inputs.new_tree(&mut runner).unwrap().current();
        let result = query.query().and_then(|query| evaluate(&rig, &query));
        results += u32::from(result.is_ok());
    }
    assert!(results > 100, "{results} of 4096");
}
