#![allow(clippy::unwrap_used, reason = "a test may panic")]

use super::{deviation_m, pretensioned};
use crate::rig_file::RigFile;
use leg_model::{Direction, Query, SupportKind, evaluate, tip_displacement};

const GUIDED: [SupportKind; 2] = [SupportKind::TorsionFree, SupportKind::Universal];

fn query(support: SupportKind) -> Query<f64> {
    Query {
        support,
        ..RigFile::load(None).unwrap().query(200.0, 25.0, 1.0)
    }
}

#[test]
fn without_weights_the_leg_stays() {
    let mut rig = RigFile::load(None).unwrap().parameters;
    rig.gravity_m_per_s2 = 0.0;
    for support in GUIDED {
        let stays = deviation_m(&rig, &query(support)).unwrap().unwrap();
        assert!(stays < 1e-15, "{stays:e}");
    }
}

/// In a plane of symmetry the tendons do not twist the leg; elsewhere their moment about the blocked axis adds to the
/// stiffness as the free plane turns, which the linear deviation leaves out.
#[test]
fn a_small_weight_deviates_linearly_in_a_plane_of_symmetry() {
    let mut rig = RigFile::load(None).unwrap().parameters;
    rig.gravity_m_per_s2 = 1e-5;
    for support in GUIDED {
        let symmetric = Query {
            azimuth_rad: 0.0,
            ..query(support)
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
    for support in GUIDED {
        let query = query(support);
        let start = Direction::from_angles(query.azimuth_rad, query.tilt_rad).unwrap();
        let balance = pretensioned(&rig, &query, &start).unwrap().unwrap();
        // Off the pose, so that the tendons take part.
        let here = Direction::from_angles(query.azimuth_rad + 0.2, query.tilt_rad + 0.05).unwrap();
        let (_, plane) = balance.guided(&here);
        let moment = balance.free_moment_nm(&here).unwrap();
        for (axis, moment) in [[1.0, 0.0], [0.0, 1.0]].into_iter().zip(moment) {
            let energy = |angle: f64| {
                let rotation = plane.rotation(axis) * angle;
                let moved = here.vector() + tip_displacement(&rotation, &here, 1.0);
                balance
                    .energy_j(&Direction::from_xy(moved.x, moved.y).unwrap())
                    .unwrap()
            };
            let numeric = -(energy(1e-5) - energy(-1e-5)) / 2e-5;
            assert!(
                (moment - numeric).abs() < 1e-6 * moment.abs(),
                "{support:?}: {moment} {numeric}"
            );
        }
    }
}

#[test]
fn a_tendon_may_go_slack_on_the_way() {
    let file = RigFile::load(None).unwrap();
    let slack = Query {
        level_n: 10.0,
        payload_kg: 2.0,
        ..query(SupportKind::TorsionFree)
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
    let guided = query(SupportKind::TorsionFree);
    let pushes = Query {
        level_n: -1.0,
        ..guided
    };
    for query in [query(SupportKind::Spherical), pushes] {
        assert_eq!(deviation_m(&rig, &query).unwrap(), None, "{query:?}");
    }
}
