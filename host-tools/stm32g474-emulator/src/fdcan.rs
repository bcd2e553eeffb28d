//! FDCAN2: a node on the bus of the hosts and the other legs.
//!
//! The bus itself is outside: it asks each node by [`Fdcan::wants`] what it would send, lets the lowest identifier send
//! by [`Fdcan::take_transmission`], and after [`DataFrame::duration_ns`] hands the frame to the others by
//! [`Fdcan::bus_receive`] and their answer to the sender by [`Fdcan::transmission_ends`].
//!
//! | module | what is in it |
//! |---|---|
//! | [`frame`] | a frame, and how long it takes |
//! | [`timing`] | the timing of bits |
//!
//! Not modelled: extended identifiers, remote frames, loop back, time-outs, the watchdog of the message RAM, the
//! exception of protocol, the pause between transmissions.

mod bus;
mod errors;
mod fifo;
pub mod frame;
mod interrupts;
mod memory;
mod places;
mod receive;
mod registers;
#[cfg(test)]
mod tests;
pub mod timing;
mod transmit;

use crate::device::{Context, Device, RegisterFile};
use crate::facts::Facts;
use errors::Errors;
use fifo::Fifo;
use interrupts::Interrupts;
use places::{FdcanFlags, FdcanOffsets, FdcanSettings, Parts};
use transmit::Requests;

pub use bus::{CanBus, Reception, TransmitOutcome};
pub use frame::DataFrame;

/// The last error was read: RM0440, FDCAN_PSR, LEC.
const NO_CHANGE: u32 = 7;

/// What the message RAM holds before it is written: the real one holds anything.
const UNWRITTEN: u32 = 0xa5c3_5a3c;

/// FDCAN2 with its message RAM.
#[derive(Clone, Debug)]
pub struct Fdcan {
    registers: RegisterFile,
    offsets: FdcanOffsets,
    settings: FdcanSettings,
    flags: FdcanFlags,
    interrupts: Interrupts,
    parts: Parts,
    memory: Vec<u32>,
    bus: CanBus,
    requests: Requests,
    /// The buffers of the transmit FIFO from the oldest request on.
    ring: Fifo,
    receive: [Fifo; 2],
    events: Fifo,
    /// The buffer that is being sent.
    sending: Option<u32>,
    errors: Errors,
    last_error: u32,
    last_data_error: u32,
    /// The flags of PSR about the last frame.
    received_fd: u32,
    joined: bool,
    joins_at: Option<u64>,
    stamp_from: u64,
}

impl Fdcan {
    /// After a reset, on a bus of these rates.
    ///
    /// # Panics
    /// If the facts do not know its registers and its message RAM.
    #[must_use]
    pub fn new(bus: CanBus) -> Self {
        let facts = Facts::chip();
        let (Some(block), Some(memory)) = (facts.block("FDCAN2"), facts.block("FDCANRAM2")) else {
            panic!("the facts have no block FDCAN2 or FDCANRAM2");
        };
        let registers = RegisterFile::new(block);
        let mut fdcan = Self {
            offsets: FdcanOffsets::new(&registers),
            settings: FdcanSettings::new(&registers),
            flags: FdcanFlags::new(&registers),
            interrupts: Interrupts::new(&registers),
            parts: Parts::new(&RegisterFile::new(memory)),
            registers,
            memory: vec![UNWRITTEN; (memory.size / 4) as usize],
            bus,
            requests: Requests::default(),
            ring: Fifo::default(),
            receive: [Fifo::default(); 2],
            events: Fifo::default(),
            sending: None,
            errors: Errors::default(),
            last_error: NO_CHANGE,
            last_data_error: NO_CHANGE,
            received_fd: 0,
            joined: false,
            joins_at: None,
            stamp_from: 0,
        };
        fdcan.reset();
        fdcan
    }

    /// The processor reads a word of the message RAM, by its offset in bytes.
    #[must_use]
    pub fn read_memory(&self, offset: u32) -> u32 {
        let word = self.memory.get((offset / 4) as usize);
        word.copied().unwrap_or_default()
    }

    /// The processor writes a word of the message RAM.
    pub fn write_memory(&mut self, offset: u32, value: u32, context: &mut Context<'_>) {
        let index = (offset / 4) as usize;
        if let Some(within) = index.checked_sub(self.parts.buffers) {
            let buffer = within / memory::ELEMENT;
            if self.requests.pending >> buffer & 1 == 1 {
                context.findings.add(format!(
                    "FDCAN2: transmit buffer {buffer} is written while it waits to be sent"
                ));
            }
        }
        self.store(index, &[value]);
    }

    /// Whether the interrupt lines `FDCAN2_IT0` and `FDCAN2_IT1` are active.
    #[must_use]
    pub fn interrupt_lines(&self) -> [bool; 2] {
        // IE has its bits where IR has them.
        let raised = self.registers.get(self.offsets.ir) & self.registers.get(self.offsets.ie);
        let [first, second] = self.interrupts.lines;
        [(first, false), (second, true)].map(|(enable, chosen)| {
            let mut groups = self.interrupts.groups.iter();
            self.registers.is_set(enable)
                && groups.any(|(mask, line)| {
                    raised & mask != 0 && self.registers.is_set(*line) == chosen
                })
        })
    }

    /// Whether it takes part in the bus.
    #[must_use]
    pub fn takes_part(&self) -> bool {
        self.joined && !self.registers.is_set(self.settings.test)
    }

    /// Whether its settings let it send nothing.
    fn is_silent(&self) -> bool {
        let s = &self.settings;
        self.registers.is_set(s.monitoring) || self.registers.is_set(s.restricted)
    }

    fn store(&mut self, start: usize, words: &[u32]) {
        let places = self.memory.iter_mut().skip(start);
        places.zip(words).for_each(|(place, word)| *place = *word);
    }

    fn raise(&mut self, interrupts: u32) {
        let raised = self.registers.get(self.offsets.ir) | interrupts;
        self.registers.set(self.offsets.ir, raised);
    }

    /// Changes the counters of errors, and raises the interrupts of what follows.
    fn count_errors(&mut self, change: impl FnOnce(&mut Errors)) {
        let before = self.errors;
        change(&mut self.errors);
        let now = self.errors;
        let changes = [
            (
                before.is_warning() != now.is_warning(),
                self.interrupts.warning,
            ),
            (
                before.is_passive() != now.is_passive(),
                self.interrupts.passive,
            ),
            (before.off != now.off, self.interrupts.bus_off),
        ];
        for (_, interrupt) in changes.iter().filter(|(changed, _)| *changed) {
            self.raise(*interrupt);
        }
        if now.off {
            self.registers.set_value(self.settings.init, 1);
            self.leave_bus();
        }
    }

    /// Joins the bus when it is time.
    fn settle(&mut self, context: &Context<'_>) {
        if self.joins_at.is_none_or(|at| context.cycle < at) {
            return;
        }
        self.joins_at = None;
        self.joined = true;
        if self.errors.off {
            let logged = self.errors.logged;
            self.count_errors(|errors| {
                *errors = Errors {
                    logged,
                    ..Errors::default()
                };
            });
        }
    }
}

impl Device for Fdcan {
    /// The message RAM keeps what it holds.
    fn reset(&mut self) {
        self.registers.reset();
        self.leave_bus();
        self.requests = Requests::default();
        self.ring = Fifo::default();
        self.receive = [Fifo::default(); 2];
        self.events = Fifo::default();
        self.errors = Errors::default();
        self.last_error = NO_CHANGE;
        self.last_data_error = NO_CHANGE;
        self.received_fd = 0;
        self.stamp_from = 0;
    }

    fn read(&mut self, offset: u32, context: &mut Context<'_>) -> u32 {
        self.settle(context);
        self.read_register(offset, context)
    }

    fn write(&mut self, offset: u32, value: u32, context: &mut Context<'_>) {
        self.settle(context);
        self.write_register(offset, value, context);
    }

    fn next_event(&self) -> Option<u64> {
        self.joins_at
    }

    fn advance(&mut self, context: &mut Context<'_>) {
        self.settle(context);
    }
}
