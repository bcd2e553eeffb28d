#![allow(clippy::unwrap_used, reason = "a test may panic")]

use super::{BRAKE_S, DISOBEYED_M, HAUL_S, Jogging, SETTLE_S, STRAY_M};
use crate::control::{JOG_RISE_S, JogBounds, Measured, TICK_S, ticks};
use crate::jog::{JogDemand, JogDrive, JogEnd, JogReport};
use crate::leg::shared::{Checked, Shared};
use crate::settings::Settings;

const VOLTAGE_V: f32 = 1.0;
const SPEED_M_PER_S: f64 = 1e-3;

/// A jog of the second motor.
struct Jog {
    jogging: Jogging<f64>,
    shared: Shared<f64>,
    measured: Measured<f64>,
    sign: f64,
}

impl Jog {
    fn new(travel_m: f32) -> Self {
        Self::with_tensions(travel_m, |_| 1.0)
    }

    /// Begins at tensions that may depend on the settings, N.
    fn with_tensions(travel_m: f32, tension_n: impl Fn(&Shared<f64>) -> f64) -> Self {
        let settings = Settings::table_1().unwrap();
        let mut shared = Shared::new(&settings, Checked::new(&settings).unwrap());
        let measured = Measured::resting([0.01, 0.02, 0.03], [tension_n(&shared); 3]);
        let demand = JogDemand {
            motor: 2,
            travel_m,
            drive: JogDrive::Voltage(VOLTAGE_V),
        };
        let bounds = JogBounds::select(&shared.limits.jogs, &demand).unwrap();
        Self {
            jogging: Jogging::begin(&mut shared, &demand, &bounds, &measured),
            shared,
            measured,
            sign: f64::from(travel_m.signum()),
        }
    }

    /// A tick in which the motor goes on at its speed; whether it has been braked.
    fn turn(&mut self) -> bool {
        self.measured.pulled_m[1] += self.sign * SPEED_M_PER_S * f64::from(TICK_S);
        self.jogging.step(&mut self.shared, &self.measured)
    }

    fn report(&self) -> &JogReport<f64> {
        self.shared.jog_report.as_ref().unwrap()
    }
}

/// The voltage of the motor alone comes up evenly in a tenth of a second, with the sign of its way.
#[test]
fn a_voltage_comes_up_evenly() {
    for travel_m in [5e-3, -5e-3] {
        let mut jog = Jog::new(travel_m);
        let rise = f64::from(ticks(JOG_RISE_S));
        for tick in 1..=2 * ticks(JOG_RISE_S) {
            jog.turn();
            let (motor, applied_v) = jog.jogging.voltage();
            assert_eq!(motor, 1);
            let risen = (f64::from(tick) / rise).min(1.0);
            let expected_v = jog.sign * f64::from(VOLTAGE_V) * risen;
            assert!((applied_v - expected_v).abs() < 1e-5, "{tick}");
            let time_s = f64::from(tick) * f64::from(TICK_S);
            assert!((jog.report().time_s - time_s).abs() < 1e-6, "{tick}");
        }
        assert_eq!(jog.report().end, JogEnd::Running);
    }
}

/// The means are those of the steady speed: what the motor did while its voltage came up is not in them.
#[test]
fn the_means_are_those_of_the_steady_speed() {
    let mut jog = Jog::new(5e-3);
    let current_a = 0.5 * jog.jogging.bounds.current_max_a;
    let rising = ticks(JOG_RISE_S + SETTLE_S);
    for tick in 0..rising + 800 {
        let even = f64::from(tick % 2);
        jog.measured.currents_a[1] = if tick < rising { 1.5 } else { 0.5 + even } * current_a;
        jog.measured.tensions_n[1] = if tick < rising { 5.0 } else { 1.0 + even };
        jog.turn();
    }
    let report = jog.report();
    assert_eq!(report.end, JogEnd::Running);
    assert!((report.steady_s - 0.1).abs() < 1e-6);
    assert!((report.speed_m_per_s - SPEED_M_PER_S).abs() < 1e-9);
    assert!((report.current_a - current_a).abs() < 1e-3 * current_a);
    assert!((report.tension_n - 1.5).abs() < 1e-3);
}

/// Counts of another motor end a jog; its own do not until it has gone its way, or goes the wrong one.
#[test]
fn a_jog_ends_by_the_counts_of_the_motor_that_should_not_turn() {
    for (motor, by_m, end) in [
        (0, f64::from(STRAY_M) * 1.1, JogEnd::OtherEncoder(1)),
        (2, f64::from(STRAY_M) * -1.1, JogEnd::OtherEncoder(3)),
        (0, f64::from(STRAY_M) * 0.9, JogEnd::Running),
        (1, f64::from(STRAY_M) * 1.1, JogEnd::Running),
        (1, f64::from(STRAY_M) * -1.1, JogEnd::WrongWay),
        (1, 5.1e-3, JogEnd::Arrived),
    ] {
        let mut jog = Jog::new(5e-3);
        jog.turn();
        jog.measured.pulled_m[motor] += by_m;
        jog.turn();
        assert_eq!(jog.report().end, end, "{motor} {by_m}");
    }
}

/// A motor that goes on, but never comes to its end, has twice the time of its way.
#[test]
fn a_jog_that_does_not_arrive_ends_after_its_time() {
    let mut jog = Jog::new(5e-3);
    let ticks_max = jog.jogging.ticks_max;
    let time_s = f64::from(ticks_max) * f64::from(TICK_S);
    let step_m = 0.9 * 5e-3 / f64::from(ticks_max);
    for tick in 1..ticks_max {
        jog.measured.pulled_m[1] += step_m;
        jog.jogging.step(&mut jog.shared, &jog.measured);
        assert_eq!(jog.report().end, JogEnd::Running, "{tick}");
    }
    jog.measured.pulled_m[1] += step_m;
    jog.jogging.step(&mut jog.shared, &jog.measured);
    assert_eq!(jog.report().end, JogEnd::Time);
    assert_eq!(jog.jogging.voltage(), (1, 0.0));
    assert!(
        (2.0..101.2).contains(&time_s) && (jog.report().time_s - time_s).abs() < 1e-3,
        "{time_s} s"
    );
}

/// A current beyond what any tension of a jog asks for ends it after 30 ms: a motor that has not turned counts nothing.
#[test]
fn a_jog_ends_by_a_current_that_lasts() {
    for (turns, end) in [(true, JogEnd::Current), (false, JogEnd::NoCounts)] {
        let mut jog = Jog::new(5e-3);
        for _ in 0..if turns { 800 } else { 0 } {
            jog.turn();
        }
        jog.measured.currents_a[1] = -1.1 * jog.jogging.bounds.current_max_a;
        for _ in 1..ticks(HAUL_S) {
            jog.jogging.step(&mut jog.shared, &jog.measured);
            assert_eq!(jog.report().end, JogEnd::Running);
        }
        jog.jogging.step(&mut jog.shared, &jog.measured);
        assert_eq!(jog.report().end, end);
    }
}

/// Tendons that pull already may be paid out, and not pulled in; a cell that shows more by what touches a tendon ends it.
#[test]
fn a_jog_of_taut_tendons_ends_by_a_cell_that_shows_more() {
    let taut_n = |shared: &Shared<f64>| 2.0 * f64::from(shared.limits.homing.f_max_n);
    for (travel_m, touches, end) in [
        (-5e-3, 0.0, JogEnd::Running),
        (-5e-3, 0.9, JogEnd::Running),
        (-5e-3, 1.1, JogEnd::Tension(3)),
        (5e-3, 0.0, JogEnd::Tension(1)),
    ] {
        let mut jog = Jog::with_tensions(travel_m, taut_n);
        let more_n = touches * f64::from(jog.shared.limits.homing.touch_n);
        jog.measured.steady_tensions_n[2] += more_n;
        jog.turn();
        assert_eq!(jog.report().end, end, "{travel_m} {touches}");
    }
}

/// A jog that is over is braked without a voltage, and what it measured stays.
#[test]
fn a_motor_is_braked_without_a_voltage_at_the_end() {
    let mut jog = Jog::new(5e-3);
    jog.turn();
    jog.measured.tensions_n[0] = 1e3;
    jog.measured.steady_tensions_n[0] = 1e3;
    for tick in 1..=ticks(BRAKE_S) {
        let over = jog.jogging.step(&mut jog.shared, &jog.measured);
        assert_eq!(jog.jogging.voltage(), (1, 0.0));
        assert_eq!(jog.report().end, JogEnd::Tension(1));
        assert_eq!(over, tick == ticks(BRAKE_S));
    }
}

/// One that turns on without a voltage does not obey it: its driver is switched off before the time of the brake is over.
#[test]
fn a_motor_that_turns_on_while_it_is_braked_is_switched_off_at_once() {
    for (step_m, at_once) in [
        (1.1 * f64::from(DISOBEYED_M), true),
        (0.9 * f64::from(DISOBEYED_M), false),
    ] {
        let mut jog = Jog::new(5e-3);
        jog.turn();
        jog.measured.steady_tensions_n[0] = 1e3;
        assert!(!jog.turn());
        jog.measured.pulled_m[1] += step_m;
        let over = jog.jogging.step(&mut jog.shared, &jog.measured);
        assert_eq!(over, at_once, "{step_m} m");
    }
}
