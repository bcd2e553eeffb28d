//! From the transmit buffers to the bus.

use super::errors::Kind;
use super::fifo::DEPTH;
use super::frame::DataFrame;
use super::memory::{self, Buffer, ELEMENT, EVENT};
use super::{Fdcan, TransmitOutcome};
use crate::device::Context;

/// What the requests and their ends look like to the processor, a bit for each buffer.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Requests {
    /// Waiting, or being sent.
    pub pending: u32,
    /// Sent.
    pub done: u32,
    /// To be given up when the attempt that runs has ended.
    pub cancelling: u32,
    /// Given up.
    pub cancelled: u32,
}

impl Fdcan {
    /// TXFQS.
    pub(super) fn transmit_status(&self) -> u32 {
        let f = &self.flags;
        let (free, get, put, full) = if self.is_queue() {
            let put = (0..DEPTH).find(|index| self.requests.pending >> index & 1 == 0);
            (0, 0, put.unwrap_or_default(), put.is_none())
        } else {
            let ring = self.ring;
            (DEPTH - ring.fill, ring.get, ring.put(), ring.is_full())
        };
        let word = f.transmit_free.insert(0, free);
        let word = f.transmit_get.insert(word, get);
        let word = f.transmit_put.insert(word, put);
        f.transmit_full.insert(word, u32::from(full))
    }

    fn is_queue(&self) -> bool {
        self.registers.is_set(self.settings.queue)
    }

    /// TXBAR is written.
    pub(super) fn request(&mut self, value: u32, context: &mut Context<'_>) {
        let first = self.ring.put();
        for index in (first..first + DEPTH).map(|index| index % DEPTH) {
            let bit = 1 << index;
            if value & bit == 0 {
                continue;
            }
            let why = if self.registers.is_set(self.settings.change) {
                Some("while CCE is set")
            } else if self.requests.pending & bit != 0 {
                Some("while it waits already")
            } else if !self.is_queue() && (self.ring.is_full() || index != self.ring.put()) {
                Some("out of the order of the FIFO")
            } else {
                None
            };
            if let Some(why) = why {
                context
                    .findings
                    .add(format!("FDCAN2_TXBAR: buffer {index} is requested {why}"));
                continue;
            }
            if !self.is_queue() {
                self.ring.fill += 1;
            }
            self.requests.pending |= bit;
            self.requests.done &= !bit;
            self.requests.cancelled &= !bit;
        }
    }

    /// TXBCR is written.
    pub(super) fn cancel(&mut self, value: u32) {
        for index in 0..DEPTH {
            let bit = 1 << index;
            if value & bit == 0 {
                continue;
            }
            if self.sending == Some(index) {
                self.requests.cancelling |= bit;
            } else {
                self.give_up(bit);
            }
        }
        self.drain();
    }

    fn give_up(&mut self, bit: u32) {
        self.requests.pending &= !bit;
        self.requests.cancelling &= !bit;
        self.requests.cancelled |= bit;
        if self.registers.get(self.offsets.txbcie) & bit != 0 {
            self.raise(self.interrupts.cancelled);
        }
    }

    /// Lets the FIFO go on to the oldest buffer that waits.
    fn drain(&mut self) {
        let before = self.ring.fill;
        while self.ring.fill > 0 && self.requests.pending >> self.ring.get & 1 == 0 {
            self.ring.get = (self.ring.get + 1) % DEPTH;
            self.ring.fill -= 1;
        }
        if before > 0 && self.ring.fill == 0 {
            self.raise(self.interrupts.transmit_empty);
        }
    }

    /// The buffer that is sent next.
    fn next_buffer(&self) -> Option<(u32, Buffer)> {
        let can_send = self.takes_part() && !self.is_silent() && self.sending.is_none();
        if !can_send {
            return None;
        }
        let waiting = (0..DEPTH).filter(|index| self.requests.pending >> index & 1 == 1);
        if self.is_queue() {
            let buffers = waiting.map(|index| (index, self.buffer(index)));
            buffers.min_by_key(|(_, buffer)| buffer.head[0])
        } else {
            let mut waiting = waiting.filter(|index| *index == self.ring.get);
            waiting.next().map(|index| (index, self.buffer(index)))
        }
    }

    fn buffer(&self, index: u32) -> Buffer {
        let start = self.parts.buffers + index as usize * ELEMENT;
        memory::buffer(self.memory.get(start..).unwrap_or_default())
    }

    /// The identifier of the frame that it would send now, for the arbitration; none where it would send nothing.
    #[must_use]
    pub fn wants(&self) -> Option<u16> {
        self.next_buffer().map(|(_, buffer)| buffer.identifier)
    }

    /// Begins to send, where it won the arbitration: the frame, which the bus carries for [`DataFrame::duration_ns`] and
    /// ends by [`Self::transmission_ends`].
    pub fn take_transmission(&mut self, context: &mut Context<'_>) -> Option<DataFrame> {
        let (index, buffer) = self.next_buffer()?;
        if buffer.unknown {
            context.findings.add(format!(
                "FDCAN2: buffer {index} asks for an extended identifier or a remote frame, which this bus has not"
            ));
            self.give_up(1 << index);
            self.drain();
            return None;
        }
        let fd = self.allowed(buffer.fd, self.settings.fd, "FDOE", context);
        let switch = self.allowed(buffer.switch && fd, self.settings.switch, "BRSE", context);
        let [nominal_hz, data_hz] = self.rates(context.clocks);
        let mut payload = buffer.payload;
        payload.truncate(if fd { payload.len() } else { 8 });
        let frame = DataFrame {
            identifier: buffer.identifier,
            fd,
            bit_rate_switch: switch,
            payload,
            nominal_hz,
            data_hz,
        };
        self.check_own(&frame, context);
        self.sending = Some(index);
        Some(frame)
    }

    /// Whether what a buffer asks for is allowed by CCCR.
    fn allowed(
        &self,
        asked: bool,
        by: crate::device::FieldPlace,
        name: &str,
        context: &mut Context<'_>,
    ) -> bool {
        let is_set = self.registers.is_set(by);
        if asked && !is_set {
            context.findings.add(format!(
                "FDCAN2_CCCR: {name} is not set, and a buffer asks for it"
            ));
        }
        asked && is_set
    }

    /// The frame that it sent has ended.
    pub fn transmission_ends(&mut self, outcome: TransmitOutcome, context: &mut Context<'_>) {
        let Some(index) = self.sending.take() else {
            return;
        };
        let bit = 1 << index;
        match outcome {
            TransmitOutcome::Acknowledged => self.sent(index, context),
            TransmitOutcome::Unacknowledged => self.failed(bit, Kind::Acknowledge),
            TransmitOutcome::Disturbed => self.failed(bit, Kind::Bit1),
        }
        if self.requests.cancelling & bit != 0 {
            self.give_up(bit);
        }
        self.drain();
    }

    fn sent(&mut self, index: u32, context: &mut Context<'_>) {
        let bit = 1 << index;
        self.requests.pending &= !bit;
        self.requests.done |= bit;
        self.last_error = 0;
        self.count_errors(|errors| errors.sent());
        // The flag is only raised where TXBTIE lets it.
        if self.registers.get(self.offsets.txbtie) & bit != 0 {
            self.raise(self.interrupts.complete);
        }
        let buffer = self.buffer(index);
        if buffer.store_event {
            self.store_event(&buffer, context);
        }
    }

    fn failed(&mut self, bit: u32, kind: Kind) {
        self.last_error = kind as u32;
        self.raise(self.interrupts.arbitration_error);
        self.count_errors(|errors| errors.transmission_failed(kind));
        if self.registers.is_set(self.settings.no_retry) {
            self.give_up(bit);
        }
    }

    fn store_event(&mut self, buffer: &Buffer, context: &mut Context<'_>) {
        let Some(place) = self.events.push(false) else {
            self.raise(self.interrupts.event_lost);
            return;
        };
        // The second word has the marker, format and length of the buffer, event type 1, and the time.
        let second = buffer.head[1] & 0xff3f_0000 | 1 << 22 | u32::from(self.stamp(context));
        let start = self.parts.events + place as usize * EVENT;
        self.store(start, &[buffer.head[0], second]);
        self.raise(self.interrupts.event_new);
        if self.events.is_full() {
            self.raise(self.interrupts.event_full);
        }
    }
}
