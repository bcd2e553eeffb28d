//! Goals are reached, or what keeps the leg from them is named.

use super::{emulated_line, hanging_leg, host, lean, state, stiffness, telemetry};
use crate::operator::{LegGoal, OperatorError};
use leg_base::failure::Failure;
use leg_firmware::command::CommandRefusal;
use leg_firmware::host_link::HostRefusal;
use leg_firmware::supervisor::{Fault, State};
use leg_rig::rig_file::RigFile;
use leg_sim::emulated_leg::InitialState;
use leg_sim::plant::Defect;
use std::time::Duration;

/// Longer than the leg needs to notice something.
const A_MOMENT: Duration = Duration::from_millis(10);

#[test]
fn a_move_ends_in_hold_at_its_goal() {
    let leg = hanging_leg();
    let mut operator = host(&leg, 1);
    operator.reach(&lean(20.0)).unwrap();
    assert_eq!(state(&mut operator), State::Held);
    let tilt = leg.with_plant(|plant| plant.truth().direction.vector().y.asin());
    assert!((tilt.to_degrees() - 20.0).abs() < 0.02, "{tilt}");
    // From hold to hold, and nothing of it is a fault.
    operator.reach(&lean(-10.0)).unwrap();
    assert!(!telemetry(&mut operator).faults.any());
    operator.pause(Duration::from_secs(1)).unwrap();
    assert_eq!(state(&mut operator), State::Held);
}

#[test]
fn homing_ends_in_hold_with_the_true_zero() {
    let leg = emulated_line(&RigFile::load(None).unwrap(), InitialState::Slack);
    let mut operator = host(&leg, 1);
    let not_homed = HostRefusal::Command(CommandRefusal::NotHomed);
    error_of!(
        operator.reach(&lean(10.0)),
        OperatorError::Refused { refusal, .. } if *refusal == not_homed
    );
    assert_eq!(state(&mut operator), State::Disarmed);
    operator.home().unwrap();
    let telemetry = telemetry(&mut operator);
    assert_eq!(telemetry.state, State::Held);
    let real = leg.with_plant(|plant| plant.unstretched_at_zero_m());
    for (found, real) in telemetry.unstretched_at_zero_m.iter().zip(real) {
        assert!((f64::from(*found) - real).abs() < 2e-5);
    }
}

#[test]
fn a_stiffness_is_reached_or_its_limit_named() {
    let leg = hanging_leg();
    let mut operator = host(&leg, 1);
    let reached = operator.reach(&stiffness(60.0)).unwrap();
    assert!((reached.stiffness_nm_per_rad - 60.0).abs() < 0.2);
    let error = error_of!(
        operator.reach(&stiffness(1e4)),
        OperatorError::Limited { faults, .. } if faults.has(Fault::Unreachable)
    );
    assert!(matches!(Failure::from(error), Failure::Failed(_)));
    assert_eq!(state(&mut operator), State::Held);
}

#[test]
fn what_the_leg_refuses_is_named_and_leaves_it_in_hold() {
    let leg = hanging_leg();
    let mut operator = host(&leg, 1);
    for (direction, expected) in [
        ([0.9, 0.0], CommandRefusal::OutOfReach),
        ([f32::NAN, 0.0], CommandRefusal::Number),
    ] {
        let goal = LegGoal {
            direction: Some(direction),
            demand: None,
        };
        let expected = HostRefusal::Command(expected);
        let error = error_of!(
            operator.reach(&goal),
            OperatorError::Refused { refusal, .. } if *refusal == expected
        );
        assert!(!error.remedy().is_empty());
        assert_eq!(state(&mut operator), State::Held);
    }
}

#[test]
fn stop_does_nothing_to_a_leg_at_rest() {
    let leg = hanging_leg();
    let mut operator = host(&leg, 1);
    operator.pause(A_MOMENT).unwrap();
    assert_eq!(operator.stop().unwrap().state, State::Disarmed);
    operator.reach(&lean(5.0)).unwrap();
    operator.disarm().unwrap();
    assert_eq!(operator.stop().unwrap().state, State::Disarmed);
}

#[test]
fn a_latched_fault_is_named_with_its_remedy_until_it_is_cleared() {
    let leg = hanging_leg();
    let mut operator = host(&leg, 1);
    leg.with_plant(|plant| plant.press_emergency_stop(true));
    operator.pause(A_MOMENT).unwrap();
    let error = error_of!(operator.reach(&lean(10.0)), OperatorError::Faulted { .. });
    assert!(error.to_string().contains("fault 23, emergency stop"));
    assert!(error.remedy().ends_with("then `leg clear`"));
    // Its cause is still there.
    error_of!(
        operator.clear(),
        OperatorError::NotCleared(faults) if faults.has(Fault::EmergencyStop)
    );
    leg.with_plant(|plant| plant.press_emergency_stop(false));
    operator.pause(A_MOMENT).unwrap();
    operator.clear().unwrap();
    assert_eq!(state(&mut operator), State::Disarmed);
    operator.reach(&lean(10.0)).unwrap();
}

#[test]
fn a_fault_on_the_way_is_reported() {
    let leg = hanging_leg();
    let mut operator = host(&leg, 1);
    operator.reach(&lean(5.0)).unwrap();
    leg.with_plant(|plant| plant.set_defect(Defect::DriverFault(1), true));
    let error = operator.reach(&lean(20.0)).unwrap_err();
    assert!(error.to_string().contains("driver fault"), "{error}");
}
