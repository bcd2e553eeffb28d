//! Queries and states that the model refuses, each by the name of the quantity and the reason.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use crate::common::constant_tendons;
use leg_model::{
    Direction, Error, Load, MapEvaluation, Quantity, Query, Reason, Rig, RigParameters,
    StiffnessAt, SupportKind, Tendon, TendonStates, TensionBounds, evaluate, evaluate_for_map,
    full_pass,
};
use nalgebra::Vector3;

const TABLE_1: RigParameters<f64, 3> = RigParameters::<f64, 3>::TABLE_1;

/// Puts a value into a query.
type SetQuery = fn(&mut Query<f64>, f64);

const INFINITE: [f64; 3] = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY];

fn refused(quantity: Quantity, reason: Reason) -> Error {
    Error::Refused { quantity, reason }
}

fn query(support: SupportKind) -> Query<f64> {
    Query {
        azimuth_rad: 0.5,
        tilt_rad: 0.5,
        payload_kg: 1.0,
        pretension_n: 70.0,
        f_min_n: 8.0,
        f_max_n: 150.0,
        tendons: constant_tendons(1e5).unwrap(),
        stiffness_at: StiffnessAt::Pretension,
        support: support.into(),
        demand: None,
    }
}

/// Asserts that `set` makes a query that is refused, with each of the values and whatever the support.
fn assert_query(quantity: Quantity, reason: Reason, values: &[f64], set: SetQuery) {
    let supports = [
        SupportKind::TorsionFree,
        SupportKind::Universal,
        SupportKind::Spherical,
    ];
    for (support, &value) in supports
        .into_iter()
        .flat_map(|s| values.iter().map(move |v| (s, v)))
    {
        let mut query = query(support);
        set(&mut query, value);
        let error = evaluate(&TABLE_1, &query).unwrap_err();
        assert_eq!(error, refused(quantity, reason), "{value}");
    }
}

#[test]
fn a_query_with_a_number_that_is_not_finite_is_refused() {
    let cases: [(Quantity, SetQuery); 6] = [
        (Quantity::Azimuth, |q, v| q.azimuth_rad = v),
        (Quantity::Tilt, |q, v| q.tilt_rad = v),
        (Quantity::Payload, |q, v| q.payload_kg = v),
        (Quantity::Pretension, |q, v| q.pretension_n = v),
        (Quantity::TensionMin, |q, v| q.f_min_n = v),
        (Quantity::TensionMax, |q, v| q.f_max_n = v),
    ];
    for (quantity, set) in cases {
        assert_query(quantity, Reason::NotFinite, &INFINITE, set);
    }
}

#[test]
fn a_query_beyond_the_model_s_range_is_refused() {
    let tilt = 60_f64.to_radians() + 1e-9;
    assert_query(
        Quantity::Tilt,
        Reason::OutOfRange,
        &[tilt, -tilt],
        |q, v| q.tilt_rad = v,
    );
    let cases: [(Quantity, &[f64], SetQuery); 5] = [
        (Quantity::Azimuth, &[63.0, -63.0], |q, v| q.azimuth_rad = v),
        (Quantity::Payload, &[1.1e6], |q, v| q.payload_kg = v),
        (Quantity::Pretension, &[1.1e7, -1.1e7], |q, v| {
            q.pretension_n = v
        }),
        (Quantity::TensionMin, &[1.1e7], |q, v| q.f_min_n = v),
        (Quantity::TensionMax, &[1.1e7], |q, v| q.f_max_n = v),
    ];
    for (quantity, values, set) in cases {
        assert_query(quantity, Reason::OutOfRange, values, set);
    }
}

#[test]
fn a_query_with_a_wrong_sign_or_order_is_refused() {
    type Case = (Quantity, Reason, &'static [f64], SetQuery);
    let cases: [Case; 3] = [
        (Quantity::Payload, Reason::Negative, &[-0.1], |q, v| {
            q.payload_kg = v
        }),
        (Quantity::TensionMin, Reason::Negative, &[-1.0], |q, v| {
            q.f_min_n = v
        }),
        (Quantity::TensionMin, Reason::AboveMax, &[150.1], |q, v| {
            q.f_min_n = v
        }),
    ];
    for (quantity, reason, values, set) in cases {
        assert_query(quantity, reason, values, set);
    }
}

#[test]
fn a_stiffness_that_no_tendon_has_is_refused() {
    let cases = [
        (Reason::NotFinite, &INFINITE[..]),
        (Reason::OutOfRange, &[9e-3, 1.1e10]),
        (Reason::NotPositive, &[0.0, -1.0]),
    ];
    for (reason, values) in cases {
        for &value in values {
            let error = Tendon::constant(value).unwrap_err();
            assert_eq!(error, refused(Quantity::TendonStiffness, reason), "{value}");
        }
    }
}

#[test]
fn states_of_tendons_that_cannot_be_are_refused() {
    let error = |tension: f64, stiffness: f64| {
        let (mut tensions, mut stiffnesses) = (Vector3::repeat(70.0), Vector3::repeat(1e5));
        (tensions[1], stiffnesses[2]) = (tension, stiffness);
        TendonStates::new(tensions, stiffnesses).unwrap_err()
    };
    for tension in INFINITE {
        assert_eq!(
            error(tension, 1e5),
            refused(Quantity::Tension, Reason::NotFinite)
        );
    }
    for tension in [1.1e7, -1.1e7] {
        assert_eq!(
            error(tension, 1e5),
            refused(Quantity::Tension, Reason::OutOfRange)
        );
    }
    assert_eq!(
        error(70.0, f64::NAN),
        refused(Quantity::TendonStiffness, Reason::NotFinite)
    );
    assert_eq!(
        error(70.0, 0.0),
        refused(Quantity::TendonStiffness, Reason::NotPositive)
    );
}

#[test]
fn the_ends_of_the_ranges_are_served() {
    let edge = 60_f64.to_radians();
    for tilt in [edge, -edge] {
        assert!(Direction::from_angles(0.0, tilt).is_ok());
    }
    assert!(Direction::from_angles(-20.0 * std::f64::consts::PI, 0.1).is_ok());
    assert!(TensionBounds::new(10.0, 10.0).is_ok());
    assert!(TensionBounds::new(0.0, 0.0).is_ok());
    assert!(Tendon::constant(1e-2_f64).is_ok() && Tendon::constant(1e10_f64).is_ok());
}

#[test]
fn a_direction_that_does_not_point_below_the_horizon_is_refused() {
    let out_of_range = Err(refused(Quantity::Direction, Reason::OutOfRange));
    for (x, y) in [
        (1.0, 0.0),
        (0.8, -0.7),
        (f64::NAN, 0.0),
        (0.0, f64::INFINITY),
    ] {
        assert_eq!(Direction::from_xy(x, y), out_of_range, "{x}, {y}");
    }
}

/// The lower anchor comes to the height of the joint as the leg leans, and there is the upper one.
#[test]
fn a_tendon_whose_ends_meet_is_named_as_collapsed() {
    let lean = 30_f64.to_radians();
    let mut parameters = TABLE_1;
    let [s, _] = parameters.leg_anchors_m[0];
    parameters.joint_length_m = s * lean.tan();
    parameters.upper_length_m = 0.0;
    parameters.base_anchors_m[0] = [s / lean.cos(), 0.0];
    let query = Query {
        azimuth_rad: 0.0,
        tilt_rad: lean,
        ..query(SupportKind::TorsionFree)
    };
    let evaluated = evaluate(&parameters, &query);
    assert_eq!(evaluated, Err(Error::TendonCollapsed));
    // Also where nothing but the stiffness shows it.
    let rig = Rig::new(&parameters).unwrap();
    let direction = Direction::from_angles(0.0, lean).unwrap();
    let load = Load::new(&rig, 1.0).unwrap();
    let states = TendonStates::new(Vector3::repeat(70.0), Vector3::repeat(1e5)).unwrap();
    let deflection = full_pass(&rig, &direction, &load, &states).deflection;
    assert_eq!(deflection.map(|_| ()), Err(Error::TendonCollapsed));
}

/// To the last bit, so that a map and the pose that it shows say the same.
#[test]
fn a_map_shows_what_the_evaluation_of_a_pose_says() {
    let rig = Rig::new(&TABLE_1).unwrap();
    for kind in [
        SupportKind::TorsionFree,
        SupportKind::Universal,
        SupportKind::Spherical,
    ] {
        let query = query(kind);
        let evaluated = evaluate(&TABLE_1, &query).unwrap();
        let mapped = evaluate_for_map(&rig, &query).unwrap();
        let shown = MapEvaluation {
            pretension_range_n: evaluated.pretension_range_n,
            tensions_n: Ok(evaluated.tensions_n),
            deviation_m: Ok(evaluated.deviation_m),
            bending_stiffness_nm_per_rad: Ok(evaluated.bending_stiffness_nm_per_rad),
        };
        assert_eq!(mapped, shown, "{kind:?}");
    }
}

/// The range of pretensions is that of the middle of the bounds where nothing holds the leg's twist at the asked one.
#[test]
fn a_map_knows_the_range_of_a_pose_that_the_pretension_does_not_hold() {
    let loose = Query {
        tilt_rad: 0.0,
        pretension_n: 0.0,
        ..query(SupportKind::Spherical)
    };
    let rig = Rig::new(&TABLE_1).unwrap();
    let mapped = evaluate_for_map(&rig, &loose).unwrap();
    assert_eq!(mapped.tensions_n, Err(Error::Unstable));
    let middle = Query {
        pretension_n: 0.5 * (loose.f_min_n + loose.f_max_n),
        ..loose
    };
    let held = evaluate(&TABLE_1, &middle).unwrap();
    assert_eq!(mapped.pretension_range_n, held.pretension_range_n);
}
