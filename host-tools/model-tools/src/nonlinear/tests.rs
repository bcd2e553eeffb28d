#![allow(clippy::unwrap_used, reason = "a test may panic")]

use super::{Posture, deviation_m, pretensioned};
use leg_model::{
    Direction, Error, JointStiffness, Quantity, Query, Reason, StiffnessAt, Support, SupportKind,
    Tendon, evaluate,
};
use leg_rig::rig_file::RigFile;
use nalgebra::Vector3;

/// Every kind of support, rigid and elastic.
fn supports() -> Vec<Support<f64>> {
    let elastic = |kind, torsion_nm_per_rad| {
        let joint = JointStiffness {
            bending_nm_per_rad: 2.0,
            torsion_nm_per_rad,
            axial_compliance_m_per_n: 0.0,
        };
        Support::new(kind, joint).unwrap()
    };
    vec![
        SupportKind::TorsionFree.into(),
        SupportKind::Universal.into(),
        SupportKind::Spherical.into(),
        elastic(SupportKind::Spherical, 1.5),
        elastic(SupportKind::ElasticUniversal, 10.0),
    ]
}

fn query(support: Support<f64>) -> Query<f64> {
    Query {
        support,
        ..RigFile::load(None).unwrap().query(200.0, 25.0, 1.0)
    }
}

#[test]
fn without_weights_the_leg_stays() {
    let mut rig = RigFile::load(None).unwrap().parameters;
    rig.gravity_m_per_s2 = 0.0;
    for support in supports() {
        let stays = deviation_m(&rig, &query(support)).unwrap().unwrap();
        assert!(stays < 1e-13, "{support:?}: {stays:e}");
    }
}

/// In a plane of symmetry the tendons do not twist the leg; elsewhere their moment about the blocked axis adds to the
/// stiffness as the free plane turns, which the linear deviation leaves out.
#[test]
fn a_small_weight_deviates_linearly_in_a_plane_of_symmetry() {
    let mut rig = RigFile::load(None).unwrap().parameters;
    rig.gravity_m_per_s2 = 1e-5;
    for support in [SupportKind::TorsionFree, SupportKind::Universal] {
        let symmetric = Query {
            azimuth_rad: 0.0,
            // The tensions of the pretension differ as the leg leans, and with them the slopes of the curve.
            stiffness_at: StiffnessAt::Tension,
            ..query(support.into())
        };
        let linear = evaluate(&rig, &symmetric).unwrap().deviation_m;
        let nonlinear = deviation_m(&rig, &symmetric).unwrap().unwrap();
        let relative = (nonlinear / linear - 1.0).abs();
        assert!(relative < 1e-6, "{support:?}: {relative:e}");
    }
}

#[test]
fn the_moment_is_the_energys_derivative() {
    let rig = RigFile::load(None).unwrap().parameters;
    for support in supports() {
        let query = query(support);
        let (without_weights, _) = pretensioned(&rig, &query).unwrap().unwrap();
        let balance = without_weights.with_payload(1.0).unwrap();
        // Off the pose, so that tendons and joint take part.
        let direction =
            Direction::from_angles(query.azimuth_rad + 0.02, query.tilt_rad + 0.01).unwrap();
        let torsion = if support.twists() { 0.03 } else { 0.0 };
        let here = Posture { direction, torsion };
        let moment = balance.free_moment_nm(&here).unwrap();
        let plane = support.plane(&direction);
        let mut rotations = vec![plane.rotation([1.0, 0.0]), plane.rotation([0.0, 1.0])];
        if support.twists() {
            rotations = vec![Vector3::x(), Vector3::y(), Vector3::z()];
        }
        for (rotation, moment) in rotations.iter().zip(moment.iter()) {
            let energy = |angle: f64| {
                let turned = balance.turned(&here, &(rotation * angle)).unwrap();
                balance.energy_j(&turned).unwrap()
            };
            let numeric = -(energy(1e-5) - energy(-1e-5)) / 2e-5;
            assert!(
                (moment - numeric).abs() < 1e-7 + 1e-6 * moment.abs(),
                "{support:?}: {moment} {numeric}"
            );
        }
    }
}

#[test]
fn a_tendon_may_go_slack_on_the_way() {
    let file = RigFile::load(None).unwrap();
    let slack = Query {
        pretension_n: 10.0,
        payload_kg: 2.0,
        tendons: [Tendon::constant(99_450.0).unwrap(); 3],
        ..query(SupportKind::TorsionFree.into())
    };
    let linear = evaluate(&file.parameters, &slack).unwrap();
    assert!(linear.tensions_n.iter().any(|&tension| tension < 0.0));
    let nonlinear = deviation_m(&file.parameters, &slack).unwrap().unwrap();
    // Two tendons are softer than three.
    assert!(nonlinear > 1.05 * linear.deviation_with_load_stiffness_m);
}

#[test]
fn what_has_no_meaning_is_left_out() {
    let rig = RigFile::load(None).unwrap().parameters;
    let pushes = Query {
        pretension_n: -1.0,
        ..query(SupportKind::TorsionFree.into())
    };
    assert_eq!(deviation_m(&rig, &pushes).unwrap(), None);
}

#[test]
fn a_load_beyond_the_tendons_curve_is_an_error() {
    let rig = RigFile::load(None).unwrap().parameters;
    let heavy = Query {
        payload_kg: 20.0,
        ..query(SupportKind::TorsionFree.into())
    };
    let beyond = Error::Refused {
        quantity: Quantity::Elongation,
        reason: Reason::BeyondCurve,
    };
    assert_eq!(deviation_m(&rig, &heavy), Err(beyond));
}
