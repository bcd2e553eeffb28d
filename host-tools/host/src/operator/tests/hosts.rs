//! Several hosts of one leg.

use super::{begin_move, hanging_leg, host, lean, state, telemetry};
use crate::operator::{Goal, OperatorError};
use leg_firmware::command::{Command, CommandRefusal};
use leg_firmware::host_link::HostRefusal;
use leg_firmware::supervisor::State;
use std::time::Duration;

#[test]
fn a_second_host_may_read_and_stop_and_nothing_else() {
    let leg = hanging_leg();
    let (mut first, mut second) = (host(&leg, 1), host(&leg, 2));
    begin_move(&mut first);
    for goal in [lean(-10.0), Goal::default()] {
        error_of!(
            second.reach(&goal),
            OperatorError::Refused(_, HostRefusal::OtherHost)
        );
        assert_eq!(state(&mut second), State::Active);
    }
    assert_eq!(second.stop().unwrap().state, State::Held);
    let held = HostRefusal::Command(CommandRefusal::State(State::Held));
    error_of!(
        first.command(Command::Move { x: 0.1, y: 0.0 }),
        OperatorError::Refused(_, refusal) if *refusal == held
    );
}

/// The stop that ends the work of the one that drives the leg would end its way down, too.
#[test]
fn a_leg_that_another_host_disarms_comes_down() {
    let leg = hanging_leg();
    let (mut first, mut second) = (host(&leg, 1), host(&leg, 2));
    begin_move(&mut first);
    let driven = first.drive(|operator| {
        second.command(Command::Disarm).unwrap();
        operator.command(Command::Move { x: 0.1, y: 0.0 })
    });
    let down = HostRefusal::Command(CommandRefusal::State(State::RampingDown));
    error_of!(driven, OperatorError::Refused(_, refusal) if *refusal == down);
    assert_ne!(state(&mut second), State::Held);
    second.disarm().unwrap();
    assert_eq!(state(&mut second), State::Disarmed);
    // What the first one did before gives it no part in what the second does now.
    begin_move(&mut second);
    error_of!(
        first.reach(&lean(-10.0)),
        OperatorError::Refused(_, HostRefusal::OtherHost)
    );
    assert_eq!(state(&mut second), State::Active);
}

/// What it is doing then is not for the one that drove it before to stop.
#[test]
fn a_leg_that_another_host_took_over_goes_on() {
    let leg = hanging_leg();
    let (mut first, mut second) = (host(&leg, 1), host(&leg, 2));
    begin_move(&mut first);
    let driven = first.drive(|operator| {
        second.stop().unwrap();
        second.command(Command::Clear).unwrap();
        operator.command(Command::Move { x: 0.1, y: 0.0 })
    });
    error_of!(driven, OperatorError::Refused(_, HostRefusal::OtherHost));
    assert_eq!(state(&mut second), State::Active);
}

#[test]
fn to_hold_a_leg_that_moves_ends_its_move() {
    let leg = hanging_leg();
    let mut operator = host(&leg, 1);
    begin_move(&mut operator);
    operator.reach(&Goal::default()).unwrap();
    let telemetry = telemetry(&mut operator);
    assert_eq!(telemetry.state, State::Held);
    assert!(telemetry.pose[0] < 0.3, "{:?}", telemetry.pose);
    assert!(!telemetry.faults.any());
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
