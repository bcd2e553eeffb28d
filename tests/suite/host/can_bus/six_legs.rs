//! Six legs and a host on one simulated CAN FD bus: who gets what, how soon, and what damage costs.

use super::bus::{Damage, NodeId, SimulatedBus, duration};
use leg_firmware::can::{Assembler, CanFrame, Identifier, LegAddress, Segmenter};
use leg_firmware::command::Command;
use leg_firmware::frame::{Decoder, MAX_FRAME, encode};
use std::cell::RefCell;
use std::rc::Rc;

/// What is said of one sender: its leg, its number and some bytes that belong to both.
type SentMessage = (u8, u32, Vec<u8>);

/// The message with this number: from one byte to 15 segments long.
fn message(leg: LegAddress, number: u32) -> SentMessage {
    let seed = u64::from(number) << 8 | u64::from(leg.number());
    let mut chance = fastrand::Rng::with_seed(seed);
    let length = if chance.bool() {
        12
    } else {
        chance.usize(..900)
    };
    let bytes = std::iter::repeat_with(|| chance.u8(..)).take(length);
    (leg.number(), number, bytes.collect())
}

fn segments<T: serde::Serialize>(segmenter: &mut Segmenter, message: &T) -> Vec<CanFrame> {
    let mut out = [0; MAX_FRAME];
    let link_frame = encode(1, message, &mut out).unwrap();
    segmenter.segments(link_frame).unwrap().collect()
}

/// One receiver's end: every message that it believes.
struct Receiver {
    assembler: Assembler,
    decoder: Decoder,
    messages: Vec<SentMessage>,
    commands: Vec<Command>,
}

impl Receiver {
    fn new(assembler: Assembler) -> Self {
        Self {
            assembler,
            decoder: Decoder::new(),
            messages: Vec::new(),
            commands: Vec::new(),
        }
    }

    fn take(&mut self, frame: &CanFrame) {
        for &byte in self.assembler.push(frame).link_frame.unwrap_or_default() {
            let Some(Ok(frame)) = self.decoder.push(byte) else {
                continue;
            };
            match frame.message::<Command>() {
                Some(command) => self.commands.push(command),
                None => self.messages.push(frame.message().unwrap()),
            }
        }
    }
}

/// One direction between the host and a leg.
struct LegTraffic {
    from: NodeId,
    leg: LegAddress,
    segmenter: Segmenter,
    end: Rc<RefCell<Receiver>>,
    next: u32,
}

impl LegTraffic {
    fn send(&mut self, bus: &mut SimulatedBus) {
        for frame in segments(&mut self.segmenter, &message(self.leg, self.next)) {
            bus.send(self.from, frame);
        }
        self.next += 1;
    }

    /// Numbers of what came, which has to be what was sent, in its order.
    fn numbers(&self) -> Vec<u32> {
        let end = self.end.borrow();
        for came in &end.messages {
            assert_eq!(*came, message(self.leg, came.1), "{}", self.leg);
        }
        // Twice is no wrong one: a sender's first frame comes again when it is doubled.
        assert!(end.messages.is_sorted_by(|a, b| a.1 <= b.1), "{}", self.leg);
        end.messages.iter().map(|message| message.1).collect()
    }
}

/// A host and six legs, and the streams to and from each.
struct SixLegs {
    bus: SimulatedBus,
    host: NodeId,
    to_legs: Vec<LegTraffic>,
    to_host: Vec<LegTraffic>,
}

fn six(seed: u64) -> SixLegs {
    let mut bus = SimulatedBus::new(Damage::default(), seed);
    let end = |assembler| Rc::new(RefCell::new(Receiver::new(assembler)));
    let at_host = LegAddress::ALL.map(|leg| end(Assembler::host_receiver(leg)));
    let ends = at_host.clone();
    let host = bus.attach(Box::new(move |frame| {
        ends.iter().for_each(|end| end.borrow_mut().take(frame));
        Vec::new()
    }));
    let (mut to_legs, mut to_host) = (Vec::new(), Vec::new());
    for (leg, at_host) in LegAddress::ALL.into_iter().zip(at_host) {
        let at_leg = end(Assembler::leg_receiver(leg));
        let inside = Rc::clone(&at_leg);
        let node = bus.attach(Box::new(move |frame| {
            inside.borrow_mut().take(frame);
            Vec::new()
        }));
        let stream = |from, identifier, end| LegTraffic {
            from,
            leg,
            segmenter: Segmenter::new(identifier),
            end,
            next: 0,
        };
        to_legs.push(stream(host, Identifier::ToLeg(leg), at_leg));
        to_host.push(stream(node, Identifier::ToHost(leg), at_host));
    }
    SixLegs {
        bus,
        host,
        to_legs,
        to_host,
    }
}

impl SixLegs {
    fn send_all(&mut self) {
        for stream in self.to_legs.iter_mut().chain(&mut self.to_host) {
            stream.send(&mut self.bus);
        }
    }

    fn run(&mut self) {
        while self.bus.step().is_some() {}
    }

    fn streams(&self) -> impl Iterator<Item = &LegTraffic> {
        self.to_legs.iter().chain(&self.to_host)
    }

    /// Asserts that every stream has brought the first messages, so many, once each.
    fn assert_arrived(&self, count: u32) {
        for stream in self.streams() {
            let expected: Vec<u32> = (0..count).collect();
            assert_eq!(stream.numbers(), expected, "{}", stream.leg);
        }
    }

    fn urgent(&mut self, identifier: Identifier) {
        for frame in segments(&mut Segmenter::new(identifier), &Command::Stop) {
            self.bus.send(self.host, frame);
        }
    }

    fn stopped(&self) -> Vec<u8> {
        let stopped = |stream: &&LegTraffic| stream.end.borrow().commands == [Command::Stop];
        let legs = self.to_legs.iter().filter(stopped);
        legs.map(|stream| stream.leg.number()).collect()
    }
}

#[test]
fn under_load_every_frame_reaches_its_node_and_no_other() {
    let mut six = six(1);
    for _ in 0..100 {
        six.send_all();
        // The bus does not come to an end of it before more is sent.
        for _ in 0..40 {
            six.bus.step();
        }
    }
    six.run();
    six.assert_arrived(100);
}

#[test]
fn a_stop_overtakes_all_that_waits() {
    for leg in LegAddress::ALL {
        let mut six = six(1);
        for _ in 0..20 {
            six.send_all();
        }
        for _ in 0..7 {
            six.bus.step();
        }
        let before = six.bus.elapsed();
        six.urgent(Identifier::Urgent(leg));
        let sent = six.bus.step().unwrap();
        assert_eq!(sent.identifier(), Identifier::Urgent(leg));
        assert_eq!(six.stopped(), [leg.number()]);
        // 11 bytes, padded to 12: and before it at most one frame that is already under way.
        let longest = CanFrame::new(Identifier::ToHost(leg), &[0; 64]).unwrap();
        let latest = six.bus.elapsed() - before + duration(&longest);
        assert!(latest.as_micros() < 200, "{latest:?}");
        six.run();
        six.assert_arrived(20);
    }
}

#[test]
fn a_stop_of_all_goes_before_a_stop_of_one() {
    let mut six = six(1);
    six.send_all();
    six.urgent(Identifier::Urgent(LegAddress::ALL[0]));
    six.urgent(Identifier::UrgentToAll);
    six.bus.step();
    assert_eq!(six.stopped(), [1, 2, 3, 4, 5, 6]);
}

#[test]
fn damage_never_makes_a_message_and_the_next_whole_one_gets_through() {
    let damages = [
        (0.05, 0.0, 0.0),
        (0.0, 0.2, 0.0),
        (0.0, 0.0, 0.1),
        (0.05, 0.05, 0.05),
        (0.5, 0.2, 0.2),
    ];
    for (seed, (lost, doubled, corrupted)) in (0..).zip(damages) {
        let mut six = six(seed);
        let mut clean = Vec::new();
        for round in 0..60 {
            six.bus.set_damage(Damage {
                lost,
                doubled,
                corrupted,
            });
            for _ in 0..1 + round % 4 {
                six.send_all();
            }
            six.run();
            six.bus.set_damage(Damage::default());
            clean.push(six.to_legs[0].next);
            six.send_all();
            six.run();
        }
        for stream in six.streams() {
            let numbers = stream.numbers();
            assert!(
                clean.iter().all(|number| numbers.contains(number)),
                "{}",
                stream.leg
            );
            let damaged = stream.next as usize > numbers.len();
            assert_eq!(damaged, lost > 0.0 || corrupted > 0.0, "{}", stream.leg);
        }
    }
}

#[test]
fn doubled_frames_alone_cost_nothing() {
    let mut six = six(4);
    // The first frame of a sender tells that it starts anew, and so comes again when doubled.
    six.send_all();
    six.run();
    six.bus.set_damage(Damage {
        doubled: 1.0,
        ..Damage::default()
    });
    for _ in 1..50 {
        six.send_all();
    }
    six.run();
    six.assert_arrived(50);
}
