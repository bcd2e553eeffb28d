//! What the processor reads and writes.

use super::fifo::Fifo;
use super::transmit::Requests;
use super::{Fdcan, places};
use crate::device::{Context, FieldPlace};

/// Bits of a free bus until a node takes part: ISO 11898-1, after its start and after it was off.
const JOIN_BITS: u64 = 11;
const RECOVERY_BITS: u64 = 129 * 11;

impl Fdcan {
    pub(super) fn read_register(&mut self, offset: u32, context: &mut Context<'_>) -> u32 {
        let o = &self.offsets;
        let f = &self.flags;
        let [first, second] = o.rxfs;
        match offset {
            _ if offset == o.psr => self.read_status(),
            _ if offset == o.ecr => self.read_counters(),
            _ if offset == o.tscv => u32::from(self.stamp(context)),
            _ if offset == first => self.fifo_status(0),
            _ if offset == second => self.fifo_status(1),
            _ if offset == o.txfqs => self.transmit_status(),
            _ if offset == o.txbrp => self.requests.pending,
            _ if offset == o.txbcr => self.requests.cancelling,
            _ if offset == o.txbto => self.requests.done,
            _ if offset == o.txbcf => self.requests.cancelled,
            _ if offset == o.txefs => {
                let places = [f.event_fill, f.event_get, f.event_put, f.event_full];
                let lost = self.registers.get(o.ir) & self.interrupts.event_lost != 0;
                f.event_lost
                    .insert(indices(self.events, places), u32::from(lost))
            }
            _ => self.registers.get(offset),
        }
    }

    fn fifo_status(&self, number: usize) -> u32 {
        let f = &self.flags;
        let fifo = self.receive.get(number).copied().unwrap_or_default();
        let lost = self
            .interrupts
            .lost
            .get(number)
            .copied()
            .unwrap_or_default();
        let lost = self.registers.get(self.offsets.ir) & lost != 0;
        let word = indices(fifo, [f.fill, f.get, f.put, f.full]);
        f.lost.insert(word, u32::from(lost))
    }

    /// PSR; a read forgets the last errors.
    fn read_status(&mut self) -> u32 {
        let f = &self.flags;
        let activity = match (self.takes_part(), self.sending) {
            (false, _) => 0,
            (true, None) => 1,
            (true, Some(_)) => 3,
        };
        let shown = [
            (f.last_error, self.last_error),
            (f.last_data_error, self.last_data_error),
            (f.activity, activity),
            (f.passive, u32::from(self.errors.is_passive())),
            (f.warning, u32::from(self.errors.is_warning())),
            (f.bus_off, u32::from(self.errors.off)),
        ];
        let word = shown.iter().fold(self.received_fd, |word, (field, value)| {
            field.insert(word, *value)
        });
        self.received_fd = 0;
        self.last_error = super::NO_CHANGE;
        self.last_data_error = super::NO_CHANGE;
        word
    }

    /// ECR; a read forgets the logged errors.
    fn read_counters(&mut self) -> u32 {
        let f = &self.flags;
        let errors = self.errors;
        let shown = [
            (f.transmit_errors, errors.transmit.min(0xff)),
            (f.receive_errors, errors.receive.min(0x7f)),
            (f.receive_passive, u32::from(errors.receives_passive())),
            (f.logged_errors, errors.logged),
        ];
        self.errors.logged = 0;
        shown
            .iter()
            .fold(0, |word, (field, value)| field.insert(word, *value))
    }

    pub(super) fn write_register(&mut self, offset: u32, value: u32, context: &mut Context<'_>) {
        let o = &self.offsets;
        let find = |(place, _): &&(u32, &str)| *place == offset;
        if let Some((_, name)) = o.protected.iter().find(find) {
            if self.is_open() {
                self.registers.set(offset, value);
            } else {
                let text = format!("FDCAN2_{name} is written without INIT and CCE");
                context.findings.add(text);
            }
            return;
        }
        let [first, second] = o.rxfa;
        match offset {
            _ if offset == o.cccr => self.write_control(value, context),
            _ if offset == o.test => self.write_test(value, context),
            _ if offset == o.ir => {
                let left = self.registers.get(o.ir) & !value;
                self.registers.set(o.ir, left);
            }
            _ if offset == o.tscv => self.stamp_from = context.cycle,
            _ if offset == first => self.acknowledge(0, value, context),
            _ if offset == second => self.acknowledge(1, value, context),
            _ if offset == o.txefa => {
                let index = self.flags.event_acknowledge.extract(value);
                if !self.events.acknowledge(index) {
                    context.findings.add(format!(
                        "FDCAN2_TXEFA: event {index} is acknowledged, and does not wait"
                    ));
                }
            }
            _ if offset == o.txbar => self.request(value, context),
            _ if offset == o.txbcr => self.cancel(value),
            _ => self.registers.set(offset, value),
        }
    }

    fn acknowledge(&mut self, number: usize, value: u32, context: &mut Context<'_>) {
        let index = self.flags.acknowledge.extract(value);
        let fifo = self.receive.get_mut(number);
        if !fifo.is_some_and(|fifo| fifo.acknowledge(index)) {
            context.findings.add(format!(
                "FDCAN2_RXF{number}A: element {index} is acknowledged, and does not wait"
            ));
        }
    }

    /// Whether protected registers may be written.
    fn is_open(&self) -> bool {
        let places::FdcanSettings { init, change, .. } = self.settings;
        self.registers.is_set(init) && self.registers.is_set(change)
    }

    fn write_test(&mut self, value: u32, context: &mut Context<'_>) {
        if value == self.registers.get(self.offsets.test) {
            return;
        }
        if self.registers.is_set(self.settings.test) {
            self.registers.set(self.offsets.test, value);
        } else {
            context
                .findings
                .add("FDCAN2_TEST is changed while TEST in FDCAN2_CCCR is not set");
        }
    }

    fn write_control(&mut self, value: u32, context: &mut Context<'_>) {
        let old = self.registers.get(self.offsets.cccr);
        let s = &self.settings;
        let had = |field: FieldPlace| old & field.mask != 0;
        let mut new = value;
        let changed = (old ^ new) & s.protected;
        let refused = if self.is_open() {
            0
        } else {
            changed & !(old & s.clearable)
        };
        if refused != 0 {
            context.findings.add(format!(
                "FDCAN2_CCCR: {refused:#06x} is changed without INIT and CCE"
            ));
            new ^= refused;
        }
        if new & s.change.mask != 0 && !had(s.init) {
            context
                .findings
                .add("FDCAN2_CCCR: CCE is set before INIT was");
            new &= !s.change.mask;
        }
        new &= !s.stopped.mask;
        if new & s.stop_request.mask != 0 {
            new |= s.stopped.mask | s.init.mask;
        }
        let begins = had(s.init) && new & s.init.mask == 0;
        if begins {
            new &= !s.change.mask;
        }
        let opens = new & s.change.mask != 0 && !had(s.change);
        self.registers.set(self.offsets.cccr, new);
        if new & self.settings.init.mask != 0 {
            self.leave_bus();
        }
        if opens {
            self.forget_messages();
        }
        if begins {
            self.join_bus(context);
        }
    }

    /// What CCE clears when it is set: RM0440, FDCAN software initialisation.
    fn forget_messages(&mut self) {
        self.requests = Requests::default();
        self.ring = Fifo::default();
        self.events = Fifo::default();
        self.receive = [Fifo::default(); 2];
        self.registers.set(self.offsets.hpms, 0);
    }

    pub(super) fn leave_bus(&mut self) {
        self.joined = false;
        self.joins_at = None;
        self.sending = None;
    }

    fn join_bus(&mut self, context: &mut Context<'_>) {
        let count = if self.errors.off {
            RECOVERY_BITS
        } else {
            JOIN_BITS
        };
        let bits = self.bits(count, context.clocks);
        if bits.is_none() {
            context
                .findings
                .add("FDCAN2_CCCR: INIT is cleared while the block has no clock");
        }
        self.joins_at = bits.map(|bits| context.cycle + bits);
    }
}

/// The indices of a FIFO: fill level, get, put, full.
fn indices(fifo: Fifo, [fill, get, put, full]: [FieldPlace; 4]) -> u32 {
    let word = fill.insert(0, fifo.fill);
    let word = get.insert(word, fifo.get);
    let word = put.insert(word, fifo.put());
    full.insert(word, u32::from(fifo.is_full()))
}
