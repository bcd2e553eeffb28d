#![allow(clippy::unwrap_used, reason = "a test may panic")]

use super::{Axis, AxisInput, TICK_S};
use crate::control::Friction;
use crate::settings::Settings;

/// A tension that is asked for, N.
const TENSION_N: f64 = 100.0;

/// What is fed to a motor that is led at a speed, mm/s, and is so far ahead of its reference, µm, by what is fed to one that is not
/// ahead.
fn fed_part(mm_per_s: f64, ahead_um: f64) -> f64 {
    let [servo, ..] = Settings::table_1().unwrap().servos;
    let friction = Friction::new(&servo);
    let mut axis = Axis::<f64>::new(&servo);
    axis.lead_by(mm_per_s * 1e-3 * f64::from(TICK_S));
    axis.tracked_m = ahead_um * 1e-6 * mm_per_s.signum();
    axis.feed_friction(&friction, TENSION_N);
    axis.fed_v / friction.voltage_v(axis.step_m, TENSION_N)
}

/// Led at 0.05 mm/s, 0.3 µm is what the servo takes back at 0.036 mm/s; it feeds nothing against friction to a motor that it wants to
/// turn back, and no more to one that is behind.
#[test]
fn a_motor_ahead_of_its_reference_is_not_fed_on() {
    for mm_per_s in [0.05, -0.05] {
        for (ahead_um, range) in [
            (-1.0, 1.0..=1.0),
            (0.0, 1.0..=1.0),
            (0.3, 0.05..=0.3),
            (1.0, 0.0..=0.0),
        ] {
            let part = fed_part(mm_per_s, ahead_um);
            assert!(range.contains(&part), "{mm_per_s} {ahead_um}: {part}");
        }
    }
    assert_eq!(fed_part(5.0, 1.0), 1.0, "a motor on its way");
}

/// The speed at which a motor is led that is asked to pull in as fast as it can, as a part of that, by what its tension leaves to
/// the maximum, as a part of the band.
#[test]
fn a_motor_pulls_the_slower_the_nearer_its_tension_is_to_the_maximum_and_pays_out_above_it() {
    const SUPPLY_V: f64 = 24.0;
    let [servo, ..] = Settings::table_1().unwrap().servos;
    let fastest_m_per_s = f64::from(servo.speed_m_per_s);
    for (room_part, speed_part) in [
        (2.0, 1.0),
        (1.0, 1.0),
        (0.5, 0.5),
        (0.25, 0.25),
        (0.0, 0.0),
        (-0.25, -0.25),
        (-0.5, -0.5),
        (-1.0, -1.0),
        (-2.0, -1.0),
    ] {
        let mut axis = Axis::<f64>::new(&servo);
        axis.lead_by(fastest_m_per_s * f64::from(TICK_S));
        // At the speed that is expected, its duty is what that induces, and no more.
        axis.speed_m_per_s = speed_part * fastest_m_per_s;
        let duty = axis.drive(&AxisInput {
            pulled_m: 0.0,
            tension_n: TENSION_N,
            f_max_n: TENSION_N + room_part * f64::from(servo.f_max_band_n),
            supply_v: SUPPLY_V,
            duty_per_v: 1.0 / SUPPLY_V,
            lowest_m: -1.0,
        });
        let fastest_v = f64::from(servo.back_emf_v_s_per_m) * fastest_m_per_s;
        let duty_part = SUPPLY_V * duty / fastest_v;
        assert!(
            (duty_part - speed_part).abs() < 1e-6,
            "{room_part} of the band left: {duty_part} of the duty at full speed"
        );
    }
}

/// What a leg that is held goes on with: after a late tick a motor seems to be faster than it was led, and at the maximum tension it stays behind.
#[test]
fn a_motor_goes_on_by_its_speed_and_no_farther_than_it_is_led() {
    let [servo, ..] = Settings::table_1().unwrap().servos;
    for sign in [1.0, -1.0] {
        for (goes_m, led_m, expected_m) in [
            (1e-6, 1e-6, 1e-6),
            (5e-7, 1e-6, 5e-7),
            (4e-6, 1e-6, 1e-6),
            (4e-6, 0.0, 0.0),
            (-4e-6, 1e-6, -1e-6),
        ] {
            let mut axis = Axis::<f64>::new(&servo);
            for tick in 0..2000 {
                axis.track(sign * goes_m * f64::from(tick));
            }
            axis.lead_by(sign * led_m);
            let off_m = axis.moved_m() - sign * expected_m;
            assert!(off_m.abs() < 1e-9, "{goes_m} {led_m}: {off_m} m off");
        }
    }
}
