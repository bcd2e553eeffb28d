#![allow(clippy::unwrap_used, reason = "a test may panic")]

/// The error of a result, which has to match a pattern.
macro_rules! error_of {
    ($result:expr, $pattern:pat $(if $guard:expr)?) => {{
        let error = $result.map(drop).unwrap_err();
        assert!(matches!(&error, $pattern $(if $guard)?), "{error:?}");
        error
    }};
}

mod bad_lines;
mod goals;
mod hosts;
mod recorder;
mod scripted;
mod scripted_board;
mod settings;

use crate::cancel_flag::CancelFlag;
use crate::operator::{Goal, HostIdentity, Operator, OperatorError, Tensioning};
use crate::transport::Transport;
use crate::transport::emulated::{EmulatedLine, EmulatedTransport};
use leg_base::failure::Failure;
use leg_base::timed_path::{PathRow, TimedPath};
use leg_firmware::command::{Command, Compensation};
use leg_firmware::supervisor::State;
use leg_firmware::telemetry::Telemetry;
use leg_rig::rig_file::RigFile;
use leg_sim::emulated_leg::{EmulatedLeg, InitialState};
use leg_sim::link::InProcess;
use std::io;
use std::time::Duration;

fn emulated_line(rig: &RigFile, beginning: InitialState) -> EmulatedLine {
    let link = Box::new(InProcess::new());
    let leg = EmulatedLeg::new(rig, beginning, link).unwrap();
    EmulatedLine::new(leg, "the leg in this test")
}

/// A homed leg of the paper's rig that hangs straight down.
fn hanging_leg() -> EmulatedLine {
    emulated_line(&RigFile::load(None).unwrap(), InitialState::Homed)
}

fn host(leg: &EmulatedLine, id: u32) -> Operator {
    let sequence = 1000 * id as u16;
    let host = HostIdentity { id, sequence };
    Operator::open(Box::new(leg.connect()), host, CancelFlag::default()).unwrap()
}

fn operator(transport: impl Transport + 'static, cancel: &CancelFlag) -> Operator {
    Operator::open(Box::new(transport), HostIdentity::FIXED, cancel.clone()).unwrap()
}

fn lean(tilt_deg: f64) -> Goal {
    Goal::direction(0.0, tilt_deg.to_radians().sin() as f32)
}

fn stiffness(demand_nm_per_rad: f32) -> Goal {
    let towards = None;
    let tensioning = Tensioning::Stiffness {
        demand_nm_per_rad,
        towards,
    };
    Goal {
        tensioning: Some(tensioning),
        direction: None,
    }
}

/// Whether the work was done and failed: exit code 1.
fn is_failed(error: &OperatorError) -> bool {
    matches!(error.failure(), Failure::Failed(_))
}

fn telemetry(operator: &mut Operator) -> Telemetry<f32> {
    operator.telemetry().unwrap().telemetry
}

fn state(operator: &mut Operator) -> State {
    telemetry(operator).state
}

/// Commands a move and comes back while the leg is on its way.
fn begin_move(operator: &mut Operator) {
    operator.command(Command::Arm).unwrap();
    operator.command(Command::Move { x: 0.4, y: 0.0 }).unwrap();
    operator.pause(Duration::from_millis(100)).unwrap();
    assert!(telemetry(operator).moving);
}

/// Sets the flag once the leg is well on its way, and does something else then.
fn cancel_in_mid_move(operator: &mut Operator, cancel: CancelFlag, then: impl Fn() + 'static) {
    operator.set_watcher(move |telemetry| {
        if telemetry.moving && telemetry.pose[1] > 0.05 {
            then();
            cancel.set();
        }
    });
}

/// What a test does with the bytes of a frame.
type OnSend = Box<dyn FnMut(&mut EmulatedTransport, &[u8]) -> io::Result<()>>;

/// A line to an emulated leg on which a test decides what becomes of what is sent and received.
struct BadLine {
    inner: EmulatedTransport,
    on_send: OnSend,
    /// Called before bytes are waited for.
    on_receive: Box<dyn FnMut(&mut EmulatedTransport)>,
    /// Whether urgent frames are sent as they are.
    urgent_passes: bool,
}

impl BadLine {
    fn new(
        leg: &EmulatedLine,
        on_send: impl FnMut(&mut EmulatedTransport, &[u8]) -> io::Result<()> + 'static,
        on_receive: impl FnMut(&mut EmulatedTransport) + 'static,
    ) -> Self {
        Self {
            inner: leg.connect(),
            on_send: Box::new(on_send),
            on_receive: Box::new(on_receive),
            urgent_passes: false,
        }
    }
}

impl Transport for BadLine {
    fn name(&self) -> &str {
        self.inner.name()
    }

    fn send(&mut self, bytes: &[u8]) -> io::Result<()> {
        (self.on_send)(&mut self.inner, bytes)
    }

    fn send_urgent(&mut self, bytes: &[u8]) -> io::Result<()> {
        if self.urgent_passes {
            return self.inner.send(bytes);
        }
        self.send(bytes)
    }

    fn receive(&mut self, bytes: &mut [u8], timeout: Duration) -> io::Result<usize> {
        (self.on_receive)(&mut self.inner);
        self.inner.receive(bytes, timeout)
    }

    fn now(&self) -> Duration {
        self.inner.now()
    }
}

/// It is held where it sags under a load that somebody has left out.
#[test]
fn a_leg_that_sags_does_not_rise_by_a_hold() {
    let leg = hanging_leg();
    let mut operator = host(&leg, 1);
    operator.reach(&lean(20.0)).unwrap();
    operator.command(Command::Arm).unwrap();
    let left_out = Command::Compensation(Compensation::Off);
    operator.command(left_out).unwrap();
    leg.with_plant(|plant| plant.set_payload(1.0, 0.5));
    for _ in 0..20 {
        operator.pause(Duration::from_millis(100)).unwrap();
        operator.command(Command::KeepAlive).unwrap();
    }
    operator.stop().unwrap();
    let tip_m = |leg: &EmulatedLine| leg.with_plant(|plant| plant.truth().tip_m);
    let before = tip_m(&leg);
    operator.reach(&Goal::default()).unwrap();
    let moved_mm = 1000.0 * (tip_m(&leg) - before).norm();
    assert!(moved_mm < 0.3, "{moved_mm} mm");
}

/// Somebody has left its load out; else it would be held in the place of keeping station.
#[test]
fn every_command_that_makes_a_leg_active_compensates_again() {
    type Work = fn(&mut Operator) -> Result<Telemetry<f32>, OperatorError>;
    let works: [(&str, Work); 5] = [
        ("move", |operator| operator.reach(&lean(5.0))),
        ("another move", |operator| operator.reach(&lean(10.0))),
        ("follow", |operator| {
            let rows = [(0.0, 10.0), (0.2, 11.0), (0.4, 12.0)];
            let rows = rows.map(|(time_s, tilt_deg)| PathRow::from_angles(time_s, 90.0, tilt_deg));
            operator.follow_whole(&TimedPath::new(&rows), Duration::from_millis(200))
        }),
        ("stiffness", |operator| operator.reach(&stiffness(55.0))),
        ("hold", |operator| operator.reach(&Goal::default())),
    ];
    let leg = hanging_leg();
    let mut operator = host(&leg, 1);
    let follow_commands = |operator: &mut Operator| {
        operator.command(Command::Clear).unwrap();
        if telemetry(operator).state != State::Active {
            operator.command(Command::Arm).unwrap();
        }
        for _ in 0..5 {
            operator.pause(Duration::from_millis(40)).unwrap();
            operator.command(Command::KeepAlive).unwrap();
        }
    };
    // A leg that compensates keeps station once it is left; another is held.
    let state_once_left = |operator: &mut Operator| {
        operator.command(Command::KeepStation).unwrap();
        telemetry(operator).state
    };
    // Its tendons are taut from here on: another leg would be held in any case.
    operator.reach(&lean(2.0)).unwrap();
    for (what, work) in works {
        for disarmed in [false, true] {
            let what = format!("{what}, disarmed before: {disarmed}");
            follow_commands(&mut operator);
            let left_out = Command::Compensation(Compensation::Off);
            operator.command(left_out).unwrap();
            if disarmed {
                operator.disarm().unwrap();
                assert_eq!(state(&mut operator), State::Disarmed, "before {what}");
            } else {
                let left = state_once_left(&mut operator);
                assert_eq!(left, State::Held, "before {what}");
            }
            work(&mut operator).unwrap();
            follow_commands(&mut operator);
            let left = state_once_left(&mut operator);
            assert_eq!(left, State::KeepingStation, "{what}");
        }
    }
}
