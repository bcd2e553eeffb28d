#![allow(clippy::unwrap_used, reason = "a test may panic")]

use super::{HeldLeg, Mjcf, MjcfError};
use crate::leg_shape::{Body, ShapeError};
use leg_model::{JointStiffness, Query, Support, SupportKind};
use leg_rig::rig_file::RigFile;

fn rig() -> RigFile {
    RigFile::load(None).unwrap()
}

/// The model with a support whose joint has these stiffnesses.
fn with_springs(kind: SupportKind, bending: f64, torsion: f64) -> Result<Mjcf, MjcfError> {
    let joint = JointStiffness {
        bending_nm_per_rad: bending,
        torsion_nm_per_rad: torsion,
        ..JointStiffness::none()
    };
    let query = Query {
        support: Support::new(kind, joint).unwrap(),
        ..rig().query(30.0, 20.0, 1.0)
    };
    Mjcf::new(&HeldLeg::new(&rig(), &query)?, None)
}

#[test]
fn springs_that_mujoco_has_not_are_refused() {
    let springs = |kind, bending, torsion| {
        matches!(
            with_springs(kind, bending, torsion),
            Err(MjcfError::Springs { .. })
        )
    };
    assert!(springs(SupportKind::TorsionFree, 1.0, 0.0));
    assert!(springs(SupportKind::Spherical, 1.0, 1.0));
    assert!(springs(SupportKind::Spherical, 0.0, 1.0));
    assert!(with_springs(SupportKind::Spherical, 1.0, 0.9).is_ok());
    assert!(with_springs(SupportKind::Spherical, 1.0, 0.0).is_ok());
    assert!(with_springs(SupportKind::ElasticUniversal, 1.0, 5.0).is_ok());
}

#[test]
fn a_leg_without_any_mass_is_refused() {
    let mut rig = rig();
    rig.parameters.leg_mass_kg = 0.0;
    let model = |payload_kg| HeldLeg::new(&rig, &rig.query(0.0, 0.0, payload_kg));
    assert!(matches!(
        model(0.0),
        Err(MjcfError::Shape(ShapeError::Massless))
    ));
    assert!(model(0.5).is_ok());
    // Nothing says then what several of them carry.
    let body = |mass_kg| Body::new(&rig, 6, 0.2, mass_kg);
    assert_eq!(body(None), Err(ShapeError::MasslessBody));
    assert_eq!(body(Some(3.0)).unwrap().mass_kg, 3.0);
}

#[test]
fn a_body_has_the_mass_of_its_legs_unless_it_is_given() {
    let body = |mass_kg| Body::new(&rig(), 6, 0.2, mass_kg).unwrap().mass_kg;
    assert_eq!(body(None), 6.0 * rig().parameters.leg_mass_kg);
    assert_eq!(body(Some(3.0)), 3.0);
}

#[test]
fn a_pretension_that_the_tendons_cannot_hold_is_refused_with_the_range() {
    let leg = |pretension_n, payload_kg| {
        let query = Query {
            pretension_n,
            ..rig().query(30.0, 30.0, payload_kg)
        };
        HeldLeg::new(&rig(), &query)
    };
    let Err(MjcfError::Pretension {
        lowest_n,
        highest_n,
        ..
    }) = leg(45.0, 2.0)
    else {
        panic!("a pretension of 45 N should be refused");
    };
    assert!(leg(lowest_n, 2.0).is_ok() && leg(highest_n, 2.0).is_ok());
    assert!(matches!(
        leg(70.0, 20.0),
        Err(MjcfError::Infeasible | MjcfError::Model(_))
    ));
}

#[test]
fn an_unstretched_tendon_is_shorter_by_its_tension_over_its_stiffness() {
    let leg = HeldLeg::new(&rig(), &rig().query(0.0, 0.0, 1.0)).unwrap();
    for tendon in leg.tendons {
        // Straight down no weight turns the leg: each tendon has the tension of the pretension, 70 N, and 35 mm.
        assert!((tendon.stiffness_n_per_m - 99_450.0).abs() < 1e-6);
        assert!((0.035 - tendon.unstretched_m - 70.0 / 99_450.0).abs() < 1e-12);
    }
}

#[test]
fn an_inertia_that_no_body_has_is_refused_with_the_lowest() {
    let leg = |transverse_kg_m2| {
        let mut rig = rig();
        rig.plant.leg_transverse_inertia_kg_m2 = Some(transverse_kg_m2);
        HeldLeg::new(&rig, &rig.query(0.0, 0.0, 1.0))
    };
    let Err(MjcfError::Shape(ShapeError::Inertia { lowest_kg_m2, .. })) = leg(1e-3) else {
        panic!("1e-3 kg·m² is less than the leg's mass at its centroid has");
    };
    assert!(leg(lowest_kg_m2).is_ok() && leg(0.999 * lowest_kg_m2).is_err());
}
