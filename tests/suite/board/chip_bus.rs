//! Six boards' images on six emulated chips, on one CAN FD bus with their hosts.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use crate::common::chip::{findings, image};
use crate::common::chip_bus::{ChipBus, ChipBusPort};
use crate::common::memory_mib;
use leg_boards::chip::{ChipSession, LATENCY_CYCLES_MAX};
use leg_boards::image::FirmwareImage;
use leg_firmware::can::{Identifier, LegAddress, Segmenter};
use leg_firmware::command::Command;
use leg_firmware::frame::{self, MAX_FRAME};
use leg_firmware::host_link::{BoardKind, HostRequest};
use leg_firmware::supervisor::State;
use leg_host::cancel_flag::CancelFlag;
use leg_host::operator::{HostIdentity, Operator};
use leg_host::transport::can::CanTransport;
use std::cell::RefCell;
use std::rc::Rc;

/// At most so much memory for a chip, MiB.
const MEMORY_MAX_MIB: f64 = 200.0;

/// From the stop to the state that every leg tells, µs of the bus.
const STOP_US: u64 = 2_000;

fn host(bus: &Rc<RefCell<ChipBus>>, leg: LegAddress) -> Operator {
    let id = u32::from(leg.number());
    let sequence = 1000 * u16::from(leg.number());
    let line = Box::new(CanTransport::new(ChipBusPort::attach(bus), leg));
    Operator::open(line, HostIdentity { id, sequence }, CancelFlag::default()).unwrap()
}

#[test]
fn six_chips_answer_under_their_numbers_and_one_stop_reaches_all() {
    let image = image(FirmwareImage::Stm32g474).unwrap();
    let before = memory_mib();
    let bus = ChipBus::new(&image, &LegAddress::ALL).unwrap();
    let mut hosts = LegAddress::ALL.map(|leg| host(&bus, leg));
    for (leg, host) in LegAddress::ALL.into_iter().zip(&mut hosts) {
        assert_eq!(host.name(), format!("bus of chips, {leg}"));
        assert_eq!(host.identity().board, BoardKind::Stm32g474);
        host.command(Command::Home).unwrap();
    }
    let states = |hosts: &mut [Operator; 6]| {
        let state = |host: &mut Operator| host.telemetry().unwrap().telemetry.state;
        hosts.each_mut().map(state)
    };
    assert_eq!(states(&mut hosts), [State::Homing; 6]);

    let request = HostRequest::Command {
        host: 1,
        command: Command::Stop,
    };
    let mut out = [0; MAX_FRAME];
    let link_frame = frame::encode(1, &request, &mut out).unwrap();
    let mut segmenter = Segmenter::new(Identifier::UrgentToAll);
    let stop = segmenter.segments(link_frame).unwrap().next().unwrap();
    bus.borrow_mut().send(stop);
    bus.borrow_mut().pass(STOP_US);
    let stopped = states(&mut hosts);
    assert!(!stopped.contains(&State::Homing), "{stopped:?}");

    let each = (memory_mib() - before) / 6.0;
    let (latency, _) = bus.borrow().worst_latency();
    eprintln!(
        "six chips: {each:.0} MiB each, {latency} cycles of latency, after the stop {stopped:?}"
    );
    assert!(latency <= LATENCY_CYCLES_MAX, "{latency} cycles");
    assert!(each <= MEMORY_MAX_MIB, "{each} MiB for a chip");
    let damaged: u64 = hosts.iter().map(Operator::damaged_frames).sum();
    assert_eq!(damaged, 0);
    let found = |session: &mut ChipSession| findings(session.chip().unwrap());
    let found: Vec<_> = bus.borrow_mut().legs.iter_mut().map(found).collect();
    assert!(found.iter().all(Vec::is_empty), "{found:?}");
}
