//! Mechanisms that the model refuses, each by the name of the quantity and the reason.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use leg_model::{Error, Quantity, Reason, Rig, RigParameters};

type Parameters = RigParameters<f64, 3>;

/// Puts a value into a rig.
type SetRig = fn(&mut Parameters, f64);

const INFINITE: [f64; 3] = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY];

fn refused(quantity: Quantity, reason: Reason) -> Error {
    Error::Refused { quantity, reason }
}

/// Asserts that `set` makes a rig that is refused, with each of the values.
fn assert_rig(quantity: Quantity, reason: Reason, values: &[f64], set: SetRig) {
    for &value in values {
        let mut parameters = Parameters::TABLE_1;
        set(&mut parameters, value);
        let error = Rig::new(&parameters).unwrap_err();
        assert_eq!(error, refused(quantity, reason), "{value}");
    }
}

#[test]
fn anchors_that_are_not_finite_are_refused() {
    let cases: [(Quantity, SetRig); 4] = [
        (Quantity::BaseAnchors, |p, v| p.base_anchors_m[2][1] = v),
        (Quantity::BaseAnchors, |p, v| p.base_anchors_m[0][0] = v),
        (Quantity::LegAnchors, |p, v| p.leg_anchors_m[1][0] = v),
        (Quantity::LegAnchors, |p, v| p.leg_anchors_m[2][1] = v),
    ];
    for (quantity, set) in cases {
        assert_rig(quantity, Reason::NotFinite, &INFINITE, set);
    }
}

#[test]
fn anchors_on_a_line_or_in_a_point_are_refused() {
    let line = |p: &mut [[f64; 2]; 3], slope: f64| *p = [0.0, 0.01, 0.03].map(|x| [x, slope * x]);
    for slope in [0.0, 0.5, -3.0, 1e3] {
        let (mut base, mut leg) = (Parameters::TABLE_1, Parameters::TABLE_1);
        line(&mut base.base_anchors_m, slope);
        line(&mut leg.leg_anchors_m, slope);
        let error = |p: &Parameters| Rig::new(p).unwrap_err();
        assert_eq!(
            error(&base),
            refused(Quantity::BaseAnchors, Reason::Collinear)
        );
        assert_eq!(
            error(&leg),
            refused(Quantity::LegAnchors, Reason::Collinear)
        );
    }
    let point = |p: &mut Parameters, v| p.base_anchors_m = [[v, v]; 3];
    assert_rig(
        Quantity::BaseAnchors,
        Reason::Collinear,
        &[0.0, 0.01],
        point,
    );
}

#[test]
fn lengths_that_must_be_positive_refuse_zero_and_less() {
    let cases: [(Quantity, SetRig); 2] = [
        (Quantity::JointLength, |p, v| p.joint_length_m = v),
        (Quantity::LegLength, |p, v| p.leg_length_m = v),
    ];
    for (quantity, set) in cases {
        assert_rig(quantity, Reason::NotFinite, &INFINITE, set);
        assert_rig(
            quantity,
            Reason::NotPositive,
            &[0.0, -0.0, -1e-300, -1.0],
            set,
        );
    }
}

#[test]
fn a_rig_that_is_too_large_is_refused() {
    let cases: [(Quantity, f64, SetRig); 8] = [
        (Quantity::BaseAnchors, -101.0, |p, v| {
            p.base_anchors_m[1][0] = v
        }),
        (Quantity::LegAnchors, 101.0, |p, v| {
            p.leg_anchors_m[2][1] = v
        }),
        (Quantity::UpperLength, 101.0, |p, v| p.upper_length_m = v),
        (Quantity::JointLength, 101.0, |p, v| p.joint_length_m = v),
        (Quantity::LegLength, 101.0, |p, v| p.leg_length_m = v),
        (Quantity::LegMass, 1.1e6, |p, v| p.leg_mass_kg = v),
        (Quantity::LegCentroid, 101.0, |p, v| p.leg_centroid_m = v),
        (Quantity::Gravity, 1.1e3, |p, v| p.gravity_m_per_s2 = v),
    ];
    for (quantity, value, set) in cases {
        assert_rig(quantity, Reason::OutOfRange, &[value], set);
    }
}

#[test]
fn quantities_that_may_be_zero_refuse_less() {
    let cases: [(Quantity, SetRig); 4] = [
        (Quantity::UpperLength, |p, v| p.upper_length_m = v),
        (Quantity::LegMass, |p, v| p.leg_mass_kg = v),
        (Quantity::LegCentroid, |p, v| p.leg_centroid_m = v),
        (Quantity::Gravity, |p, v| p.gravity_m_per_s2 = v),
    ];
    for (quantity, set) in cases {
        assert_rig(quantity, Reason::NotFinite, &INFINITE, set);
        assert_rig(quantity, Reason::Negative, &[-1e-300, -1.0], set);
        let mut parameters = Parameters::TABLE_1;
        set(&mut parameters, 0.0);
        assert!(Rig::new(&parameters).is_ok(), "{quantity:?} may be zero");
    }
}
