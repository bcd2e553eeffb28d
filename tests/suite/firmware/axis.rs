//! The controller of one axis by itself.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use leg_firmware::control::{Axis, AxisGoal, AxisInput};
use leg_firmware::sensors::TICK_HZ;
use leg_firmware::settings::Settings;

/// A motor at a place, without a tension.
fn input(pulled_m: f64) -> AxisInput<f64> {
    AxisInput {
        pulled_m,
        tension_n: 0.0,
        f_max_n: 150.0,
        supply_v: 24.0,
        duty_per_v: 1.0 / 24.0,
        lowest_m: f64::MIN,
    }
}

fn goal(pulled_m: f64) -> AxisGoal<f64> {
    AxisGoal {
        pulled_m,
        speed_m_per_s: 0.03,
    }
}

/// A motor that cannot turn for half a second is driven with what its current allows; freed of its task, it is not driven
/// on by what an integral has gathered.
#[test]
fn an_integral_gathers_nothing_while_the_voltage_is_limited() {
    let settings = Settings::table_1().unwrap();
    let limit_v = f64::from(settings.servos[0].current_a * settings.servos[0].resistance_ohm);
    let mut axis = Axis::<f64>::new(&settings.servos[0]);
    axis.rest(0.0);
    let mut duty = 0.0;
    for _ in 0..TICK_HZ / 2 {
        axis.track(0.0);
        axis.lead(&goal(1e-3), 1.0);
        duty = axis.drive(&input(0.0));
    }
    assert!((duty * 24.0 - limit_v).abs() < 1e-3, "{} V", duty * 24.0);
    let mut ticks = 0;
    while duty > 0.01 && ticks < TICK_HZ {
        axis.track(0.0);
        axis.lead(&goal(-1e-4), 1.0);
        duty = axis.drive(&input(0.0));
        ticks += 1;
    }
    // The reference itself needs 1 mm / 30 mm/s, 267 ticks, to come back.
    assert!((200..300).contains(&ticks), "{ticks} ticks");
}

/// Above the maximum tension a tendon is let out, wherever it is led; but not beyond where it may go.
#[test]
fn a_tension_above_the_ceiling_turns_the_motor_round() {
    let settings = Settings::table_1().unwrap();
    let duty = |tension_n: f64, lowest_m: f64| {
        let mut axis = Axis::<f64>::new(&settings.servos[0]);
        axis.rest(0.0);
        axis.track(0.0);
        axis.lead(&goal(1e-3), 1.0);
        axis.drive(&AxisInput {
            tension_n,
            lowest_m,
            ..input(0.0)
        })
    };
    assert!(duty(140.0, f64::MIN) > 0.1);
    assert!(duty(151.0, f64::MIN) < -0.1);
    assert!(duty(151.0, 0.0).abs() < 1e-9);
}
