//! Emulated chips on one CAN FD bus, and hosts there.
//!
//! All chips run by one clock, that of the bus. The lowest identifier that anybody would send goes on; its frame takes its
//! time, and then every other node says what it thinks of it.

use super::chip::{LatencyMeter, resting_tick, vary_cells};
use leg_boards::chip::ChipSession;
use leg_firmware::can::{CanFrame, DATA_BIT_RATE, Identifier, LegAddress, NOMINAL_BIT_RATE};
use leg_firmware::settings::Settings;
use leg_firmware_bench::protocol::Request;
use leg_host::transport::can::CanPort;
use leg_sim::link::Link;
use std::cell::RefCell;
use std::collections::VecDeque;
use std::error::Error;
use std::io;
use std::path::Path;
use std::rc::Rc;
use std::time::Duration;
use stm32g474_emulator::chip::Chip;
use stm32g474_emulator::device::Context;
use stm32g474_emulator::facts::Pin;
use stm32g474_emulator::fdcan::{DataFrame, Fdcan, Reception, TransmitOutcome};
use stm32g474_emulator::gpio::Outside;

/// The time after which a chip takes part in the bus, µs, and ticks that are checked before.
const BOOT_US: u64 = 5_000;
const CHECKED_TICKS: usize = 10;

/// What passes from one look at an idle bus to the next, cycles: 10 µs.
const STEP: u64 = 1_700;

/// Cycles in a second.
const CLOCK_HZ: u64 = 170_000_000;

/// The address switches: port C, the lowest bit first.
const SWITCHES: [u8; 3] = [10, 11, 12];

/// A chip that has started as a leg on a CAN bus.
pub fn started_on_can(
    image: &Path,
    leg: LegAddress,
    ticks: usize,
) -> Result<ChipSession, Box<dyn Error>> {
    let mut session = ChipSession::open(image)?;
    let mut settings = Settings::table_1().ok_or("no built-in settings")?;
    // Nothing turns the encoders here.
    settings.limits.still_time_s = 10.0;
    session.ask(&Request::Start(settings))?;
    let chip = session.chip().ok_or("no chip")?;
    for (bit, number) in SWITCHES.into_iter().enumerate() {
        if leg.number() >> bit & 1 == 1 {
            let port = 'C';
            let switch = Pin { port, number };
            chip.peripherals().devices.set_outside(switch, Outside::Low);
        }
    }
    for _ in 0..ticks {
        session.ask(&Request::Tick(resting_tick()))?;
    }
    Ok(session)
}

/// A frame as the board's documents have it on the bus.
pub fn bus_frame(frame: &CanFrame) -> DataFrame {
    DataFrame {
        identifier: frame.identifier().bits(),
        fd: true,
        bit_rate_switch: true,
        payload: frame.payload().to_vec(),
        nominal_hz: NOMINAL_BIT_RATE,
        data_hz: DATA_BIT_RATE,
    }
}

/// Does something with a chip's node.
pub fn with_node<R>(chip: &Chip, work: impl FnOnce(&mut Fdcan, &mut Context<'_>) -> R) -> R {
    let mut peripherals = chip.peripherals();
    let (devices, mut context) = peripherals.moment(chip.cycle());
    work(&mut devices.fdcan, &mut context)
}

/// A frame under way.
struct Sending {
    frame: DataFrame,
    /// The chip that sends it; none for the hosts.
    from: Option<usize>,
    end: u64,
}

/// The bus with its chips. The hosts share a node, and all of them hear everything.
pub struct ChipBus {
    pub legs: Vec<ChipSession>,
    /// How late their control interrupts are.
    pub meters: Vec<LatencyMeter>,
    now: u64,
    sending: Option<Sending>,
    from_hosts: Vec<CanFrame>,
    inboxes: Vec<VecDeque<CanFrame>>,
}

impl ChipBus {
    /// With chips that start with an image, one for each leg.
    pub fn new(image: &Path, legs: &[LegAddress]) -> Result<Rc<RefCell<Self>>, Box<dyn Error>> {
        let started = legs
            .iter()
            .map(|leg| started_on_can(image, *leg, CHECKED_TICKS));
        let mut legs = started.collect::<Result<Vec<_>, _>>()?;
        let meters = legs.iter().map(|_| LatencyMeter::new());
        let meters = meters.collect::<Result<Vec<_>, _>>()?;
        let chips = legs.iter_mut().filter_map(ChipSession::chip);
        let now = chips.map(|chip| chip.cycle()).max().unwrap_or_default();
        let mut bus = Self {
            legs,
            meters,
            now,
            sending: None,
            from_hosts: Vec::new(),
            inboxes: Vec::new(),
        };
        bus.pass(BOOT_US);
        Ok(Rc::new(RefCell::new(bus)))
    }

    /// The latest control interrupt of all, cycles, and where the program is then.
    pub fn worst_latency(&self) -> (u64, u32) {
        let worst = self.meters.iter().map(|meter| meter.worst).max();
        worst.unwrap_or_default()
    }

    fn chips(&mut self) -> impl Iterator<Item = &mut Chip> {
        self.legs.iter_mut().filter_map(ChipSession::chip)
    }

    /// Lets time pass: to the end of the frame that is under way, or a step.
    pub fn step(&mut self) {
        let ending = self.sending.as_ref().map(|sending| sending.end);
        let end = ending.unwrap_or(self.now + STEP);
        let chips = self.legs.iter_mut().filter_map(ChipSession::chip);
        for (chip, meter) in chips.zip(&mut self.meters) {
            vary_cells(chip);
            meter.run(chip, end);
        }
        self.now = end;
        if let Some(sending) = self.sending.take() {
            self.deliver(&sending);
        }
        self.sending = self.arbitrate();
    }

    /// Lets so many microseconds pass.
    pub fn pass(&mut self, us: u64) {
        let end = self.now + us * CLOCK_HZ / 1_000_000;
        while self.now < end {
            self.step();
        }
    }

    /// A host hands a frame over: an urgent one goes before the others.
    pub fn send(&mut self, frame: CanFrame) {
        self.from_hosts.push(frame);
    }

    fn arbitrate(&mut self) -> Option<Sending> {
        let own = |(index, frame): (usize, &CanFrame)| (frame.identifier().bits(), index);
        let host = self.from_hosts.iter().enumerate().map(own).min();
        let wants = |(index, chip): (usize, &mut Chip)| {
            Some((with_node(chip, |node, _| node.wants())?, index))
        };
        let chip = self.chips().enumerate().filter_map(wants).min();
        let (from, frame) = match (host, chip) {
            (Some((urgency, index)), chip) if chip.is_none_or(|(other, _)| urgency < other) => {
                (None, bus_frame(&self.from_hosts.remove(index)))
            }
            (_, Some((_, index))) => {
                let chip = self.chips().nth(index)?;
                let taken = with_node(chip, |node, context| node.take_transmission(context));
                (Some(index), taken?)
            }
            _ => return None,
        };
        let ns = frame.duration_ns();
        let end = self.now + (ns * (CLOCK_HZ / 1_000_000)).div_ceil(1_000);
        Some(Sending { frame, from, end })
    }

    /// A frame has ended: every other node says what it thinks of it. Hosts acknowledge what chips send.
    fn deliver(&mut self, sending: &Sending) {
        let frame = &sending.frame;
        let others = self
            .chips()
            .enumerate()
            .filter(|(index, _)| Some(*index) != sending.from);
        let said: Vec<_> = others
            .map(|(_, chip)| with_node(chip, |node, context| node.bus_receive(frame, context)))
            .collect();
        let heard = sending.from.is_some() || said.contains(&Reception::Acknowledged);
        let outcome = match heard {
            _ if said.contains(&Reception::Error) => TransmitOutcome::Disturbed,
            true => TransmitOutcome::Acknowledged,
            false => TransmitOutcome::Unacknowledged,
        };
        let identifier = Identifier::from_bits(frame.identifier);
        let known =
            identifier.and_then(|identifier| CanFrame::new(identifier, &frame.payload).ok());
        match (sending.from, known) {
            (Some(from), known) => {
                if let Some(chip) = self.chips().nth(from) {
                    with_node(chip, |node, context| {
                        node.transmission_ends(outcome, context)
                    });
                }
                for inbox in &mut self.inboxes {
                    inbox.extend(known);
                }
            }
            // A host tries again.
            (None, Some(known)) if outcome != TransmitOutcome::Acknowledged => {
                self.from_hosts.insert(0, known);
            }
            (None, _) => {}
        }
    }
}

/// A host's link to a leg on the bus, by the bus's time.
pub struct ChipBusPort {
    bus: Rc<RefCell<ChipBus>>,
    inbox: usize,
}

impl ChipBusPort {
    /// A host's node beside the others.
    pub fn attach(bus: &Rc<RefCell<ChipBus>>) -> Self {
        let inboxes = &mut bus.borrow_mut().inboxes;
        inboxes.push(VecDeque::new());
        Self {
            inbox: inboxes.len() - 1,
            bus: Rc::clone(bus),
        }
    }
}

impl CanPort for ChipBusPort {
    fn name(&self) -> &str {
        "bus of chips"
    }

    fn send(&mut self, frame: &CanFrame) -> io::Result<()> {
        self.bus.borrow_mut().send(*frame);
        Ok(())
    }

    fn receive(&mut self, timeout: Duration) -> io::Result<CanFrame> {
        let until = self.now() + timeout;
        loop {
            let mut bus = self.bus.borrow_mut();
            let received = bus.inboxes.get_mut(self.inbox);
            if let Some(frame) = received.and_then(VecDeque::pop_front) {
                return Ok(frame);
            }
            drop(bus);
            if self.now() >= until {
                return Err(io::ErrorKind::TimedOut.into());
            }
            self.bus.borrow_mut().step();
        }
    }

    fn now(&self) -> Duration {
        Duration::from_nanos(self.bus.borrow().now * 1_000 / (CLOCK_HZ / 1_000_000))
    }
}
