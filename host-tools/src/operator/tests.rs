#![allow(clippy::unwrap_used, reason = "a test may panic")]

use super::{Demand, Goal, Host, Interrupt, Operator, OperatorError, differences};
use crate::emulated_leg::{Beginning, EmulatedLeg};
use crate::failure::Failure;
use crate::plant::Fault as PlantFault;
use crate::rig_file::RigFile;
use crate::simulation::InThisProcess;
use crate::transport::Transport;
use crate::transport::emulated::Emulated;
use leg_firmware::command::{Command, CommandRefusal};
use leg_firmware::frame::{self, MAX_FRAME};
use leg_firmware::host_link::{HostRefusal, HostReply};
use leg_firmware::settings::SettingsError;
use leg_firmware::supervisor::{Fault, State};
use std::collections::VecDeque;
use std::io;
use std::time::Duration;

fn emulated(beginning: Beginning) -> Emulated {
    let rig = RigFile::load(None).unwrap();
    let controller = Box::new(InThisProcess::default());
    Emulated::new(
        EmulatedLeg::new(&rig, beginning, controller).unwrap(),
        "the leg in this test",
    )
}

fn host(leg: &Emulated, id: u32) -> Operator {
    let sequence = 1000 * id as u16;
    let host = Host { id, sequence };
    Operator::open(Box::new(leg.beside()), host, Interrupt::default()).unwrap()
}

fn lean(tilt_deg: f64) -> Goal {
    let sine = tilt_deg.to_radians().sin() as f32;
    Goal {
        direction: Some([0.0, sine]),
        demand: None,
    }
}

fn state(operator: &mut Operator) -> State {
    operator.telemetry().unwrap().telemetry.state
}

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
        assert!(!error.cure().is_empty());
        assert_eq!(state(&mut operator), State::Held);
    }
}

#[test]
fn a_latched_fault_is_named_with_its_cure_until_it_is_cleared() {
    let leg = emulated(Beginning::Hanging);
    let mut operator = host(&leg, 1);
    leg.touch(|plant| plant.press_emergency_stop(true));
    operator.pause(Duration::from_millis(10)).unwrap();
    let error = operator.reach(&lean(10.0)).unwrap_err();
    assert!(
        error.to_string().contains("fault 23, emergency stop"),
        "{error}"
    );
    assert!(
        error.cure().ends_with("then `leg clear`"),
        "{}",
        error.cure()
    );
    // Its cause is still there.
    assert!(matches!(
        operator.clear().unwrap_err(),
        OperatorError::Faulted { faults, .. } if faults.has(Fault::EmergencyStop)
    ));
    leg.touch(|plant| plant.press_emergency_stop(false));
    operator.pause(Duration::from_millis(10)).unwrap();
    operator.clear().unwrap();
    assert_eq!(state(&mut operator), State::Disarmed);
    operator.reach(&lean(10.0)).unwrap();
}

#[test]
fn a_fault_on_the_way_is_told() {
    let leg = emulated(Beginning::Hanging);
    let mut operator = host(&leg, 1);
    operator.reach(&lean(5.0)).unwrap();
    leg.touch(|plant| plant.set_fault(PlantFault::DriverFault(1), true));
    let error = operator.reach(&lean(20.0)).unwrap_err();
    assert!(error.to_string().contains("driver fault"), "{error}");
}

/// Commands a move and comes back while the leg is on its way.
fn begin_move(operator: &mut Operator) {
    operator.command(Command::Arm).unwrap();
    operator.command(Command::Move { x: 0.4, y: 0.0 }).unwrap();
    operator.pause(Duration::from_millis(100)).unwrap();
    assert!(operator.telemetry().unwrap().telemetry.moving);
}

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
        error.cure().contains("it has to speak more often"),
        "{}",
        error.cure()
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

#[test]
fn settings_are_read_back_and_refused_by_name() {
    let leg = emulated(Beginning::Hanging);
    let mut operator = host(&leg, 1);
    let mut settings = operator.settings().unwrap().without_zero();
    settings.limits.slack_n = 3.0;
    operator.set_settings(&settings).unwrap();
    let found = operator.settings().unwrap();
    assert!(differences(&settings, &found).is_empty());
    settings.motion.speed_rad_per_s = 0.5;
    let names: Vec<_> = differences(&settings, &found)
        .into_iter()
        .map(|difference| difference.name)
        .collect();
    assert_eq!(names, ["motion.speed_rad_per_s"]);
    operator.save_settings().unwrap();
    settings.limits.slack_n = -1.0;
    let error = operator.set_settings(&settings).unwrap_err();
    assert!(
        matches!(
            error,
            OperatorError::Refused {
                refusal: HostRefusal::Settings(SettingsError::OutOfRange(_)),
                ..
            }
        ),
        "{error}"
    );
    assert_eq!(operator.settings().unwrap().limits.slack_n, 3.0);
    // They change the leg's zero, so it has to be homed.
    assert!(!operator.telemetry().unwrap().telemetry.homed);
}

#[test]
fn settings_of_a_driven_leg_stay() {
    let leg = emulated(Beginning::Hanging);
    let mut operator = host(&leg, 1);
    operator.reach(&lean(5.0)).unwrap();
    let settings = operator.settings().unwrap();
    let error = operator.set_settings(&settings).unwrap_err();
    assert!(
        matches!(
            error,
            OperatorError::Refused {
                refusal: HostRefusal::Driven,
                ..
            }
        ),
        "{error}"
    );
}

/// How a frame is lost.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Loss {
    Silent,
    /// The leg says that it could not read a frame.
    InPieces,
    /// The leg obeys, and its answer is lost.
    Answer,
    /// Another host stops the leg meanwhile.
    Stopped,
}

/// A line that loses the third frame of the host.
struct Spoilt {
    inner: Emulated,
    other: Operator,
    sent: u32,
    loss: Loss,
    /// Until then the answers are lost.
    deaf_until: Duration,
}

impl Transport for Spoilt {
    fn name(&self) -> &str {
        self.inner.name()
    }

    fn send(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.sent += 1;
        if self.sent != 3 {
            return self.inner.send(bytes);
        }
        match self.loss {
            Loss::Silent => Ok(()),
            Loss::InPieces => self.inner.send(bytes.get(3..).unwrap()),
            Loss::Answer => {
                self.deaf_until = self.inner.now() + Duration::from_millis(100);
                self.inner.send(bytes)
            }
            Loss::Stopped => {
                self.other.stop().unwrap();
                Ok(())
            }
        }
    }

    fn receive(&mut self, bytes: &mut [u8], timeout: Duration) -> io::Result<usize> {
        while self.inner.now() < self.deaf_until {
            let _ = self.inner.receive(bytes, Duration::from_millis(1));
        }
        self.inner.receive(bytes, timeout)
    }

    fn now(&self) -> Duration {
        self.inner.now()
    }
}

/// What comes of a move whose frame is lost: it is the third, after the introduction and the arming.
fn lost_move(loss: Loss) -> (Result<(), OperatorError>, bool) {
    let leg = emulated(Beginning::Hanging);
    let line = Spoilt {
        inner: leg.beside(),
        other: host(&leg, 2),
        sent: 0,
        loss,
        deaf_until: Duration::ZERO,
    };
    let mut operator = Operator::open(Box::new(line), Host::FIXED, Interrupt::default()).unwrap();
    let mut moving = false;
    let result = operator.drive(|operator| {
        operator.command(Command::Arm)?;
        operator.command(Command::Move { x: 0.1, y: 0.0 })?;
        moving = operator.telemetry()?.telemetry.moving;
        Ok(())
    });
    assert_eq!(state(&mut operator), State::Held);
    (result, moving)
}

#[test]
fn a_lost_move_is_sent_again_after_a_look_at_the_leg() {
    for loss in [Loss::Silent, Loss::InPieces, Loss::Answer] {
        let (result, moving) = lost_move(loss);
        result.unwrap();
        assert!(moving, "{loss:?}");
    }
}

#[test]
fn a_lost_move_is_not_sent_again_to_a_leg_that_was_stopped() {
    let (result, moving) = lost_move(Loss::Stopped);
    assert!(matches!(result, Err(OperatorError::Unanswered { .. })));
    assert!(!moving);
}

/// A board that always answers the same.
struct Always {
    reply: HostReply,
    answers: VecDeque<u8>,
    now: Duration,
}

impl Always {
    fn new(reply: HostReply) -> Self {
        Self {
            reply,
            answers: VecDeque::new(),
            now: Duration::ZERO,
        }
    }
}

impl Transport for Always {
    fn name(&self) -> &'static str {
        "a strange board"
    }

    fn send(&mut self, bytes: &[u8]) -> io::Result<()> {
        let mut decoder = frame::Decoder::new();
        for &byte in bytes {
            if let Some(Ok(frame)) = decoder.push(byte) {
                let mut out = [0; MAX_FRAME];
                let reply = frame::encode(frame.sequence, &self.reply, &mut out).unwrap();
                self.answers.extend(reply);
            }
        }
        Ok(())
    }

    fn receive(&mut self, bytes: &mut [u8], timeout: Duration) -> io::Result<usize> {
        let Some(byte) = self.answers.pop_front() else {
            self.now += timeout;
            return Err(io::ErrorKind::TimedOut.into());
        };
        *bytes.first_mut().unwrap() = byte;
        Ok(1)
    }

    fn now(&self) -> Duration {
        self.now
    }
}

fn greeting(reply: HostReply) -> String {
    let board = Box::new(Always::new(reply));
    match Operator::open(board, Host::FIXED, Interrupt::default()) {
        Ok(_) => String::new(),
        Err(error) => error.to_string(),
    }
}

#[test]
fn other_firmware_and_silence_are_told_apart() {
    let schema = HostRefusal::SchemaMismatch { schema: [0xab; 8] };
    let other = greeting(HostReply::Refused(schema));
    assert!(
        other.starts_with(
            "the firmware at a strange board speaks another protocol (schema abababababababab, this program "
        ),
        "{other}"
    );
    let silent = greeting(HostReply::Done);
    assert_eq!(silent, "a strange board does not answer");
}
