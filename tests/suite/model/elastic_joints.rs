//! Elastic joints: moment and stiffness against derivatives of an energy on rotation matrices, and their limits.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use leg_model::{
    Direction, JointStiffness, Load, Query, Rig, Support, SupportKind, TensionBounds, Twist,
    elastic_torsion, estimate_load, evaluate, inverse_statics, printed,
};
use leg_rig::rig_file::RigFile;
use nalgebra::{Matrix3, Rotation3, Vector3};

const BENDING: f64 = 2.0;
const TORSION: f64 = 5.0;

fn joint(bending_nm_per_rad: f64, torsion_nm_per_rad: f64) -> JointStiffness<f64> {
    JointStiffness {
        bending_nm_per_rad,
        torsion_nm_per_rad,
        axial_compliance_m_per_n: 0.0,
    }
}

fn support(kind: SupportKind) -> Support<f64> {
    Support::new(kind, joint(BENDING, TORSION)).unwrap()
}

/// Energy of the joint of a leg with rotation R, by the angles that R has.
fn energy(kind: SupportKind, r: &Matrix3<f64>) -> f64 {
    let (bent, twisted) = if kind == SupportKind::ElasticUniversal {
        // R = Rx(α)Ry(β)Rz(γ).
        let alpha = (-r[(1, 2)]).atan2(r[(2, 2)]);
        let beta = r[(0, 2)].asin();
        (alpha * alpha + beta * beta, (-r[(0, 1)]).atan2(r[(0, 0)]))
    } else {
        // Tilt and torsion.
        let tilt = r[(2, 2)].clamp(-1.0, 1.0).acos();
        let torsion = (r[(1, 0)] - r[(0, 1)]).atan2(r[(0, 0)] + r[(1, 1)]);
        (tilt * tilt, torsion)
    };
    0.5 * (BENDING * bent + TORSION * twisted * twisted)
}

/// The rotation of a leg at a direction with an elastic torsion.
fn rotation(support: &Support<f64>, direction: &Direction<f64>, torsion: f64) -> Matrix3<f64> {
    let twist = support
        .twist(direction)
        .composed(&Twist::from_torsion(torsion));
    let about_leg = Rotation3::from_axis_angle(&Vector3::z_axis(), twist.torsion());
    direction.rotation() * about_leg.matrix()
}

/// Energy after a further small rotation.
fn turned(kind: SupportKind, r: &Matrix3<f64>, by: Vector3<f64>) -> f64 {
    energy(kind, &(Rotation3::new(by).matrix() * r))
}

fn numeric_moment(kind: SupportKind, r: &Matrix3<f64>) -> Vector3<f64> {
    Vector3::from_fn(|i, _| {
        let step = Vector3::ith(i, 1e-6);
        (turned(kind, r, -step) - turned(kind, r, step)) / 2e-6
    })
}

fn numeric_stiffness(kind: SupportKind, r: &Matrix3<f64>) -> Matrix3<f64> {
    let h = 1e-4;
    Matrix3::from_fn(|i, j| {
        let (a, b) = (Vector3::ith(i, h), Vector3::ith(j, h));
        let energy = |rotation| turned(kind, r, rotation);
        (energy(a + b) - energy(a - b) - energy(b - a) + energy(-a - b)) / (4.0 * h * h)
    })
}

const ELASTIC: [SupportKind; 2] = [SupportKind::Spherical, SupportKind::ElasticUniversal];

/// Azimuth and tilt in degrees, elastic torsion in rad.
const POSTURES: [(f64, f64, f64); 6] = [
    (0.0, 0.01, 0.0),
    (30.0, 30.0, 0.02),
    (100.0, 20.0, -0.05),
    (225.0, 10.0, 0.1),
    (300.0, 29.0, -0.01),
    (45.0, 60.0, 0.03),
];

fn pointing(azimuth_deg: f64, tilt_deg: f64) -> Direction<f64> {
    Direction::from_angles(azimuth_deg.to_radians(), tilt_deg.to_radians()).unwrap()
}

#[test]
fn the_moment_is_the_derivative_of_the_energy_of_the_rotation() {
    for kind in ELASTIC {
        let support = support(kind);
        for (azimuth, tilt, torsion) in POSTURES {
            let direction = pointing(azimuth, tilt);
            let numeric = numeric_moment(kind, &rotation(&support, &direction, torsion));
            let moment = support.joint_moment(&direction, torsion);
            assert!(
                (moment - numeric).norm() < 1e-7,
                "{kind:?} {azimuth} {tilt}: {moment} {numeric}"
            );
            let same = support.joint_energy(&direction, torsion);
            let energy = energy(kind, &rotation(&support, &direction, torsion));
            assert!((same - energy).abs() < 1e-12, "{kind:?}: {same} {energy}");
        }
    }
}

#[test]
fn the_stiffness_is_the_derivative_of_the_moment() {
    for kind in ELASTIC {
        let support = support(kind);
        for (azimuth, tilt, torsion) in POSTURES {
            let direction = pointing(azimuth, tilt);
            let numeric = numeric_stiffness(kind, &rotation(&support, &direction, torsion));
            let stiffness = support.joint_stiffness(&direction, torsion);
            let symmetric = (stiffness + stiffness.transpose()) * 0.5;
            let difference = (symmetric - numeric).norm();
            assert!(
                difference < 2e-6,
                "{kind:?} {azimuth} {tilt}: {symmetric}{numeric}"
            );
            // Half the moment is in the antisymmetric part.
            let moment = support.joint_moment(&direction, torsion);
            let half = (stiffness - stiffness.transpose()) * 0.5;
            let skew = Vector3::new(half[(2, 1)], half[(0, 2)], half[(1, 0)]);
            assert!(
                (skew.norm() - 0.5 * moment.norm()).abs() < 1e-9,
                "{skew} {moment}"
            );
        }
    }
}

#[test]
fn at_the_vertical_the_stiffness_is_the_joints_diagonal() {
    for kind in ELASTIC {
        let support = support(kind);
        let down = Direction::straight_down();
        let leg_fixed = printed::joint_stiffness_leg_fixed(support.joint(), &down);
        assert_eq!(
            leg_fixed.diagonal(),
            Vector3::new(BENDING, BENDING, TORSION)
        );
        assert!((support.joint_stiffness(&down, 0.0) - leg_fixed).norm() < 1e-15);
    }
}

fn query(support: Support<f64>) -> Query<f64> {
    Query {
        support,
        ..RigFile::load(None).unwrap().query(40.0, 25.0, 1.0)
    }
}

fn deviation(support: Support<f64>) -> (f64, f64, [f64; 2]) {
    let rig = RigFile::load(None).unwrap().parameters;
    let found = evaluate(&rig, &query(support)).unwrap();
    (
        found.deviation_m,
        found.torsion_rad,
        found.tensions_n[..2].try_into().unwrap(),
    )
}

/// What the bent joint takes is no part of the load.
#[test]
fn the_load_of_the_tensions_that_hold_a_leg_is_the_one_that_they_hold() {
    let file = RigFile::load(None).unwrap();
    let rig = Rig::new(&file.parameters).unwrap();
    let support = support(SupportKind::ElasticUniversal);
    let bounds = TensionBounds::new(0.0, 300.0).unwrap();
    for (azimuth, tilt) in [(0.0, 10.0), (40.0, 25.0), (200.0, 30.0)] {
        let direction = pointing(azimuth, tilt);
        let load = Load::new(&rig, 1.0).unwrap().moment(&direction);
        let held = inverse_statics(
            &rig,
            &support,
            &direction,
            &load,
            &bounds,
            &file.tendons,
            100.0,
        )
        .unwrap();
        let torsion = elastic_torsion(&rig, &support, &direction, &load, &bounds, 100.0).unwrap();
        let twist = support
            .twist(&direction)
            .composed(&Twist::from_torsion(torsion));
        let geometry = rig.geometry().twisted(&twist);
        let found =
            estimate_load(&geometry, &support, &direction, torsion, &held.tensions).unwrap();
        let plane = support.plane(&direction);
        for (found, held) in plane.project(&found).into_iter().zip(plane.project(&load)) {
            assert!((found - held).abs() < 1e-12, "{found} {held} N·m");
        }
    }
}

/// Asserts that two deviations agree within the first bound, their torsions and tensions within the second.
fn assert_alike(
    a: (f64, f64, [f64; 2]),
    b: (f64, f64, [f64; 2]),
    [deviation_bound, bound]: [f64; 2],
) {
    assert!((a.0 / b.0 - 1.0).abs() < deviation_bound, "{} {}", a.0, b.0);
    assert!((a.1 - b.1).abs() < bound, "torsion {} {}", a.1, b.1);
    for (a, b) in a.2.iter().zip(b.2) {
        assert!((a / b - 1.0).abs() < bound, "tension {a} {b}");
    }
}

/// The torsion moment that the joint takes turns with its axis, which the linear deviation on a rigid joint leaves out.
#[test]
fn a_universal_joint_of_ever_stiffer_torsion_becomes_a_rigid_one() {
    let kind = SupportKind::ElasticUniversal;
    let stiff = deviation(Support::new(kind, joint(0.0, 1e6)).unwrap());
    let rigid = deviation(SupportKind::Universal.into());
    assert_alike(stiff, rigid, [2e-3, 1e-4]);
}

#[test]
fn a_pivot_of_vanishing_stiffness_is_a_ball_joint() {
    let soft = deviation(Support::new(SupportKind::Spherical, joint(1e-9, 1e-9)).unwrap());
    let ball = deviation(SupportKind::Spherical.into());
    assert_alike(soft, ball, [1e-8; 2]);
}

#[test]
fn a_joint_in_parallel_stiffens_and_the_printed_series_does_not() {
    let rig = RigFile::load(None).unwrap().parameters;
    let bare = evaluate(&rig, &query(SupportKind::Spherical.into())).unwrap();
    let elastic = Support::new(SupportKind::Spherical, joint(5.0, 4.0)).unwrap();
    let stiffened = evaluate(&rig, &query(elastic)).unwrap();
    assert!(stiffened.deviation_m < bare.deviation_m);
    // Eq. (20) with a ball joint: no stiffness at all.
    let matrix = |rows: [[f64; 3]; 3]| Matrix3::from_fn(|i, j| rows[i][j]);
    let tendons = matrix(bare.stiffness_nm_per_rad);
    let printed = printed::series_stiffness(&tendons, &Matrix3::zeros()).unwrap();
    assert_eq!(printed, Matrix3::zeros());
    // And with an elastic one it is softer than the softer of the two.
    let shaft = JointStiffness {
        axial_compliance_m_per_n: 1e-6,
        ..joint(5.0, 4.0)
    };
    let r = pointing(40.0, 25.0).rotation();
    let support = printed::support_stiffness(&shaft, &r).unwrap();
    let printed = printed::series_stiffness(&tendons, &support).unwrap();
    let push = Vector3::new(0.6, -0.8, 0.0);
    assert!(push.dot(&(printed * push)) < 5.0);
}

#[test]
fn joints_that_cannot_be_are_refused() {
    use leg_model::{Error, Quantity, Reason};
    let refused = |kind, joint, quantity, reason| {
        assert_eq!(
            Support::new(kind, joint),
            Err(Error::Refused { quantity, reason })
        );
    };
    let (bending, torsion) = (Quantity::JointBending, Quantity::JointTorsion);
    refused(
        SupportKind::Spherical,
        joint(-1.0, 0.0),
        bending,
        Reason::Negative,
    );
    refused(
        SupportKind::Spherical,
        joint(0.0, f64::NAN),
        torsion,
        Reason::NotFinite,
    );
    refused(
        SupportKind::Spherical,
        joint(2e6, 0.0),
        bending,
        Reason::OutOfRange,
    );
    refused(
        SupportKind::Universal,
        joint(0.0, 1.0),
        torsion,
        Reason::Blocked,
    );
    refused(
        SupportKind::ElasticUniversal,
        joint(1.0, 0.0),
        torsion,
        Reason::NotPositive,
    );
}
