//! How long a leg brakes that is held on its way, and which of its motors.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use super::station_stand::{armed, faults, paper};
use crate::common::require_said;
use leg_bench::stand::{Stand, move_to};
use leg_firmware::command::Command;
use leg_firmware::sensors::TICK_HZ;
use leg_firmware::supervisor::{Fault, State};
use leg_sim::plant::{Defect, Start};

/// Part of the maximum tension above which a leg brakes longer.
const NEAR_PART: f32 = 0.8;

/// How long a leg brakes; one that is near its maximum tension; and one whose motor may not obey, s.
const BRAKE_S: f64 = 0.15;
const GENTLE_BRAKE_S: f64 = 0.2;
const SHORT_BRAKE_S: f64 = 0.06;

/// Part of the speed of the fastest motor up to which none waits for one that does not obey.
const SLOW_PART: f64 = 0.15;

/// A leg in the middle of a move, and the highest tension that its target asks for, as a part of the maximum.
fn moving_leg(pretension_n: f64, payload_kg: f64) -> (Stand, f32) {
    let mut rig = paper();
    rig.pretension_n = pretension_n;
    let mut stand = armed(&rig, [30.0, 20.0], payload_kg, 3);
    stand.command(&move_to([210.0, 10.0])).unwrap();
    for _ in 0..TICK_HZ / 2 {
        stand.tick().unwrap();
    }
    assert!(stand.moving());
    let tensions_n = stand.telemetry.unwrap().target_tensions_n;
    let highest_n = tensions_n.into_iter().fold(0.0, f32::max);
    (stand, highest_n / rig.f_max_n as f32)
}

/// Time in which a leg that is held from the next ticks on brakes, s.
fn brake_s(stand: &mut Stand) -> f64 {
    let mut ticks = 0;
    loop {
        stand.tick().unwrap();
        match (stand.state(), stand.moving()) {
            (State::Held, true) => ticks += 1,
            (State::Held, false) => return f64::from(ticks) / f64::from(TICK_HZ),
            (state, _) => assert!(matches!(state, State::Active | State::Homing)),
        }
    }
}

#[test]
fn a_leg_that_is_stopped_brakes_longer_near_its_maximum_tension() {
    require_said(
        "firmware/SAFETY.md",
        &[
            format!(
                "brakes its motors within {BRAKE_S} s, {GENTLE_BRAKE_S} s where the target asks a tendon for more than {NEAR_PART} of \
                 the maximum tension"
            ),
            format!("It brakes within {SHORT_BRAKE_S} s: - where the leg homes"),
            format!("should go more than {SLOW_PART} times as fast as the fastest"),
            format!("but takes {SHORT_BRAKE_S} s at least"),
        ],
    );
    for (pretension_n, payload_kg, near, time_s) in [
        (70.0, 0.0, false, BRAKE_S),
        (120.0, 1.0, true, GENTLE_BRAKE_S),
    ] {
        let (mut stand, part) = moving_leg(pretension_n, payload_kg);
        assert_eq!(part > NEAR_PART, near, "{part}");
        stand.command(&Command::Stop).unwrap();
        let found_s = brake_s(&mut stand);
        assert!((found_s - time_s).abs() < 0.001, "{found_s} s");
    }
}

/// The motors that go fast, and the others.
fn fast_motors(stand: &Stand) -> (Vec<usize>, Vec<usize>) {
    let speeds = stand.truth.speeds_rad_per_s.map(f64::abs);
    let fastest = speeds.into_iter().fold(0.0, f64::max);
    (0..3).partition(|&motor| speeds[motor] > SLOW_PART * fastest)
}

/// The time in which a leg brakes one of whose sensors fails, s: its current and its tension come to disagree.
fn disagreeing_brake_s(moving: &Stand, defect: Defect) -> f64 {
    let mut stand = moving.clone();
    stand.plant().set_defect(defect, true);
    let found_s = brake_s(&mut stand);
    let named = faults(&stand);
    assert!(named.has(Fault::CurrentDisagrees), "{defect:?}: {named:?}");
    found_s
}

/// The others do not pull for long against it, unless it is hardly led.
#[test]
fn a_leg_whose_motor_is_not_counted_brakes_for_a_short_time() {
    let (stand, _) = moving_leg(70.0, 0.0);
    let (fast, slow) = fast_motors(&stand);
    assert!(fast.len() == 2 && slow.len() == 1);
    let short = fast.into_iter().map(|motor| (motor, SHORT_BRAKE_S));
    for (motor, time_s) in short.chain(slow.into_iter().map(|motor| (motor, BRAKE_S))) {
        let found_s = disagreeing_brake_s(&stand, Defect::EncoderLost(motor));
        assert!((found_s - time_s).abs() < 0.001, "{motor}: {found_s} s");
    }
}

/// A current sensor that is wrong leaves its motor as it is: the leg is braked as any other. That of the motor that pays its tendon
/// out, nearly without current, is named once the leg has come to its end.
#[test]
fn a_leg_whose_current_disagrees_while_its_motors_obey_is_braked_as_any_other() {
    let (stand, _) = moving_leg(70.0, 0.0);
    let (fast, _) = fast_motors(&stand);
    let brakes_s = fast
        .into_iter()
        .map(|motor| disagreeing_brake_s(&stand, Defect::CurrentZero(motor)));
    let on_its_way_s: Vec<f64> = brakes_s.filter(|&time_s| time_s > 0.0).collect();
    let [found_s] = on_its_way_s[..] else {
        panic!("{on_its_way_s:?}");
    };
    assert!((found_s - BRAKE_S).abs() < 0.001, "{found_s} s");
    let (stand, part) = moving_leg(120.0, 1.0);
    assert!(part > NEAR_PART, "{part}");
    // Near the maximum tension more gently. Motor 1, from 1, is named near the end of the way.
    for motor in [1, 2] {
        let found_s = disagreeing_brake_s(&stand, Defect::CurrentZero(motor));
        assert!(
            (found_s - GENTLE_BRAKE_S).abs() < 0.001,
            "{motor}: {found_s} s"
        );
    }
}

/// It hangs free: whatever its motor goes on lifts it.
#[test]
fn a_leg_that_homes_brakes_for_a_short_time() {
    let rig = paper();
    let start = Start::Slack { slack_mm: 2.0 };
    let mut stand = Stand::new(&rig, &rig.plant, start, 11).unwrap();
    stand.wait(0.1).unwrap();
    stand.command(&Command::Home).unwrap();
    stand.wait(0.2).unwrap();
    let speeds = stand.truth.speeds_rad_per_s;
    assert!(speeds.iter().any(|speed| speed.abs() > 1.0), "{speeds:?}");
    assert_eq!(stand.state(), State::Homing);
    stand.command(&Command::Stop).unwrap();
    let found_s = brake_s(&mut stand);
    assert!((found_s - SHORT_BRAKE_S).abs() < 0.001, "{found_s} s");
}

/// A motor that turns uncounted is led on nowhere: its driver is at rest in a tenth of the time of the brake.
#[test]
fn a_motor_that_is_not_counted_rests_while_the_others_brake() {
    let (mut stand, _) = moving_leg(70.0, 0.0);
    stand.plant().set_defect(Defect::EncoderLost(0), true);
    while stand.state() == State::Active {
        stand.tick().unwrap();
    }
    for _ in 0..TICK_HZ / 200 {
        stand.tick().unwrap();
    }
    assert!(stand.moving());
    let mut others_braked = false;
    while stand.moving() {
        let duty = stand.motors.duty;
        assert_eq!(duty[0], 0.0, "{duty:?}");
        others_braked |= duty[1..].iter().any(|duty| *duty != 0.0);
        stand.tick().unwrap();
    }
    assert!(others_braked);
}

/// What a suspect counter says leads no motor: they stand from the first tick on.
#[test]
fn a_leg_whose_counters_are_suspect_is_held_without_braking() {
    let mut rig = paper();
    for servo in &mut rig.gains.servos {
        servo.duty_max = 0.05;
    }
    let start = Start::Held {
        azimuth_deg: 40.0,
        tilt_deg: 20.0,
        pretension_n: rig.pretension_n,
        payload_kg: 1.0,
    };
    let mut stand = Stand::new(&rig, &rig.plant, start, 12).unwrap();
    stand.wait(0.1).unwrap();
    stand.command(&Command::Arm).unwrap();
    stand.wait(0.3).unwrap();
    stand.command(&move_to([60.0, 15.0])).unwrap();
    while stand.state() != State::Held {
        assert!(stand.time_s() < 5.0);
        stand.tick().unwrap();
    }
    assert!(faults(&stand).has(Fault::Following));
    for _ in 0..TICK_HZ / 3 {
        assert!(!stand.moving() && stand.motors.duty == [0.0; 3]);
        stand.tick().unwrap();
    }
}
