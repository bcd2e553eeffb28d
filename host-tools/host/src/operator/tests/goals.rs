//! Goals are reached, or what keeps the leg from them is named. What the commands show of it is in the transcripts and in the
//! tests of the emulated board.

use super::{emulated_line, hanging_leg, host, is_failed, lean, state, stiffness, telemetry};
use crate::operator::{Goal, OperatorError};
use leg_firmware::command::CommandRefusal;
use leg_firmware::host_link::HostRefusal;
use leg_firmware::supervisor::{Fault, State};
use leg_rig::rig_file::RigFile;
use leg_sim::emulated_leg::InitialState;
use std::cell::Cell;
use std::rc::Rc;
use std::time::Duration;

#[test]
fn a_move_ends_at_its_goal_and_the_leg_keeps_station_there() {
    let leg = hanging_leg();
    let mut operator = host(&leg, 1);
    operator.reach(&lean(20.0)).unwrap();
    assert_eq!(state(&mut operator), State::KeepingStation);
    let tilt = leg.with_plant(|plant| plant.truth().direction.vector().y.asin());
    assert!((tilt.to_degrees() - 20.0).abs() < 0.02, "{tilt}");
    // From station to station, and nothing of it is a fault.
    operator.reach(&lean(-10.0)).unwrap();
    assert!(!telemetry(&mut operator).faults.any());
    operator.pause(Duration::from_secs(1)).unwrap();
    assert_eq!(state(&mut operator), State::KeepingStation);
}

/// What another host does from there.
#[test]
fn a_leg_that_keeps_station_obeys_any_host() {
    let leg = hanging_leg();
    let (mut first, mut second) = (host(&leg, 1), host(&leg, 2));
    first.reach(&lean(10.0)).unwrap();
    second.clear().unwrap();
    assert_eq!(state(&mut second), State::KeepingStation);
    second.reach(&lean(12.0)).unwrap();
    first.reach(&stiffness(60.0)).unwrap();
    assert_eq!(state(&mut first), State::KeepingStation);
    second.reach(&Goal::default()).unwrap();
    assert_eq!(state(&mut second), State::Held);
    first.reach(&lean(11.0)).unwrap();
    assert_eq!(second.stop().unwrap().state, State::Held);
    first.reach(&lean(10.0)).unwrap();
    second.home().unwrap();
    assert_eq!(state(&mut second), State::Held);
    first.reach(&lean(10.0)).unwrap();
    second.disarm().unwrap();
    assert_eq!(state(&mut first), State::Disarmed);
}

/// A hold does not wait for the end of a correction.
#[test]
fn a_hold_ends_a_correction_at_once() {
    let leg = hanging_leg();
    let mut operator = host(&leg, 1);
    operator.reach(&lean(20.0)).unwrap();
    leg.with_plant(|plant| plant.set_payload(2.0, 0.2));
    operator.pause(Duration::from_millis(800)).unwrap();
    assert!(telemetry(&mut operator).moving);
    let begun = operator.now();
    operator.reach(&Goal::default()).unwrap();
    assert_eq!(state(&mut operator), State::Held);
    assert!(operator.now() - begun < Duration::from_millis(300));
}

/// Homing waits until the tendons are measured, and until a load that the leg cannot have is found.
#[test]
fn homing_measures_the_tendons_and_finds_a_cell_that_is_off() {
    for (curve_error, gain_error, found) in [(0.05, 0.0, None), (0.0, 0.5, Some(Fault::Residual))] {
        let mut real = RigFile::load(None).unwrap();
        real.plant.curve_error = curve_error;
        real.plant.cell_gain_error[0] = gain_error;
        let leg = emulated_line(&real, InitialState::Slack);
        let mut operator = host(&leg, 1);
        let homed = operator.home();
        assert_eq!(homed.is_err(), found.is_some(), "{homed:?}");
        let after = telemetry(&mut operator);
        assert_eq!(after.state, State::Held);
        assert_eq!(after.faults.stopping().faults().next(), found);
        let factor = f64::from(after.elongation_factor);
        assert!((factor - 1.0 - curve_error).abs() < 0.005, "{factor}");
    }
}

/// A move knows its payload where the leg kept station.
#[test]
fn a_loaded_move_takes_no_longer_from_station() {
    let leg = hanging_leg();
    let mut operator = host(&leg, 1);
    operator.reach(&lean(20.0)).unwrap();
    leg.with_plant(|plant| plant.set_payload(2.0, 0.2));
    operator.pause(Duration::from_secs(4)).unwrap();
    for tilt_deg in [15.0, 20.0, 10.0] {
        let began = operator.now();
        operator.reach(&lean(tilt_deg)).unwrap();
        let took = operator.now() - began;
        assert!(took < Duration::from_millis(2_500), "{tilt_deg}: {took:?}");
    }
}

#[test]
fn homing_finds_the_true_zero() {
    let leg = emulated_line(&RigFile::load(None).unwrap(), InitialState::Slack);
    let mut operator = host(&leg, 1);
    operator.home().unwrap();
    let telemetry = telemetry(&mut operator);
    assert_eq!(telemetry.state, State::Held);
    let real = leg.with_plant(|plant| plant.unstretched_at_zero_m());
    for (found, real) in telemetry.unstretched_at_zero_m.iter().zip(real) {
        assert!((f64::from(*found) - real).abs() < 2e-5);
    }
}

#[test]
fn what_the_leg_cannot_do_is_named_and_leaves_it_in_hold() {
    let leg = hanging_leg();
    let mut operator = host(&leg, 1);
    for (x, expected) in [
        (0.9, CommandRefusal::OutOfReach),
        (f32::NAN, CommandRefusal::Number),
    ] {
        let expected = HostRefusal::Command(expected);
        error_of!(
            operator.reach(&Goal::direction(x, 0.0)),
            OperatorError::Refused(_, refusal) if *refusal == expected
        );
        assert_eq!(state(&mut operator), State::Held);
    }
    let error = error_of!(
        operator.reach(&stiffness(1e4)),
        OperatorError::Limited(_, now) if now.faults.has(Fault::Unreachable)
    );
    assert!(is_failed(&error));
    assert_eq!(state(&mut operator), State::Held);
}

/// What ends a disarm on its way is told at once, as of every other command: the tendons may be taut yet.
#[test]
fn a_disarm_that_is_ended_on_its_way_says_by_what() {
    for stops in [true, false] {
        let leg = hanging_leg();
        let mut operator = host(&leg, 1);
        operator.reach(&lean(20.0)).unwrap();
        let (line, mut other) = (leg.clone(), host(&leg, 2));
        let mut polls = 0;
        operator.set_watcher(move |_| {
            polls += 1;
            match polls {
                10 if stops => drop(other.stop().unwrap()),
                10 => line.with_plant(|plant| plant.press_emergency_stop(true)),
                _ => {}
            }
        });
        let begun = operator.now();
        let disarmed = operator.disarm();
        if stops {
            error_of!(
                disarmed,
                OperatorError::StoppedByOtherHost("disarm", State::Held)
            );
        } else {
            error_of!(
                disarmed,
                OperatorError::Failed("disarm", now) if now.faults.has(Fault::EmergencyStop)
            );
        }
        assert!(operator.now() - begun < Duration::from_secs(2));
        let highest_n = telemetry(&mut operator)
            .tensions_n
            .into_iter()
            .fold(0.0, f32::max);
        assert!(highest_n > 20.0, "{highest_n} N");
    }
}

/// A leg that is stopped on its way brakes: what is told of it is where it rests.
#[test]
fn a_stop_that_waits_tells_where_the_leg_rests() {
    let leg = hanging_leg();
    let mut operator = host(&leg, 1);
    let mut other = host(&leg, 2);
    let told = Rc::new(Cell::new(None));
    let tell = told.clone();
    operator.set_watcher(move |now| {
        if now.pose[1] > 0.15 && tell.get().is_none() {
            tell.set(Some(other.stop_to_rest().unwrap().pose));
        }
    });
    error_of!(
        operator.reach(&lean(28.0)),
        OperatorError::StoppedByOtherHost(..)
    );
    let [x, y] = told.get().unwrap();
    operator.pause(Duration::from_secs(1)).unwrap();
    let rest = telemetry(&mut operator).pose;
    assert!(rest[1] > 0.05 && rest[1] < 0.4, "{rest:?}");
    assert!(
        (rest[0] - x).abs() < 1e-3 && (rest[1] - y).abs() < 1e-3,
        "{rest:?}"
    );
}

#[test]
fn a_stop_does_nothing_to_a_leg_at_rest() {
    let leg = hanging_leg();
    let mut operator = host(&leg, 1);
    operator.reach(&lean(5.0)).unwrap();
    operator.disarm().unwrap();
    assert_eq!(operator.stop().unwrap().state, State::Disarmed);
}
