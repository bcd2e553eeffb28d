//! Goals are reached, or what keeps the leg from them is named.

use super::{emulated, host, lean, state};
use crate::operator::{Demand, Goal, OperatorError};
use leg_base::failure::Failure;
use leg_firmware::command::CommandRefusal;
use leg_firmware::host_link::HostRefusal;
use leg_firmware::supervisor::{Fault, State};
use leg_sim::emulated_leg::Beginning;
use std::time::Duration;

#[test]
fn a_move_ends_in_hold_at_its_goal() {
    let leg = emulated(Beginning::Hanging);
    let mut operator = host(&leg, 1);
    operator.reach(&lean(20.0)).unwrap();
    assert_eq!(state(&mut operator), State::Held);
    let tilt = leg.touch(|plant| plant.truth().direction.vector().y.asin());
    assert!((tilt.to_degrees() - 20.0).abs() < 0.02, "{tilt}");
    // From hold to hold, and nothing of it is a fault.
    operator.reach(&lean(-10.0)).unwrap();
    let telemetry = operator.telemetry().unwrap().telemetry;
    assert!(!telemetry.faults.any());
    operator.pause(Duration::from_secs(1)).unwrap();
    assert_eq!(state(&mut operator), State::Held);
}

#[test]
fn homing_ends_in_hold_with_the_true_zero() {
    let leg = emulated(Beginning::Slack(3e-3));
    let mut operator = host(&leg, 1);
    let refused = operator.reach(&lean(10.0)).unwrap_err();
    let not_homed = HostRefusal::Command(CommandRefusal::NotHomed);
    assert!(matches!(refused, OperatorError::Refused { refusal, .. } if refusal == not_homed));
    assert_eq!(state(&mut operator), State::Disarmed);
    operator.home().unwrap();
    let telemetry = operator.telemetry().unwrap().telemetry;
    assert_eq!(telemetry.state, State::Held);
    let real = leg.touch(|plant| plant.unstretched_at_zero_m());
    for (found, real) in telemetry.unstretched_at_zero_m.iter().zip(real) {
        assert!((f64::from(*found) - real).abs() < 2e-5);
    }
}

#[test]
fn a_stiffness_is_reached_or_its_limit_named() {
    let leg = emulated(Beginning::Hanging);
    let mut operator = host(&leg, 1);
    let demand = |stiffness| Goal {
        direction: None,
        demand: Some(Demand::Stiffness(stiffness, None)),
    };
    let reached = operator.reach(&demand(60.0)).unwrap();
    assert!((reached.stiffness_nm_per_rad - 60.0).abs() < 0.2);
    let error = operator.reach(&demand(1e4)).unwrap_err();
    assert!(
        matches!(error, OperatorError::Limited { faults, .. } if faults.has(Fault::Unreachable)),
        "{error}"
    );
    assert!(matches!(Failure::from(error), Failure::Missed(_)));
    assert_eq!(state(&mut operator), State::Held);
}

#[test]
fn what_the_leg_refuses_is_named_and_leaves_it_in_hold() {
    let leg = emulated(Beginning::Hanging);
    let mut operator = host(&leg, 1);
    for (direction, expected) in [
        ([0.9, 0.0], CommandRefusal::OutOfReach),
        ([f32::NAN, 0.0], CommandRefusal::Number),
    ] {
        let goal = Goal {
            direction: Some(direction),
            demand: None,
        };
        let error = operator.reach(&goal).unwrap_err();
        let expected = HostRefusal::Command(expected);
        assert!(
            matches!(error, OperatorError::Refused { refusal, .. } if refusal == expected),
            "{error}"
        );
        assert!(!error.remedy().is_empty());
        assert_eq!(state(&mut operator), State::Held);
    }
}

#[test]
fn stop_does_nothing_to_a_leg_at_rest() {
    let leg = emulated(Beginning::Hanging);
    let mut operator = host(&leg, 1);
    operator.pause(Duration::from_millis(10)).unwrap();
    assert_eq!(operator.stop().unwrap().state, State::Disarmed);
    operator.reach(&lean(5.0)).unwrap();
    operator.disarm().unwrap();
    assert_eq!(operator.stop().unwrap().state, State::Disarmed);
}
