//! Hosts that vanish, that come second, and Ctrl-C.

use super::{begin_move, emulated, host, lean, state};
use crate::operator::{Host, Interrupt, Operator, OperatorError};
use leg_firmware::command::{Command, CommandRefusal};
use leg_firmware::host_link::HostRefusal;
use leg_firmware::supervisor::{Fault, State};
use leg_sim::emulated_leg::Beginning;
use std::time::Duration;

#[test]
fn a_host_that_vanishes_in_mid_move_leaves_the_leg_in_hold() {
    let leg = emulated(Beginning::Hanging);
    let mut gone = host(&leg, 1);
    begin_move(&mut gone);
    drop(gone);
    let mut other = host(&leg, 2);
    other.pause(Duration::from_millis(300)).unwrap();
    let telemetry = other.telemetry().unwrap().telemetry;
    assert_eq!(telemetry.state, State::Held);
    assert!(telemetry.faults.has(Fault::CommandTimeout));
    // It is refused by name before it is cleared, and goes on then.
    let error = other.reach(&lean(10.0)).unwrap_err();
    assert!(
        error.remedy().contains("it has to speak more often"),
        "{}",
        error.remedy()
    );
    other.clear().unwrap();
    other.reach(&lean(10.0)).unwrap();
}

#[test]
fn a_second_host_may_look_and_stop_and_nothing_else() {
    let leg = emulated(Beginning::Hanging);
    let (mut first, mut second) = (host(&leg, 1), host(&leg, 2));
    begin_move(&mut first);
    let error = second.reach(&lean(-10.0)).unwrap_err();
    assert!(
        matches!(
            error,
            OperatorError::Refused {
                refusal: HostRefusal::OtherHost,
                ..
            }
        ),
        "{error}"
    );
    assert_eq!(state(&mut second), State::Active);
    assert_eq!(second.stop().unwrap().state, State::Held);
    let error = first.command(Command::Move { x: 0.1, y: 0.0 }).unwrap_err();
    let held = HostRefusal::Command(CommandRefusal::State(State::Held));
    assert!(matches!(error, OperatorError::Refused { refusal, .. } if refusal == held));
}

#[test]
fn ctrl_c_ends_a_move_in_hold() {
    let leg = emulated(Beginning::Hanging);
    let interrupt = Interrupt::default();
    let opened = Operator::open(Box::new(leg.beside()), Host::FIXED, interrupt.clone());
    let mut operator = opened.unwrap();
    operator.set_watcher(move |telemetry| {
        if telemetry.moving && telemetry.pose[1] > 0.05 {
            interrupt.raise();
        }
    });
    let error = operator.reach(&lean(25.0)).unwrap_err();
    assert!(matches!(error, OperatorError::Interrupted), "{error}");
    let mut other = host(&leg, 2);
    let telemetry = other.telemetry().unwrap().telemetry;
    assert_eq!(telemetry.state, State::Held);
    assert!(!telemetry.faults.any(), "no fault, a stop");
    assert!(telemetry.pose[1] < 0.3);
}
