//! How a command ends: held, and if that is not known, told so.

use super::{begin_move, emulated, host, lean, state};
use crate::operator::{Demand, Goal, Host, Interrupt, Operator, OperatorError};
use crate::transport::Transport;
use crate::transport::emulated::{Emulated, EmulatedEnd};
use leg_base::failure::Failure;
use leg_firmware::host_link::HostRefusal;
use leg_firmware::supervisor::State;
use leg_sim::emulated_leg::Beginning;
use std::cell::Cell;
use std::io;
use std::rc::Rc;
use std::time::Duration;

/// What becomes of a line.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum Fate {
    #[default]
    Whole,
    /// Nothing gets through any more.
    Deaf,
    /// The system says so.
    Broken,
}

struct Fated {
    inner: EmulatedEnd,
    fate: Rc<Cell<Fate>>,
}

impl Transport for Fated {
    fn name(&self) -> &str {
        self.inner.name()
    }

    fn send(&mut self, bytes: &[u8]) -> io::Result<()> {
        match self.fate.get() {
            Fate::Whole => self.inner.send(bytes),
            Fate::Deaf => Ok(()),
            Fate::Broken => Err(io::ErrorKind::BrokenPipe.into()),
        }
    }

    fn receive(&mut self, bytes: &mut [u8], timeout: Duration) -> io::Result<usize> {
        self.inner.receive(bytes, timeout)
    }

    fn now(&self) -> Duration {
        self.inner.now()
    }
}

fn fated(leg: &Emulated, interrupt: &Interrupt) -> (Operator, Rc<Cell<Fate>>) {
    let fate = Rc::default();
    let line = Fated {
        inner: leg.beside(),
        fate: Rc::clone(&fate),
    };
    let opened = Operator::open(Box::new(line), Host::FIXED, interrupt.clone());
    (opened.unwrap(), fate)
}

/// Ctrl-C in mid-move, on a line to which this happens in the same moment.
fn interrupted_on_a_line_that_becomes(becomes: Fate) -> OperatorError {
    let leg = emulated(Beginning::Hanging);
    let interrupt = Interrupt::default();
    let (mut operator, fate) = fated(&leg, &interrupt);
    operator.set_watcher(move |telemetry| {
        if telemetry.moving && telemetry.pose[1] > 0.05 {
            fate.set(becomes);
            interrupt.raise();
        }
    });
    operator.reach(&lean(25.0)).unwrap_err()
}

#[test]
fn a_stop_that_nobody_acknowledged_is_told_whatever_went_before() {
    let error = interrupted_on_a_line_that_becomes(Fate::Deaf);
    assert!(matches!(error, OperatorError::NotStopped { .. }), "{error}");
    assert!(error.remedy().contains("press the emergency stop"));
    assert!(matches!(Failure::from(error), Failure::Missed(_)));
    let error = interrupted_on_a_line_that_becomes(Fate::Broken);
    assert!(matches!(error, OperatorError::Broken { .. }), "{error}");
    let error = interrupted_on_a_line_that_becomes(Fate::Whole);
    assert!(matches!(error, OperatorError::Interrupted), "{error}");
}

#[test]
fn a_limit_is_not_said_to_be_held_where_no_stop_was_acknowledged() {
    let leg = emulated(Beginning::Hanging);
    let (mut operator, fate) = fated(&leg, &Interrupt::default());
    let result = operator.drive(|operator| {
        let goal = Goal {
            direction: None,
            demand: Some(Demand::Stiffness(1e4, None)),
        };
        let limited = operator.reach(&goal).unwrap_err();
        fate.set(Fate::Deaf);
        operator.command(leg_firmware::command::Command::Clear).ok();
        Err::<(), _>(limited)
    });
    let error = result.unwrap_err();
    assert!(matches!(error, OperatorError::NotStopped { .. }), "{error}");
}

#[test]
fn to_hold_a_leg_that_another_host_drives_is_refused_by_name() {
    let leg = emulated(Beginning::Hanging);
    let (mut first, mut second) = (host(&leg, 1), host(&leg, 2));
    begin_move(&mut first);
    let error = second.reach(&Goal::default()).unwrap_err();
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
}

#[test]
fn to_hold_a_leg_that_moves_ends_its_move() {
    let leg = emulated(Beginning::Hanging);
    let mut operator = host(&leg, 1);
    begin_move(&mut operator);
    operator.reach(&Goal::default()).unwrap();
    let telemetry = operator.telemetry().unwrap().telemetry;
    assert_eq!(telemetry.state, State::Held);
    assert!(telemetry.pose[0] < 0.3, "{:?}", telemetry.pose);
    assert!(!telemetry.faults.any());
}
