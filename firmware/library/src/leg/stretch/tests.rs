#![allow(clippy::unwrap_used, reason = "a test may panic")]

use super::{
    FACTORS, LEAST_PART, MEASURED_KG, STEADY_STEPS, STEPS_MAX, StretchFound, StretchSearch,
    TRUSTED_KG,
};
use crate::control::{
    Estimate, LengthError, LoadEstimation, PretensionDemand, Target, TargetDemand, Turn,
};
use crate::leg::shared::{Checked, Shared};
use crate::settings::Settings;
use leg_model::{Direction, Elasticity, HalfTangent};
use nalgebra::Vector3;

const PRETENSION_N: f64 = 70.0;

/// A leg that hangs straight down at a pretension that its target has come to, or not, whose tendons are longer by a part of their elongation.
fn hanging(target_n: f64, longer_part: f64) -> Shared<f64> {
    let settings = Settings::table_1().unwrap();
    let mut shared = Shared::<f64>::new(&settings, Checked::new(&settings).unwrap());
    shared
        .pretension
        .demand(PretensionDemand::Pretension(PRETENSION_N));
    shared.targets.start_at(target_n);
    let target = next_target(&mut shared, target_n, target_n);
    let elongations_m = [0, 1, 2].map(|i| {
        shared.mechanism.tendons[i]
            .elongation(target.tensions_n[i])
            .unwrap()
    });
    let mean_m = -longer_part * elongations_m.iter().sum::<f64>() / 3.0;
    shared.estimate = Some(Estimate {
        direction: Direction::straight_down(),
        residual_m: mean_m.abs(),
        lengths_m: target.kinematics.lengths.into(),
        length_error: Some(LengthError {
            mean_m,
            elongations_m,
        }),
    });
    shared.target = Some(target);
    shared
}

/// The next target straight down for a pretension, N, of a leg whose tendons have a tension, N.
fn next_target(shared: &mut Shared<f64>, pretension_n: f64, tension_n: f64) -> Target<f64> {
    let demand = TargetDemand {
        q: HalfTangent::new(0.0, 0.0),
        load: shared.estimator.load.estimate(),
        turn: &Turn::none(),
        payload_kg: 0.0,
        compensated: true,
        trimmed: false,
        pretension_n,
    };
    let targets = &mut shared.targets;
    let next = targets.next(&shared.mechanism, &demand, &[tension_n; 3]);
    next.unwrap()
}

/// The first that a search finds, and after how many steps it was over.
fn searched(shared: &mut Shared<f64>, tensioned: bool) -> (StretchFound<f64>, u16) {
    let mut search = StretchSearch::begin();
    for steps in 1..=2 * STEPS_MAX {
        let found = search.find(shared, tensioned);
        if found != StretchFound::Nothing || search.is_over() {
            return (found, steps);
        }
    }
    panic!("the search does not end");
}

/// Has the leg show the moment that a payload has with the leg horizontal, with either sign, about either axis.
fn load(shared: &mut Shared<f64>, payload_kg: f64, axis: usize) {
    let mut moment = Vector3::zeros();
    moment[axis] = payload_kg * shared.mechanism.payload_lever;
    let down = Direction::straight_down();
    let (mechanism, estimator) = (&shared.mechanism, &mut shared.estimator);
    estimator
        .load
        .take(mechanism, &down, &moment, LoadEstimation::Immediate);
}

#[test]
fn tendons_that_stretch_otherwise_are_measured_at_their_pretension() {
    let [least, most] = FACTORS.map(f64::from);
    for factor in [least + 0.001, 0.8, 0.96, 1.04, 1.2, most - 0.001] {
        let mut shared = hanging(PRETENSION_N, factor - 1.0);
        let (found, steps) = searched(&mut shared, true);
        let StretchFound::Factor(found) = found else {
            panic!("{factor}: {found:?}");
        };
        assert!((found - factor).abs() < 1e-9, "{found}, not {factor}");
        assert_eq!(steps, STEADY_STEPS);
    }
}

#[test]
fn tendons_that_are_nearly_right_or_nothing_like_their_curve_are_left_as_they_are() {
    let least = f64::from(LEAST_PART);
    let words = format!("from {} to {} times their curve", FACTORS[0], FACTORS[1]);
    assert!(
        include_str!("../../../../SAFETY.md").contains(&words),
        "{words}"
    );
    let [low, high] = FACTORS.map(f64::from);
    for factor in [
        1.0,
        1.0 + 0.99 * least,
        1.0 - 0.99 * least,
        low - 0.01,
        high + 0.01,
    ] {
        let mut shared = hanging(PRETENSION_N, factor - 1.0);
        assert_eq!(
            searched(&mut shared, true),
            (StretchFound::Nothing, STEADY_STEPS),
            "{factor}"
        );
    }
}

/// What was taken over before counts, too.
#[test]
fn all_that_is_taken_over_is_bounded() {
    let [_, most] = FACTORS.map(f64::from);
    let mut shared = hanging(PRETENSION_N, 0.2);
    shared.elongation_factor = most / 1.19;
    assert_eq!(searched(&mut shared, true).0, StretchFound::Nothing);
    shared.elongation_factor = most / 1.21;
    assert!(matches!(
        searched(&mut shared, true).0,
        StretchFound::Factor(_)
    ));
}

/// What a wrong homing had taken over is taken back, to the settings themselves.
#[test]
fn tendons_that_are_as_the_settings_say_after_all_have_no_factor() {
    for (before, now, expected) in [(1.08, 1.01, 1.0), (0.9, 0.98, 1.0), (1.2, 1.1, 1.1)] {
        let mut shared = hanging(PRETENSION_N, now / before - 1.0);
        let elongation_m = |shared: &Shared<f64>| shared.mechanism.tendons[0].elongation(60.0);
        let by_settings_m = elongation_m(&shared).unwrap();
        shared.scale_tendons(before);
        let (StretchFound::Factor(factor), _) = searched(&mut shared, true) else {
            panic!("{before} {now}");
        };
        let off: f64 = if expected == 1.0 { 0.0 } else { 1e-3 };
        assert!((factor - expected).abs() <= off, "{factor} {expected}");
        shared.scale_tendons(factor);
        let part = elongation_m(&shared).unwrap() / by_settings_m;
        assert!((part - factor).abs() < 1e-9, "{part} {factor}");
    }
}

/// One load cell that is off shows a load beside the length: its tendons are not measured, and with more of it it is a fault.
#[test]
fn a_load_that_hangs_straight_down_is_a_fault_and_no_other_tendon() {
    let [measured_kg, trusted_kg] = [MEASURED_KG, TRUSTED_KG].map(f64::from);
    for axis in [0, 1] {
        for (kg, is_measured, is_fault) in [
            (0.99 * measured_kg, true, false),
            (1.01 * measured_kg, false, false),
            (-1.01 * measured_kg, false, false),
            (0.99 * trusted_kg, false, false),
            (1.01 * trusted_kg, false, true),
            (-1.01 * trusted_kg, false, true),
            (f64::NAN, false, true),
        ] {
            let mut shared = hanging(PRETENSION_N, 0.2);
            load(&mut shared, kg, axis);
            let (found, _) = searched(&mut shared, true);
            assert_eq!(
                matches!(found, StretchFound::Factor(_)),
                is_measured,
                "{kg}"
            );
            assert_eq!(found == StretchFound::Load, is_fault, "{kg}");
        }
    }
}

/// Where the bounds of the tensions hold a leg back it is over at once, so that this is said; one that comes to no pretension is not waited for.
#[test]
fn a_leg_that_does_not_come_to_its_pretension_is_not_measured() {
    let mut shared = hanging(40.0, 0.2);
    assert_eq!(
        searched(&mut shared, true),
        (StretchFound::Nothing, STEPS_MAX)
    );
    assert_eq!(
        searched(&mut shared, false),
        (StretchFound::Nothing, STEPS_MAX)
    );
    let highest_n = shared.target.unwrap().distribution.pretension_max;
    let mut shared = hanging(highest_n, 0.2);
    let beyond = PretensionDemand::Pretension(highest_n + 5.0);
    shared.pretension.demand(beyond);
    assert_eq!(searched(&mut shared, true), (StretchFound::Nothing, 1));
}

/// The next targets have the lengths that such tendons have at the tensions that are measured, so that the leg does not move.
#[test]
fn scaled_tendons_are_as_long_as_before_at_the_tensions_that_they_have() {
    const FACTOR: f64 = 1.2;
    let mut shared = hanging(PRETENSION_N, 0.0);
    shared.scale_tendons(FACTOR);
    assert_eq!(shared.elongation_factor, FACTOR);
    let target = next_target(&mut shared, PRETENSION_N, 50.0);
    assert!((target.pretension_n - 50.0).abs() < 0.1, "{target:?}");
    let unscaled = Settings::table_1().unwrap();
    let unscaled = Shared::<f64>::new(&unscaled, Checked::new(&unscaled).unwrap());
    for i in 0..3 {
        let elongation_m = unscaled.mechanism.tendons[i]
            .elongation(target.tensions_n[i])
            .unwrap();
        let length_m = target.kinematics.lengths[i] - FACTOR * elongation_m;
        assert!((target.unstretched_m[i] - length_m).abs() < 1e-9);
    }
}
