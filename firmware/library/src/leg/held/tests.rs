#![allow(clippy::unwrap_used, reason = "a test may panic")]

use super::{BRAKE_S, GENTLE_BRAKE_S, Held, Momentum, REST_BRAKE_S, SHORT_BRAKE_S, is_obeyed};
use crate::control::{AxisInput, Target, TargetDemand, Turn, ticks};
use crate::leg::shared::{Checked, Shared};
use crate::settings::Settings;
use leg_model::Direction;

/// A leg is braked in no more time than its way has left, but never at once; one at rest stops what brakes its swing sooner.
#[test]
fn a_brake_ends_where_the_way_would_have() {
    let settings = Settings::table_1().unwrap();
    let shared = Shared::<f64>::new(&settings, Checked::new(&settings).unwrap());
    let [longest, shortest, rest] = [BRAKE_S, SHORT_BRAKE_S, REST_BRAKE_S].map(ticks);
    for (ticks_to_end, expected) in [
        (None, longest),
        (Some(longest + 1), longest),
        (Some(longest - 1), longest - 1),
        (Some(shortest - 1), shortest),
        (Some(1), shortest),
        (Some(0), rest),
    ] {
        let momentum = Momentum {
            steps_m: [1e-6, 0.0, -1e-6],
            ticks_to_end,
        };
        let held = Held::braking(&shared, momentum, false);
        assert_eq!(held.ticks_left, expected, "{ticks_to_end:?}");
    }
    let page = include_str!("../../../../SAFETY.md");
    for said in [
        format!("but takes {SHORT_BRAKE_S} s at least"),
        format!("A leg at rest brakes within {REST_BRAKE_S} s"),
    ] {
        assert!(page.contains(&said), "{said}");
    }
}

/// Half of the way that it goes on at first is what is left of a brake; to that comes a tenth of a millimetre.
#[test]
fn a_tendon_is_paid_out_by_its_way_and_a_tenth_of_a_millimetre() {
    let ticks = 1000;
    let held = Held::<f64> {
        steps_m: [1e-6, 0.0, -1e-6],
        ticks_left: ticks,
        per_tick: 1.0 / ticks as f32,
    };
    let way_m = 0.5 * 1e-6 * f64::from(ticks);
    let [pulled, resting, paid_out] = held.lowest_m(&[0.01, 0.02, 0.03]);
    assert!((pulled - (0.01 - 1e-4)).abs() < 1e-9);
    assert!((resting - (0.02 - 1e-4)).abs() < 1e-9);
    assert!((paid_out - (0.03 - way_m - 1e-4)).abs() < 1e-9);
}

/// The tendon that is asked for most decides: near its maximum tension the leg is braked gently, whatever is measured.
#[test]
fn a_leg_near_its_maximum_tension_is_braked_more_gently() {
    let settings = Settings::table_1().unwrap();
    let f_max_n = f64::from(settings.f_max_n);
    let mut shared = Shared::<f64>::new(&settings, Checked::new(&settings).unwrap());
    let [gentle, usual] = [GENTLE_BRAKE_S, BRAKE_S].map(ticks);
    for (part, expected) in [(0.79, usual), (0.81, gentle)] {
        let demand = TargetDemand {
            q: Direction::straight_down().half_tangent(),
            turn: &Turn::none(),
            payload_kg: 0.0,
            load: shared.estimator.load.estimate(),
            compensated: true,
            trimmed: false,
            pretension_n: 0.0,
        };
        let target = shared
            .targets
            .next(&shared.mechanism, &demand, &[0.0; 3])
            .unwrap();
        shared.target = Some(Target {
            tensions_n: [0.1, part, 0.1].map(|part| part * f_max_n),
            ..target
        });
        let momentum = Momentum {
            steps_m: [1e-6, 0.0, -1e-6],
            ticks_to_end: None,
        };
        let held = Held::braking(&shared, momentum, false);
        assert_eq!(held.ticks_left, expected, "{part}");
    }
}

/// A motor that obeys loses its speed evenly, to none at the end: it goes half as far as it would have gone at its speed.
#[test]
fn a_motor_is_braked_evenly() {
    let settings = Settings::table_1().unwrap();
    let mut shared = Shared::<f64>::new(&settings, Checked::new(&settings).unwrap());
    let step_m = 1e-6;
    let mut led_m = 0.0;
    for _ in 0..1000 {
        led_m += step_m;
        shared.axes[0].track(led_m);
    }
    shared.axes[0].rest(led_m);
    shared.axes[0].lead_by(step_m);
    let momentum = Momentum {
        steps_m: [step_m, 0.0, 0.0],
        ticks_to_end: None,
    };
    let mut held = Held::braking(&shared, momentum, false);
    let brake = f64::from(held.ticks_left);
    let start_m = led_m;
    let mut steps = 0.0;
    while held.brakes() {
        held.step(&mut shared);
        steps += 1.0;
        let before_m = led_m;
        shared.axes[0].drive(&AxisInput {
            pulled_m: led_m,
            tension_n: 0.0,
            f_max_n: settings.f_max_n.into(),
            supply_v: 24.0,
            duty_per_v: 1.0 / 24.0,
            lowest_m: -1.0,
        });
        led_m = shared.axes[0].reference_m();
        shared.axes[0].track(led_m);
        let expected_m = step_m * (1.0 - steps / brake);
        assert!((led_m - before_m - expected_m).abs() < 1e-12, "{steps}");
    }
    let way_m = led_m - start_m;
    assert!((way_m - 0.5 * step_m * brake).abs() < step_m, "{way_m}");
}

/// A leg is obeyed unless a motor that is led fast has lost a tenth of its speed.
#[test]
fn a_leg_is_obeyed_unless_a_fast_motor_falls_short() {
    let settings = Settings::table_1().unwrap();
    let step_m = 1e-6;
    for (led, parts, expected) in [
        ([1.0, -0.5, 0.1], [1.0, 1.0, 1.0], true),
        ([1.0, -0.5, 0.1], [0.92, 0.92, 1.0], true),
        ([1.0, -0.5, 0.1], [0.88, 1.0, 1.0], false),
        ([1.0, -0.5, 0.1], [1.0, 0.88, 1.0], false),
        // One that is hardly led hinders nothing, even where it stands.
        ([1.0, -0.5, 0.14], [1.0, 1.0, 0.0], true),
        ([1.0, -0.5, 0.16], [1.0, 1.0, 0.0], false),
        // One that goes the other way does not obey.
        ([1.0, -0.5, 0.1], [1.0, -1.0, 1.0], false),
        ([0.0, 0.0, 0.0], [0.0, 0.0, 0.0], true),
    ] {
        let mut shared = Shared::<f64>::new(&settings, Checked::new(&settings).unwrap());
        for ((axis, led), part) in shared.axes.iter_mut().zip(led).zip(parts) {
            for tick in 0..1000 {
                axis.track(led * part * step_m * f64::from(tick));
            }
            axis.lead_by(led * step_m);
        }
        assert_eq!(is_obeyed(&shared), expected, "{led:?} {parts:?}");
    }
}
