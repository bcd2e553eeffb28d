//! Flexure formulas against integrals along the flexure and against the limits of textbooks.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use leg_model::{Error, FlexureMaterial, JointStiffness, Leaf, Notch, Quantity, Reason, Rod};
use std::f64::consts::PI;

const TILT: f64 = PI / 6.0;
const SPACING_M: f64 = 0.014;

const MATERIAL: FlexureMaterial<f64> = FlexureMaterial {
    youngs_modulus_pa: 60e9,
    shear_modulus_pa: 23e9,
    strain_max: 0.06,
};

/// Simpson's rule.
fn integral(f: impl Fn(f64) -> f64, from: f64, to: f64) -> f64 {
    const HALVES: i32 = 20_000;
    let h = (to - from) / f64::from(2 * HALVES);
    let weighted = (0..=2 * HALVES).map(|i| {
        let weight = match i {
            0 => 1.0,
            _ if i == 2 * HALVES => 1.0,
            _ if i % 2 == 1 => 4.0,
            _ => 2.0,
        };
        weight * f(from + h * f64::from(i))
    });
    weighted.sum::<f64>() * h / 3.0
}

/// Two pairs of flexures in series, of which each bends by `bends`, twists by `twists`, shifts by `shifts` and
/// stretches by `stretches` under a unit load, by energies: each pair is two in parallel.
fn universal(bends: f64, twists: f64, shifts: f64, stretches: f64) -> JointStiffness<f64> {
    let arm = SPACING_M / 2.0;
    let pair_torsion = 2.0 / twists + 2.0 * arm * arm / shifts;
    JointStiffness {
        bending_nm_per_rad: 2.0 / bends,
        torsion_nm_per_rad: 1.0 / (2.0 / pair_torsion),
        axial_compliance_m_per_n: 2.0 * (stretches / 2.0),
    }
}

fn assert_near(found: &JointStiffness<f64>, expected: &JointStiffness<f64>, bound: f64) {
    let pairs = [
        (found.bending_nm_per_rad, expected.bending_nm_per_rad),
        (found.torsion_nm_per_rad, expected.torsion_nm_per_rad),
        (
            found.axial_compliance_m_per_n,
            expected.axial_compliance_m_per_n,
        ),
    ];
    for (found, expected) in pairs {
        assert!((found / expected - 1.0).abs() < bound, "{found} {expected}");
    }
}

/// Torsion constant of a rectangle, Saint-Venant's series.
fn torsion_constant(one: f64, other: f64) -> f64 {
    let (w, t) = (one.max(other), one.min(other));
    let series: f64 = (0..50)
        .map(|k| f64::from(2 * k + 1))
        .map(|n| (n * PI * w / (2.0 * t)).tanh() / n.powi(5))
        .sum();
    w * t.powi(3) / 3.0 * (1.0 - 192.0 * t / (PI.powi(5) * w) * series)
}

fn notch(thickness_m: f64) -> Notch<f64> {
    Notch {
        radius_m: 0.005,
        thickness_m,
        width_m: 0.012,
    }
}

#[test]
fn a_notch_is_the_integral_over_its_neck() {
    let (e, g) = (MATERIAL.youngs_modulus_pa, MATERIAL.shear_modulus_pa);
    for thickness_m in [0.25e-3, 0.5e-3, 2e-3, 4e-3] {
        let Notch {
            radius_m: r,
            width_m: b,
            ..
        } = notch(thickness_m);
        let thickness = |z: f64| thickness_m + 2.0 * r - 2.0 * (r * r - z * z).max(0.0).sqrt();
        // The root is steep at the ends of the neck: z = r sin u is not.
        let along = |f: &dyn Fn(f64) -> f64| {
            integral(|u: f64| f(r * u.sin()) * r * u.cos(), -PI / 2.0, PI / 2.0)
        };
        let bends = along(&|z| 12.0 / (e * b * thickness(z).powi(3)));
        let twists = along(&|z| 1.0 / (g * torsion_constant(b, thickness(z))));
        let shifts = along(&|z| 12.0 * z * z / (e * b * thickness(z).powi(3)))
            + along(&|z| 1.2 / (g * b * thickness(z)));
        let stretches = along(&|z| 1.0 / (e * b * thickness(z)));
        let material = FlexureMaterial {
            strain_max: 1.0,
            ..MATERIAL
        };
        let found = notch(thickness_m)
            .universal(SPACING_M, &material, TILT)
            .unwrap();
        let expected = universal(bends, twists, shifts, stretches);
        let twisted = JointStiffness {
            torsion_nm_per_rad: expected.torsion_nm_per_rad,
            ..found
        };
        assert_near(&twisted, &expected, 1e-6);
        assert_near(&found, &expected, 1e-2);
    }
}

/// As narrow as they are accepted, and so near each other that the bending sideways adds next to nothing.
#[test]
fn narrow_notches_twist_section_by_section() {
    let g = MATERIAL.shear_modulus_pa;
    let material = FlexureMaterial {
        strain_max: 1.0,
        ..MATERIAL
    };
    for (thickness_m, by_thickness) in [(0.25e-3, 3.0), (1e-3, 3.0), (4e-3, 3.0), (1e-3, 6.0)] {
        let narrow = Notch {
            width_m: by_thickness * thickness_m,
            ..notch(thickness_m)
        };
        let r = narrow.radius_m;
        let per_angle = |u: f64| {
            let thickness = thickness_m + 2.0 * r * (1.0 - u.cos());
            r * u.cos() / (g * torsion_constant(narrow.width_m, thickness))
        };
        let twists = integral(per_angle, -PI / 2.0, PI / 2.0);
        let found = narrow.universal(1e-9, &material, TILT).unwrap();
        let ratio = found.torsion_nm_per_rad * twists;
        assert!((ratio - 1.0).abs() < 0.012, "{thickness_m}: {ratio}");
    }
}

/// The short formula that Paros and Weisbord give for a thin neck, 2Ebt^2.5/(9π√r).
#[test]
fn a_thin_notch_bends_by_the_short_formula() {
    let thin = notch(0.25e-3);
    let found = thin.universal(SPACING_M, &MATERIAL, TILT).unwrap();
    let short = 2.0 * MATERIAL.youngs_modulus_pa * thin.width_m * thin.thickness_m.powf(2.5)
        / (9.0 * PI * thin.radius_m.sqrt());
    let ratio = found.bending_nm_per_rad / (2.0 * short);
    assert!((0.9..1.1).contains(&ratio), "{ratio}");
}

#[test]
fn rods_and_leaves_are_the_textbooks() {
    let (e, g) = (MATERIAL.youngs_modulus_pa, MATERIAL.shear_modulus_pa);
    let rod = Rod {
        length_m: 0.02,
        diameter_m: 0.002,
    };
    let area = PI * 1e-6;
    let i = integral(
        |y| 2.0 * y * y * (1e-6 - y * y).max(0.0).sqrt(),
        -1e-3,
        1e-3,
    );
    let pivot = rod.pivot(&MATERIAL, TILT).unwrap();
    let expected = JointStiffness {
        bending_nm_per_rad: e * i / 0.02,
        torsion_nm_per_rad: g * 2.0 * i / 0.02,
        axial_compliance_m_per_n: 0.02 / (e * area),
    };
    assert_near(&pivot, &expected, 1e-6);
    // Half of what Eq. (19) divides by.
    let printed = e * i / (2.0 * 0.02);
    assert!((pivot.bending_nm_per_rad / printed - 2.0).abs() < 1e-5);
    let shifts = 0.02_f64.powi(3) / (12.0 * e * i);
    let expected = universal(
        0.02 / (e * i),
        0.02 / (g * 2.0 * i),
        shifts,
        0.02 / (e * area),
    );
    assert_near(
        &rod.universal(SPACING_M, &MATERIAL, TILT).unwrap(),
        &expected,
        1e-6,
    );

    let leaf = Leaf {
        length_m: 0.015,
        width_m: 0.008,
        thickness_m: 0.0002,
    };
    let i = 0.008 * 0.0002_f64.powi(3) / 12.0;
    let (w, t) = (0.008, 0.0002);
    let j = torsion_constant(w, t);
    let shifts = 0.015_f64.powi(3) / (12.0 * e * i);
    let expected = universal(
        0.015 / (e * i),
        0.015 / (g * j),
        shifts,
        0.015 / (e * w * t),
    );
    assert_near(
        &leaf.universal(SPACING_M, &MATERIAL, TILT).unwrap(),
        &expected,
        1e-3,
    );
}

fn refused(found: Result<JointStiffness<f64>, Error>, quantity: Quantity, reason: Reason) {
    assert_eq!(found, Err(Error::Refused { quantity, reason }));
}

#[test]
fn flexures_outside_their_formulas_are_refused() {
    let universal = |notch: Notch<f64>| notch.universal(SPACING_M, &MATERIAL, TILT);
    let thickness = Quantity::FlexureThickness;
    refused(universal(notch(0.24e-3)), thickness, Reason::OutsideFormula);
    refused(universal(notch(4.01e-3)), thickness, Reason::OutsideFormula);
    refused(
        universal(notch(0.5e-3)),
        Quantity::StrainLimit,
        Reason::Exceeded,
    );
    refused(universal(notch(-1.0)), thickness, Reason::NotPositive);
    let narrow = Notch {
        width_m: 0.7e-3,
        ..notch(0.25e-3)
    };
    refused(
        universal(narrow),
        Quantity::FlexureWidth,
        Reason::NotSlender,
    );
    let stout = Rod {
        length_m: 0.009,
        diameter_m: 0.002,
    };
    refused(
        stout.pivot(&MATERIAL, TILT),
        Quantity::FlexureLength,
        Reason::NotSlender,
    );
    let thick = Rod {
        length_m: 0.02,
        diameter_m: 0.004,
    };
    let brittle = FlexureMaterial {
        strain_max: 0.02,
        ..MATERIAL
    };
    refused(
        thick.pivot(&brittle, TILT),
        Quantity::StrainLimit,
        Reason::Exceeded,
    );
    let square = Leaf {
        length_m: 0.02,
        width_m: 0.5e-3,
        thickness_m: 0.2e-3,
    };
    refused(
        square.universal(SPACING_M, &MATERIAL, TILT),
        Quantity::FlexureWidth,
        Reason::NotSlender,
    );
    // It is bent to the radius L/θ, and as far as half of its thickness from the middle.
    let length_m = |strain: f64| 0.5 * 0.2e-3 * TILT / strain;
    let bent = |strain| {
        let leaf = Leaf {
            length_m: length_m(strain),
            width_m: 5e-3,
            ..square
        };
        leaf.universal(SPACING_M, &brittle, TILT)
    };
    assert!(bent(0.99 * brittle.strain_max).is_ok());
    refused(
        bent(1.01 * brittle.strain_max),
        Quantity::StrainLimit,
        Reason::Exceeded,
    );
    let no_spacing = Rod {
        length_m: 0.02,
        diameter_m: 0.002,
    }
    .universal(0.0, &MATERIAL, TILT);
    refused(no_spacing, Quantity::FlexureSpacing, Reason::NotPositive);
    let soft = FlexureMaterial {
        youngs_modulus_pa: 0.0,
        ..MATERIAL
    };
    refused(
        notch(0.3e-3).universal(SPACING_M, &soft, TILT),
        Quantity::YoungsModulus,
        Reason::NotPositive,
    );
}
