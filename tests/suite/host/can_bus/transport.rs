//! The host's transport on a bus.

use super::bus::{Damage, SimulatedBus};
use super::port::BusPort;
use leg_firmware::can::{Assembler, CanFrame, Identifier, LegAddress, Segmenter};
use leg_firmware::frame::MAX_FRAME;
use leg_host::transport::Transport;
use leg_host::transport::can::{CanPort, CanTransport};
use std::cell::RefCell;
use std::io::{self, ErrorKind};
use std::rc::Rc;
use std::time::Duration;

const LEG: LegAddress = LegAddress::ALL[1];
const TIMEOUT: Duration = Duration::from_millis(50);

/// A leg that sends every link frame back as it came.
fn echo(bus: &Rc<RefCell<SimulatedBus>>, leg: LegAddress) {
    let mut assembler = Assembler::<MAX_FRAME>::leg_receiver(leg);
    let mut segmenter = Segmenter::new(Identifier::ToHost(leg));
    bus.borrow_mut().attach(Box::new(move |frame| {
        let Some(link_frame) = assembler.push(frame).link_frame else {
            return Vec::new();
        };
        segmenter
            .segments(link_frame)
            .map_or_else(|_| Vec::new(), Iterator::collect)
    }));
}

fn with_echoes() -> CanTransport<BusPort> {
    let bus = Rc::new(RefCell::new(SimulatedBus::new(Damage::default(), 1)));
    for leg in LegAddress::ALL {
        echo(&bus, leg);
    }
    CanTransport::new(BusPort::attach(&bus), LEG)
}

fn receive(transport: &mut impl Transport, room: usize) -> io::Result<Vec<u8>> {
    let mut bytes = vec![0; room];
    let length = transport.receive(&mut bytes, TIMEOUT)?;
    bytes.truncate(length);
    Ok(bytes)
}

#[test]
fn frames_go_to_the_leg_and_come_back_in_pieces_of_any_size() -> io::Result<()> {
    let mut transport = with_echoes();
    assert_eq!(transport.name(), "simulated bus, leg 2");
    let mut sent = vec![7; 200];
    sent.extend([0, 1, 2, 0]);
    transport.send(&sent)?;
    let mut received = Vec::new();
    while received.len() < sent.len() {
        received.extend(receive(&mut transport, 9)?);
    }
    assert_eq!(received, sent);
    assert_eq!(transport.damaged(), 0);
    Ok(())
}

#[test]
fn nothing_in_time_is_a_timeout_and_no_room_is_nothing() -> io::Result<()> {
    let mut transport = with_echoes();
    let silent = receive(&mut transport, 9).map_err(|error| error.kind());
    assert_eq!(silent, Err(ErrorKind::TimedOut));
    assert!(receive(&mut transport, 0)?.is_empty());
    Ok(())
}

#[test]
fn half_a_frame_is_refused() {
    let mut transport = with_echoes();
    for wrong in [
        &[1, 2][..],
        &[1, 0, 2],
        &[[1; 62].as_slice(), &[0]].concat(),
    ] {
        let urgent = transport.send_urgent(wrong).map_err(|error| error.kind());
        assert_eq!(urgent, Err(ErrorKind::InvalidInput));
    }
    let refused = transport.send(&[1, 0, 2]).map_err(|error| error.kind());
    assert_eq!(refused, Err(ErrorKind::InvalidInput));
    assert!(
        receive(&mut transport, 9).is_err(),
        "nothing of it was sent"
    );
}

#[test]
fn urgent_frames_reach_their_leg_alone() -> io::Result<()> {
    let bus = Rc::new(RefCell::new(SimulatedBus::new(Damage::default(), 1)));
    for leg in LegAddress::ALL {
        echo(&bus, leg);
    }
    let mut here = CanTransport::new(BusPort::attach(&bus), LEG);
    let mut there = CanTransport::new(BusPort::attach(&bus), LegAddress::ALL[5]);
    here.send_urgent(&[1, 0])?;
    assert_eq!(receive(&mut here, 9)?, [1, 0]);
    assert!(receive(&mut there, 9).is_err());
    Ok(())
}

#[test]
fn one_who_only_stops_sends_nothing_under_the_ordinary_identifier() -> io::Result<()> {
    let bus = Rc::new(RefCell::new(SimulatedBus::new(Damage::default(), 1)));
    let mut listening = BusPort::attach(&bus);
    let mut stopping = CanTransport::urgent_only(BusPort::attach(&bus), LEG);
    stopping.send(&[1, 0, 2, 0])?;
    stopping.send_urgent(&[3, 0])?;
    for _ in 0..3 {
        let frame = listening.receive(TIMEOUT)?;
        assert_eq!(frame.identifier(), Identifier::Urgent(LEG));
    }
    let long = [[1; 62].as_slice(), &[0]].concat();
    let refused = stopping.send(&long).map_err(|error| error.kind());
    assert_eq!(refused, Err(ErrorKind::InvalidInput));
    Ok(())
}

#[test]
fn what_was_lost_is_counted() -> io::Result<()> {
    let bus = Rc::new(RefCell::new(SimulatedBus::new(Damage::default(), 1)));
    let mut leg = BusPort::attach(&bus);
    let mut host = CanTransport::new(BusPort::attach(&bus), LEG);
    let mut segmenter = Segmenter::new(Identifier::ToHost(LEG));
    let long = [vec![1; 150], vec![0]].concat();
    for (link_frame, lost) in [(&long, 1), (&vec![3, 0], 9)] {
        let segments = segmenter.segments(link_frame).map_err(io::Error::other)?;
        let frames: Vec<CanFrame> = segments.collect();
        for (_, frame) in frames.iter().enumerate().filter(|(i, _)| *i != lost) {
            leg.send(frame)?;
        }
    }
    assert_eq!(receive(&mut host, 9)?, [3, 0]);
    assert_eq!(host.damaged(), 1);
    Ok(())
}
