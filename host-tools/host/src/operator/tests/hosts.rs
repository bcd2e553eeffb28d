//! Hosts that vanish, that come second, and Ctrl-C.

use super::{begin_move, cancel_in_mid_move, hanging_leg, host, lean, operator, state, telemetry};
use crate::cancel_flag::CancelFlag;
use crate::operator::{LegGoal, OperatorError};
use leg_firmware::command::{Command, CommandRefusal};
use leg_firmware::host_link::HostRefusal;
use leg_firmware::supervisor::{Fault, State};
use std::time::Duration;

#[test]
fn a_host_that_vanishes_in_mid_move_leaves_the_leg_in_hold() {
    let leg = hanging_leg();
    let mut gone = host(&leg, 1);
    begin_move(&mut gone);
    drop(gone);
    let mut other = host(&leg, 2);
    other.pause(Duration::from_millis(300)).unwrap();
    let telemetry = telemetry(&mut other);
    assert_eq!(telemetry.state, State::Held);
    assert!(telemetry.faults.has(Fault::CommandTimeout));
    // It is refused by name before it is cleared, and goes on then.
    let error = error_of!(other.reach(&lean(10.0)), OperatorError::Faulted { .. });
    assert!(
        error
            .remedy()
            .contains(Fault::CommandTimeout.entry().remedy)
    );
    other.clear().unwrap();
    other.reach(&lean(10.0)).unwrap();
}

#[test]
fn a_second_host_may_read_and_stop_and_nothing_else() {
    let leg = hanging_leg();
    let (mut first, mut second) = (host(&leg, 1), host(&leg, 2));
    begin_move(&mut first);
    for goal in [lean(-10.0), LegGoal::default()] {
        error_of!(
            second.reach(&goal),
            OperatorError::Refused {
                refusal: HostRefusal::OtherHost,
                ..
            }
        );
        assert_eq!(state(&mut second), State::Active);
    }
    assert_eq!(second.stop().unwrap().state, State::Held);
    let held = HostRefusal::Command(CommandRefusal::State(State::Held));
    error_of!(
        first.command(Command::Move { x: 0.1, y: 0.0 }),
        OperatorError::Refused { refusal, .. } if *refusal == held
    );
}

#[test]
fn to_hold_a_leg_that_moves_ends_its_move() {
    let leg = hanging_leg();
    let mut operator = host(&leg, 1);
    begin_move(&mut operator);
    operator.reach(&LegGoal::default()).unwrap();
    let telemetry = telemetry(&mut operator);
    assert_eq!(telemetry.state, State::Held);
    assert!(telemetry.pose[0] < 0.3, "{:?}", telemetry.pose);
    assert!(!telemetry.faults.any());
}

#[test]
fn ctrl_c_ends_a_move_in_hold() {
    let (leg, cancel) = (hanging_leg(), CancelFlag::default());
    let mut operator = operator(leg.connect(), &cancel);
    cancel_in_mid_move(&mut operator, cancel, || ());
    error_of!(operator.reach(&lean(25.0)), OperatorError::Cancelled);
    let telemetry = telemetry(&mut host(&leg, 2));
    assert_eq!(telemetry.state, State::Held);
    assert!(!telemetry.faults.any(), "no fault, a stop");
    assert!(telemetry.pose[1] < 0.3);
}

#[test]
fn telemetry_goes_on_at_once_beside_another_hosts_introduction() {
    let leg = hanging_leg();
    let mut listening = host(&leg, 1);
    listening.start_stream(80).unwrap();
    let mut next = || {
        let report = listening.next_streamed(Duration::from_secs(20)).unwrap();
        report.unwrap().telemetry.tick
    };
    let mut last = next();
    let _other = host(&leg, 2);
    for _ in 0..10 {
        let tick = next();
        assert!(tick - last < 240, "{last} to {tick}");
        last = tick;
    }
}
