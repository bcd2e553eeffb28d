//! A leg on a simulated CAN bus.

use super::bus::{Damage, NodeId, SimulatedBus};
use super::port::BusPort;
use leg_firmware::can::{Assembler, CanFrame, Identifier, LegAddress, Segmenter};
use leg_firmware::command::Command;
use leg_firmware::frame::MAX_FRAME;
use leg_firmware::supervisor::State;
use leg_host::cancel_flag::CancelFlag;
use leg_host::operator::{Goal, HostIdentity, Operator};
use leg_host::transport::can::{CanPort, CanTransport};
use leg_rig::rig_file::RigFile;
use leg_sim::emulated_leg::{EmulatedLeg, InitialState};
use leg_sim::link::InProcess;
use std::cell::RefCell;
use std::collections::VecDeque;
use std::io;
use std::rc::Rc;
use std::time::Duration;

const LEG: LegAddress = LegAddress::ALL[2];

/// A bus, and a leg that lives on while somebody waits for a frame.
struct LegOnBus {
    bus: Rc<RefCell<SimulatedBus>>,
    leg: EmulatedLeg,
    node: NodeId,
    to_leg: Rc<RefCell<VecDeque<u8>>>,
    segmenter: Segmenter,
    link_frame: Vec<u8>,
}

impl LegOnBus {
    fn new(damage: Damage) -> Rc<RefCell<Self>> {
        let mut bus = SimulatedBus::new(damage, 1);
        let to_leg = Rc::new(RefCell::new(VecDeque::new()));
        let (inbox, mut assembler) = (
            Rc::clone(&to_leg),
            Assembler::<MAX_FRAME>::leg_receiver(LEG),
        );
        let node = bus.attach(Box::new(move |frame| {
            let link_frame = assembler.push(frame).link_frame.unwrap_or_default();
            inbox.borrow_mut().extend(link_frame);
            Vec::new()
        }));
        let rig = RigFile::load(None).unwrap();
        let link = Box::new(InProcess::new());
        Rc::new(RefCell::new(Self {
            bus: Rc::new(RefCell::new(bus)),
            leg: EmulatedLeg::new(&rig, InitialState::Homed, link).unwrap(),
            node,
            to_leg,
            segmenter: Segmenter::new(Identifier::ToHost(LEG)),
            link_frame: Vec::new(),
        }))
    }

    fn tick(&mut self) {
        let mut bus = self.bus.borrow_mut();
        while bus.step().is_some() {}
        for byte in self.leg.tick(&mut self.to_leg.borrow_mut()).unwrap() {
            self.link_frame.push(byte);
            if byte == 0 {
                for frame in self.segmenter.segments(&self.link_frame).unwrap() {
                    bus.send(self.node, frame);
                }
                self.link_frame.clear();
            }
        }
        while bus.step().is_some() {}
    }
}

/// A host's link on that bus, by the leg's time.
struct LegTimePort {
    inner: BusPort,
    wire: Rc<RefCell<LegOnBus>>,
}

impl CanPort for LegTimePort {
    fn name(&self) -> &str {
        self.inner.name()
    }

    fn send(&mut self, frame: &CanFrame) -> io::Result<()> {
        self.inner.send(frame)
    }

    fn receive(&mut self, timeout: Duration) -> io::Result<CanFrame> {
        let until = self.wire.borrow().leg.time() + timeout;
        loop {
            match self.inner.receive(Duration::ZERO) {
                Err(_) if self.wire.borrow().leg.time() < until => self.wire.borrow_mut().tick(),
                received => return received,
            }
        }
    }

    fn now(&self) -> Duration {
        self.wire.borrow().leg.time()
    }
}

fn host(
    wire: &Rc<RefCell<LegOnBus>>,
    id: u32,
    link: fn(LegTimePort, LegAddress) -> CanTransport<LegTimePort>,
) -> Operator {
    let port = LegTimePort {
        inner: BusPort::attach(&wire.borrow().bus),
        wire: Rc::clone(wire),
    };
    let sequence = 1000 * id as u16;
    let host = HostIdentity { id, sequence };
    Operator::open(Box::new(link(port, LEG)), host, CancelFlag::default()).unwrap()
}

fn lean(tilt_deg: f32) -> Goal {
    Goal::direction(0.0, tilt_deg.to_radians().sin())
}

#[test]
fn a_leg_on_can_is_moved_and_set_and_stopped_beside_its_host() {
    let wire = LegOnBus::new(Damage::default());
    let mut operator = host(&wire, 1, CanTransport::new);
    assert_eq!(operator.name(), "simulated bus, leg 3");
    operator.reach(&lean(10.0)).unwrap();
    let telemetry = operator.telemetry().unwrap().telemetry;
    assert_eq!(telemetry.state, State::KeepingStation);
    assert!((telemetry.pose[1] - 10_f32.to_radians().sin()).abs() < 1e-3);
    operator.command(Command::Arm).unwrap();
    operator.command(Command::Move { x: 0.3, y: 0.0 }).unwrap();
    let mut stopping = host(&wire, 2, CanTransport::urgent_only);
    assert_eq!(stopping.stop().unwrap().state, State::Held);
    operator.disarm().unwrap();
    // Settings take many CAN frames.
    let settings = operator.settings().unwrap();
    operator.set_settings(&settings).unwrap();
    assert_eq!(operator.damaged_frames() + stopping.damaged_frames(), 0);
}

#[test]
fn a_bus_that_loses_frames_costs_time_and_is_counted() {
    let wire = LegOnBus::new(Damage {
        lost: 0.02,
        doubled: 0.02,
        corrupted: 0.0,
    });
    let mut operator = host(&wire, 1, CanTransport::new);
    operator.reach(&lean(5.0)).unwrap();
    let state = operator.telemetry().unwrap().telemetry.state;
    assert_eq!(state, State::KeepingStation);
    assert!(operator.damaged_frames() > 0);
}
