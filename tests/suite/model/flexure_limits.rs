//! What flexures bear before they buckle, and materials that cannot be.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use leg_model::{Error, FlexureMaterial, Leaf, Notch, Quantity, Reason, Rod};
use std::f64::consts::PI;

const STEEL: FlexureMaterial<f64> = FlexureMaterial {
    youngs_modulus_pa: 206e9,
    shear_modulus_pa: 80e9,
    strain_max: 0.006,
};

const ROD: Rod<f64> = Rod {
    length_m: 0.02,
    diameter_m: 0.002,
};

#[test]
fn rods_and_leaves_buckle_at_eulers_load() {
    let euler = |second_moment: f64, length_m: f64| {
        PI.powi(2) * STEEL.youngs_modulus_pa * second_moment / length_m.powi(2)
    };
    let leaf = Leaf {
        length_m: 0.02,
        width_m: 0.012,
        thickness_m: 0.0004,
    };
    let rod_off = ROD.critical_n(&STEEL) / euler(PI / 64.0 * 0.002_f64.powi(4), 0.02) - 1.0;
    let leaf_off = leaf.critical_n(&STEEL) / euler(0.012 * 0.0004_f64.powi(3) / 12.0, 0.02) - 1.0;
    assert!(rod_off.abs() < 1e-12 && leaf_off.abs() < 1e-12);
}

/// The least P of (EIφ')' = -Pφ with φ = 0 at both ends, by Stodola's iteration on half of the neck: φ' = 0 in the
/// middle.
fn least_critical_n(notch: &Notch<f64>) -> f64 {
    const CELLS: usize = 4000;
    let &Notch {
        radius_m: r,
        thickness_m: t,
        width_m: b,
    } = notch;
    let h = PI / 2.0 / CELLS as f64;
    let angle = |i: usize| (i as f64 + 0.5) * h;
    let length = |i| r * f64::cos(angle(i)) * h;
    let bends = |i| {
        let thickness = t + 2.0 * r * (1.0 - f64::cos(angle(i)));
        12.0 / (STEEL.youngs_modulus_pa * b * thickness.powi(3))
    };
    let mut slopes = vec![1.0; CELLS];
    let mut critical_n = 0.0;
    for _ in 0..40 {
        // EIφ' by one sum from the middle, φ by another from the end.
        let mut moment = 0.0;
        let mut next = vec![0.0; CELLS];
        for i in 0..CELLS {
            moment += slopes[i] * length(i);
            next[i] = moment * bends(i) * length(i);
        }
        for i in (1..CELLS).rev() {
            next[i - 1] += next[i];
        }
        critical_n = slopes[0] / next[0];
        slopes = next.iter().map(|slope| slope / next[0]).collect();
    }
    critical_n
}

#[test]
fn a_notch_bears_at_least_what_is_reported() {
    for thickness_m in [0.25e-3, 1e-3, 4e-3] {
        let notch = Notch {
            radius_m: 0.005,
            thickness_m,
            width_m: 0.012,
        };
        let sheared = STEEL.shear_modulus_pa * notch.width_m * thickness_m / 1.2;
        let bent = least_critical_n(&notch);
        let exact = bent * sheared / (bent + sheared);
        let part = notch.critical_n(&STEEL) / exact;
        assert!((0.7..1.0).contains(&part), "{thickness_m}: {part}");
    }
}

/// The bound of the page of `critical_n`, 2/∫|z|/EI dz, by a sum over the neck, in series with the shear of its thinnest place.
#[test]
fn a_notch_bears_what_the_mean_of_its_compliance_says() {
    const CELLS: i32 = 4000;
    for thickness_m in [0.25e-3, 1e-3, 4e-3] {
        let (radius_m, width_m) = (0.005, 0.012);
        let notch = Notch {
            radius_m,
            thickness_m,
            width_m,
        };
        let h = radius_m / f64::from(CELLS);
        let half = (0..CELLS).map(|i| {
            let z = (f64::from(i) + 0.5) * h;
            let thickness = thickness_m + 2.0 * (radius_m - (radius_m.powi(2) - z * z).sqrt());
            z * 12.0 / (STEEL.youngs_modulus_pa * width_m * thickness.powi(3)) * h
        });
        let bent = 1.0 / half.sum::<f64>();
        let sheared = STEEL.shear_modulus_pa * width_m * thickness_m / 1.2;
        let off = notch.critical_n(&STEEL) * (1.0 / bent + 1.0 / sheared) - 1.0;
        assert!(off.abs() < 1e-3, "{thickness_m}: {off}");
    }
}

#[test]
fn a_material_that_shears_no_more_easily_than_it_stretches_is_refused() {
    for shear_modulus_pa in [206e9, 300e9] {
        let material = FlexureMaterial {
            shear_modulus_pa,
            ..STEEL
        };
        let refused = Error::Refused {
            quantity: Quantity::ShearModulus,
            reason: Reason::OutOfRange,
        };
        assert_eq!(ROD.pivot(&material, 0.01), Err(refused));
    }
}
