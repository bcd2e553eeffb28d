//! Tendons with a curve: which points make one, and what it says between and beside them.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use leg_model::{CURVE_POINTS_MAX, CurvePoint, Elasticity, Error, Quantity, Reason, Tendon};

fn point(tension_n: f64, elongation_m: f64, stiffness_n_per_m: f64) -> CurvePoint<f64> {
    CurvePoint {
        tension_n,
        elongation_m,
        stiffness_n_per_m,
    }
}

/// The slack tendon.
fn slack() -> CurvePoint<f64> {
    point(0.0, 0.0, 1e5)
}

#[test]
fn points_that_make_no_curve_are_refused_by_name() {
    let many: Vec<_> = (0..=CURVE_POINTS_MAX)
        .map(|i| point(10.0 * i as f64, 1e-4 * i as f64, 1e5))
        .collect();
    let taut = point(100.0, 1e-3, 1e5);
    for (points, reason) in [
        (&[][..], Reason::TooFew),
        (&[slack()], Reason::TooFew),
        (&many, Reason::TooMany),
        (&[point(1.0, 0.0, 1e5), taut], Reason::NotFromZero),
        (&[point(0.0, 1e-5, 1e5), taut], Reason::NotFromZero),
        (&[slack(), point(0.0, 1e-3, 1e5)], Reason::NotRising),
        (&[slack(), point(100.0, 0.0, 1e5)], Reason::NotRising),
        (&[slack(), taut, point(90.0, 2e-3, 1e5)], Reason::NotRising),
        (&[point(0.0, 0.0, 3e4), taut], Reason::NotMonotone),
        (&[slack(), point(100.0, 1e-3, 3e4)], Reason::NotMonotone),
    ] {
        let refused = Err(Error::Refused {
            quantity: Quantity::TendonCurve,
            reason,
        });
        assert_eq!(Tendon::curve(points), refused, "{points:?}");
    }
    assert!(Tendon::curve(&many[..CURVE_POINTS_MAX]).is_ok());
}

/// Below zero the law goes on in the straight line of the slack tendon.
#[test]
fn below_zero_a_curve_goes_on_in_a_straight_line() {
    let curve = Tendon::curve(&CurvePoint::<f64>::PAPER).unwrap();
    let slack = curve.stiffness(0.0).unwrap();
    for tension_n in [-1e-3, -1.0, -70.0, -1e3] {
        let elongation = curve.elongation(tension_n).unwrap();
        assert!((elongation - tension_n / slack).abs() <= 1e-15 * tension_n.abs());
        assert_eq!(curve.stiffness(tension_n), Ok(slack));
    }
}

/// Two tendons one after the other are one of twice the length, two beside each other one of twice the section.
#[test]
fn a_tendon_of_another_length_or_section_is_several_of_the_first() {
    let curve = |length_ratio, section_ratio| {
        let scale = |point: CurvePoint<f64>| point.scaled(length_ratio, section_ratio);
        Tendon::curve(&CurvePoint::<f64>::PAPER.map(scale)).unwrap()
    };
    let (one, long, thick) = (curve(1.0, 1.0), curve(2.0, 1.0), curve(1.0, 2.0));
    for tension_n in [0.0, 3.0, 30.0, 70.0] {
        let elongation = one.elongation(tension_n).unwrap();
        let stiffness = one.stiffness(tension_n).unwrap();
        for (other, ratio) in [(&long, 2.0), (&thick, 0.5)] {
            assert_eq!(other.elongation(tension_n), Ok(ratio * elongation));
            assert_eq!(other.stiffness(tension_n), Ok(stiffness / ratio));
        }
    }
}

/// Also where the curve is as steep at both ends, and as flat between them, as one may be: Newton's steps alone would not come
/// to an end there.
#[test]
fn the_tension_at_an_elongation_is_the_one_that_stretches_so_far() {
    let steep = [
        point(0.0, 0.0, 1e5 / 2.99),
        point(100.0, 1e-3, 1e5 / 2.99),
        point(200.0, 2e-3, 1e6),
    ];
    for points in [&CurvePoint::<f64>::PAPER[..], &steep] {
        let curve = Tendon::curve(points).unwrap();
        let highest_n = points.last().unwrap().tension_n;
        for part in 0..1000 {
            let tension_n = highest_n * f64::from(part) / 1000.0;
            let elongation = curve.elongation(tension_n).unwrap();
            let found_n = curve.tension(elongation).unwrap();
            let back = curve.elongation(found_n).unwrap();
            assert!(
                (back - elongation).abs() < 1e-15,
                "{found_n} N for {tension_n} N"
            );
        }
    }
}

/// A tendon that is scaled is the one whose points were.
#[test]
fn a_scaled_tendon_is_that_of_scaled_points() {
    for factor in [0.8, 1.0, 1.25] {
        let points = CurvePoint::<f64>::PAPER.map(|point| point.scaled(factor, 1.0));
        let expected = Tendon::curve(&points).unwrap();
        let mut scaled = Tendon::curve(&CurvePoint::<f64>::PAPER).unwrap();
        scaled.scale(factor);
        let mut constant = Tendon::constant(1e5).unwrap();
        constant.scale(factor);
        for tension in [0.0, 0.3, 7.0, 69.0, 70.0, 71.0, 149.0] {
            let same = |a: f64, b: f64| (a - b).abs() <= 1e-14 * a.abs().max(1e-9);
            let elongation = scaled.elongation(tension).unwrap();
            assert!(same(elongation, expected.elongation(tension).unwrap()));
            let stiffness = [&scaled, &expected].map(|one| one.stiffness(tension).unwrap());
            assert!(same(stiffness[0], stiffness[1]), "{stiffness:?}");
            let energy = [&scaled, &expected].map(|one| one.energy(elongation).unwrap());
            assert!(same(energy[0], energy[1]), "{energy:?}");
            assert!((scaled.tension(elongation).unwrap() - tension).abs() < 1e-6);
            let length = constant.elongation(tension).unwrap();
            assert!(same(length, factor * tension / 1e5));
        }
        assert!(scaled.elongation(1e3).is_err() && scaled.tension(1.0).is_err());
    }
}
