#![allow(clippy::unwrap_used, reason = "a test may panic")]

use super::{TargetGenerator, Torsion};
use crate::control::CYCLE_S;
use crate::settings::Settings;

/// Whatever it has been asked for, the trim keeps its limit, and comes back from it at once.
#[test]
fn the_trim_ends_at_its_limit() {
    let settings = Settings::table_1().unwrap();
    let max_n = f64::from(settings.estimation.trim_max_n);
    let per_cycle = f64::from(CYCLE_S / settings.estimation.trim_time_s);
    let trimmed_n = |targets: &mut TargetGenerator<f64>, error_n| {
        targets.trim(error_n);
        targets.trim_n
    };
    for sign in [1.0, -1.0] {
        let mut targets = TargetGenerator::<f64>::new(&settings);
        assert!((trimmed_n(&mut targets, sign) - sign * per_cycle).abs() < 1e-12);
        for _ in 0..20_000 {
            assert!(trimmed_n(&mut targets, sign * 10.0).abs() <= max_n);
        }
        assert_eq!(trimmed_n(&mut targets, sign * 10.0), sign * max_n);
        let back_n = trimmed_n(&mut targets, -sign);
        assert!((max_n - back_n.abs() - per_cycle).abs() < 1e-12, "{back_n}");
        targets.start(true);
        assert!((trimmed_n(&mut targets, sign) - sign * per_cycle).abs() < 1e-12);
    }
}

/// On every support, from the softest ball joint on: in steps of 2 mrad, no faster than the leg may twist, and never farther
/// from the balance than such a step.
#[test]
fn the_torsion_goes_where_the_third_axis_is_balanced() {
    for stiffness_nm_per_rad in [0.5, 10.0, 500.0] {
        for balanced_rad in [0.0, 2e-4, -3e-3, 0.05, -0.1] {
            let mut torsion = Torsion::<f64>::new();
            let off = |torsion: &Torsion<f64>| torsion.angle - balanced_rad;
            for _ in 0..200 {
                let before = (off(&torsion), torsion.angle);
                torsion.step(-stiffness_nm_per_rad * before.0);
                assert!((torsion.angle - before.1).abs() <= 2e-3 + 1e-9);
                let nearer = off(&torsion).abs() <= before.0.abs().max(2e-3) + 1e-9;
                assert!(nearer, "{stiffness_nm_per_rad} N·m/rad, {balanced_rad} rad");
            }
            assert!(off(&torsion).abs() < 1e-6, "{} rad", off(&torsion));
        }
    }
}

/// No support is as soft: what looks so is rounding.
#[test]
fn what_is_no_stiffness_against_torsion_turns_nothing() {
    let mut torsion = Torsion::<f64>::new();
    for moment in [5e-6, -5e-6] {
        let before = torsion.angle;
        torsion.step(moment);
        let turned = torsion.angle - before;
        assert!(turned.abs() < 1e-5, "{moment} N·m: {turned} rad");
    }
}
