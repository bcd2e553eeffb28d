#![allow(clippy::unwrap_used, reason = "a test may panic")]

use super::{TargetDemand, TargetGenerator, Torsion};
use crate::control::inertia::Turn;
use crate::control::{CYCLE_S, LoadEstimate, Mechanism};
use crate::settings::Settings;
use leg_model::Direction;
use nalgebra::Vector3;

/// The tensions of a target at a tilt of 30° with a payload, and an angular acceleration about y, 1/s²; none where there is no target.
fn tensions_n(may: bool, payload_kg: f64, acceleration: f64) -> Option<[f64; 3]> {
    let settings = Settings::table_1().unwrap();
    let mechanism = Mechanism::<f64>::new(&settings).unwrap();
    let mut targets = TargetGenerator::<f64>::new(&settings);
    targets.start(true);
    targets.start_at(70.0);
    targets.take_last_newtons(may);
    let turn = Turn {
        acceleration: Vector3::new(0.0, acceleration, 0.0),
        ..Turn::none()
    };
    let demand = TargetDemand {
        q: Direction::from_xy(0.5, 0.0).unwrap().half_tangent(),
        turn: &turn,
        payload_kg,
        load: LoadEstimate {
            payload_kg,
            push_nm: [0.0; 2],
        },
        compensated: true,
        trimmed: false,
        pretension_n: 70.0,
    };
    let target = targets.next(&mechanism, &demand, &[70.0; 3]);
    target.ok().map(|target| target.tensions_n)
}

fn highest(tensions_n: [f64; 3]) -> f64 {
    tensions_n.into_iter().fold(0.0, f64::max)
}

/// A payload that grows takes the last newtons of a leg that may take them, three quarters at the most, and none of another. No tendon lacks any.
#[test]
fn the_last_newtons_are_taken_where_they_may_be() {
    let settings = Settings::table_1().unwrap();
    let [f_min_n, f_max_n] = [settings.f_min_n, settings.f_max_n].map(f64::from);
    let slowed_n = f64::from(settings.servos[0].f_max_band_n);
    for (may, most_n) in [
        (false, f_max_n - slowed_n),
        (true, f_max_n - 0.25 * slowed_n),
    ] {
        let mut reached_n = 0.0_f64;
        let mut before_n = None;
        for step in 0..20_000 {
            let Some(found_n) = tensions_n(may, f64::from(step) * 5e-4, 0.0) else {
                break;
            };
            let least_n = found_n.into_iter().fold(f64::INFINITY, f64::min);
            assert!(least_n > 0.998 * f_min_n, "{found_n:?}");
            let highest_n = highest(found_n);
            let jump_n = (highest_n - before_n.replace(highest_n).unwrap_or(highest_n)).abs();
            assert!(jump_n < 0.1, "{jump_n} N");
            reached_n = reached_n.max(highest_n);
        }
        assert!((reached_n - most_n).abs() < 0.1, "{may}: {reached_n} N");
    }
}

/// A motion that takes more for a moment than the last newtons has its tendons pull by no more, without a step: one of them lacks it.
#[test]
fn a_motion_takes_no_more_than_the_last_newtons() {
    let settings = Settings::table_1().unwrap();
    let f_max_n = f64::from(settings.f_max_n);
    let slowed_n = f64::from(settings.servos[0].f_max_band_n);
    let heaviest = |may: bool| {
        let steps = (0..20_000).map(|step| f64::from(step) * 5e-4);
        steps
            .take_while(|&kg| tensions_n(may, kg, 0.0).is_some())
            .last()
    };
    for may in [false, true] {
        let payload_kg = heaviest(may).unwrap() - 1e-3;
        let most_n = f_max_n - if may { 0.25 } else { 1.0 } * slowed_n;
        for sign in [1.0, -1.0] {
            let mut before_n = highest(tensions_n(may, payload_kg, 0.0).unwrap());
            for step in 0..400 {
                let found_n = tensions_n(may, payload_kg, sign * 0.01 * f64::from(step));
                let highest_n = highest(found_n.unwrap());
                assert!(highest_n < most_n + 1e-6, "{highest_n} N");
                assert!(
                    (highest_n - before_n).abs() < 0.5,
                    "{before_n} {highest_n} N"
                );
                before_n = highest_n;
            }
        }
    }
}

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
