//! What happens on the line by itself: characters end, and it falls idle.

use super::line::{sampled, understood};
use super::{Arrival, Lpuart, Sent};
use crate::device::{Context, Device};

impl Lpuart {
    /// Does everything that is due, in its order.
    pub(super) fn settle(&mut self, context: &mut Context<'_>) {
        while let Some(due) = self.next_event().filter(|due| *due <= context.cycle) {
            if self.sending.is_some_and(|(_, end)| end <= due) {
                self.end_sending(due, context);
            } else if self.idle_at.is_some_and(|at| at <= due) {
                self.idle_at = None;
                let starts = |arrival: &Arrival| arrival.start < due;
                if !self.arriving.front().is_some_and(starts) {
                    self.status |= self.flags.idle;
                }
            } else if let Some(arrival) = self.arriving.pop_front() {
                self.arrive(arrival, context);
            }
        }
    }

    /// The stop bit of a sent character ends.
    fn end_sending(&mut self, cycle: u64, context: &mut Context<'_>) {
        if let Some((byte, _)) = self.sending.take() {
            let byte = self.heard(byte, context);
            self.sent.push_back(Sent { byte, cycle });
        }
        self.begin_sending(cycle, context);
        if self.sending.is_none() {
            self.status |= self.flags.complete;
        }
    }

    /// Begins with the next character that waits.
    pub(super) fn begin_sending(&mut self, cycle: u64, context: &mut Context<'_>) {
        if self.sending.is_some() || self.transmits_from.is_none() {
            return;
        }
        let Some(duration) = self.cycles(self.character_bits(), context.clocks) else {
            return;
        };
        if let Some(byte) = self.waiting.pop_front() {
            self.sending = Some((byte, cycle.max(self.line_open) + duration));
        }
    }

    /// What the host makes of a sent byte.
    fn heard(&self, byte: u8, context: &mut Context<'_>) -> u8 {
        let (Some(host), Some(own)) = (self.host_baud, self.baud(context.clocks)) else {
            return byte;
        };
        let (host_bit, own_bit) = (1.0 / f64::from(host), 1.0 / own);
        if understood(own_bit, host_bit) {
            return byte;
        }
        report_rates(own, host, context);
        sampled(byte, own_bit, host_bit).0
    }

    /// A character of the host has arrived.
    fn arrive(&mut self, arrival: Arrival, context: &mut Context<'_>) {
        if !self.is_on(self.receives_from, arrival.start) {
            return;
        }
        let Some(own) = self.baud(context.clocks) else {
            return;
        };
        let mut byte = arrival.byte;
        let (host_bit, own_bit) = (1.0 / f64::from(arrival.baud), 1.0 / own);
        if !understood(host_bit, own_bit) {
            report_rates(own, arrival.baud, context);
            let (wrong, stop) = sampled(byte, host_bit, own_bit);
            byte = wrong;
            self.status |= self.flags.noise;
            if !stop {
                self.status |= self.flags.framing;
            }
        }
        if self.received.len() < self.depth() {
            self.received.push_back(byte);
        } else {
            self.status |= self.flags.overrun;
        }
        let idle = self.cycles(self.character_bits(), context.clocks);
        self.idle_at = idle.map(|cycles| arrival.end + cycles);
    }
}

fn report_rates(own: f64, host: u32, context: &mut Context<'_>) {
    context.findings.add(format!(
        "LPUART1_BRR: it sends and receives at {own:.0} baud, the host at {host} baud"
    ));
}
