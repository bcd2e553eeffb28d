//! Stiffness against tilts and solutions of small systems, against plain matrices.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use crate::common::reference::poses;
use leg_model::{Bending, BendingAxis, Direction, Error, FreePlane, Symmetric3, solve2, solve3};
use nalgebra::{Matrix2, Matrix3, Matrix3x2, SymmetricEigen, Vector3};

/// Stiffnesses of which none is diagonal.
fn stiffnesses() -> impl Iterator<Item = Matrix3<f64>> {
    let mut rng = fastrand::Rng::with_seed(3);
    (0..5).map(move |_| {
        let root = Matrix3::from_fn(|_, _| 10.0 * rng.f64() - 5.0);
        root * root.transpose() + Matrix3::identity()
    })
}

/// Two orthonormal axes that a push at the tip turns the leg about: across it.
fn transverse_axes(direction: &Direction<f64>) -> Matrix3x2<f64> {
    let p = direction.vector();
    let first = p.cross(&Vector3::x()).normalize();
    Matrix3x2::from_columns(&[first, p.cross(&first)])
}

/// Asserts both ends of the range and the stiffness against a push towards some azimuths, of a compliance across the leg.
fn assert_bending(
    bending: &Bending<f64>,
    compliance: &Matrix3<f64>,
    basis: &Matrix3x2<f64>,
    p: &Vector3<f64>,
) {
    let within: Matrix2<f64> = basis.transpose() * compliance * basis;
    let values = SymmetricEigen::new(within).eigenvalues;
    let [softest, stiffest] = bending.extremes().unwrap();
    assert!((softest * values.max() - 1.0).abs() < 1e-9);
    assert!((stiffest * values.min() - 1.0).abs() < 1e-9);
    let mean = (0.5 * values.map(|value| value * value).sum()).sqrt();
    let found = bending.compliant_mean();
    assert!((found * mean - 1.0).abs() < 1e-9);
    for azimuth_deg in (0..360).step_by(50) {
        let (sin, cos) = f64::from(azimuth_deg).to_radians().sin_cos();
        let axis = p.cross(&Vector3::new(cos, sin, 0.0)).normalize();
        let expected = 1.0 / axis.dot(&(compliance * axis));
        let found = bending
            .stiffness_about(&BendingAxis::Towards([cos, sin]))
            .unwrap();
        assert!((found / expected - 1.0).abs() < 1e-9, "{azimuth_deg}°");
    }
}

/// On a ball joint the leg twists until its twist carries no moment: the whole compliance counts.
#[test]
fn a_leg_that_may_twist_resists_a_push_by_its_whole_compliance() {
    for (azimuth, tilt) in poses(60, 12) {
        let direction = Direction::from_angles(azimuth, tilt).unwrap();
        for k in stiffnesses() {
            let bending = Bending::twisting(&Symmetric3::symmetric_part(&k), &direction).unwrap();
            let compliance = k.try_inverse().unwrap();
            assert_bending(
                &bending,
                &compliance,
                &transverse_axes(&direction),
                &direction.vector(),
            );
        }
    }
}

/// On a joint with two freedoms it turns within their plane alone. There the ends of the range are those of the plane.
#[test]
fn a_guided_leg_resists_a_push_by_the_compliance_of_its_plane() {
    for (azimuth, tilt) in poses(60, 12) {
        let direction = Direction::from_angles(azimuth, tilt).unwrap();
        let planes = [
            FreePlane::torsion_free(&direction),
            FreePlane::universal(&direction),
        ];
        for (plane, k) in planes
            .iter()
            .flat_map(|p| stiffnesses().map(move |k| (p, k)))
        {
            let bending = Bending::guided(&Symmetric3::symmetric_part(&k), &direction, plane);
            let columns = [[1.0, 0.0], [0.0, 1.0]].map(|xy| plane.rotation(xy));
            let basis = Matrix3x2::from_columns(&columns).qr().q();
            let free = (basis.transpose() * k * basis).try_inverse().unwrap();
            let compliance = basis * free * basis.transpose();
            assert_bending(&bending, &compliance, &basis, &direction.vector());
        }
    }
}

/// Whichever of its minors shows it.
#[test]
fn what_is_not_positive_definite_is_unstable() {
    for rows in [
        [[-1.0, 0.0], [0.0, -1.0]],
        [[-1.0, 0.0], [0.0, 1.0]],
        [[1.0, 0.0], [0.0, -1.0]],
        [[1.0, 2.0], [2.0, 1.0]],
        [[1.0, 0.0], [0.0, 0.0]],
        [[0.0, 0.0], [0.0, 1.0]],
        [[f64::NAN, 0.0], [0.0, 1.0]],
    ] {
        assert_eq!(solve2(rows, [1.0, 1.0]), Err(Error::Unstable), "{rows:?}");
        let [[xx, xy], [_, yy]] = rows;
        let k = Matrix3::new(xx, xy, 0.0, xy, yy, 0.0, 0.0, 0.0, 1.0);
        let symmetric = Symmetric3::symmetric_part(&k);
        let down = Direction::straight_down();
        let plane = FreePlane::torsion_free(&down);
        let horizontal = Vector3::new(1.0, 1.0, 0.0);
        assert_eq!(solve3(&k, &horizontal), Err(Error::Unstable));
        assert_eq!(plane.solve(&k, &horizontal), Err(Error::Unstable));
        assert_eq!(symmetric.solve_horizontal([1.0, 1.0]), Err(Error::Unstable));
        assert_eq!(
            plane.solve_horizontal(&symmetric, [1.0, 1.0]),
            Err(Error::Unstable)
        );
        let bending = Bending::guided(&symmetric, &down, &plane);
        for axis in [BendingAxis::Softest, BendingAxis::Towards([0.8, 0.6])] {
            let found = bending.stiffness_about(&axis);
            assert_eq!(found, Err(Error::Unstable), "{rows:?}, {axis:?}");
        }
    }
    let loose = Symmetric3::symmetric_part(&Matrix3::from_diagonal(&Vector3::new(1.0, 1.0, 0.0)));
    assert_eq!(loose.solve_horizontal([1.0, 0.0]), Err(Error::Unstable));
    assert_eq!(
        Bending::twisting(&loose, &Direction::straight_down()),
        Err(Error::Unstable)
    );
}
