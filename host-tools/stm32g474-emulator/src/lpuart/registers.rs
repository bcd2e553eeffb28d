//! What the processor reads and writes.

use super::{BRR_LIMITS, Lpuart};
use crate::device::Context;

/// Marks of the FIFOs, characters: RM0440, LPUART_CR3, RXFTCFG and TXFTCFG; ST's own driver has the same.
const THRESHOLDS: [usize; 6] = [1, 2, 4, 6, 7, 8];

impl Lpuart {
    /// ISR at a cycle.
    pub(super) fn isr(&self, cycle: u64) -> u32 {
        let depth = self.depth();
        let fifo = self.registers.is_set(self.settings.fifo);
        let space = depth.saturating_sub(self.waiting.len());
        let mark = |field| {
            let number = self.registers.value(field) as usize;
            THRESHOLDS.get(number).copied().unwrap_or(usize::MAX)
        };
        let receiving = |arrival: &super::Arrival| arrival.start <= cycle;
        let f = &self.flags;
        let shown = [
            (f.received, !self.received.is_empty()),
            (f.space, space > 0),
            (
                f.busy,
                self.is_on(self.receives_from, cycle)
                    && self.arriving.front().is_some_and(receiving),
            ),
            (f.transmit_ready, self.is_on(self.transmits_from, cycle)),
            (f.receive_ready, self.is_on(self.receives_from, cycle)),
            (f.transmit_empty, fifo && self.waiting.is_empty()),
            (f.receive_full, fifo && self.received.len() >= depth),
            (
                f.receive_threshold,
                fifo && self.received.len() >= mark(self.settings.receive_threshold),
            ),
            (
                f.transmit_threshold,
                fifo && space >= mark(self.settings.transmit_threshold),
            ),
        ];
        shown
            .iter()
            .filter(|(_, is_set)| *is_set)
            .fold(self.status, |word, (flag, _)| word | flag)
    }

    /// RDR is read.
    pub(super) fn take_received(&mut self, context: &mut Context<'_>) -> u32 {
        let Some(byte) = self.received.pop_front() else {
            context
                .findings
                .add("LPUART1_RDR is read while nothing has been received");
            return 0;
        };
        u32::from(byte)
    }

    pub(super) fn write_register(&mut self, offset: u32, value: u32, context: &mut Context<'_>) {
        match offset {
            _ if offset == self.offsets.cr1 => self.write_control(value, context),
            _ if offset == self.offsets.cr2 => self.write_fixed(1, "CR2", offset, value, context),
            _ if offset == self.offsets.cr3 => self.write_fixed(2, "CR3", offset, value, context),
            _ if offset == self.offsets.brr || offset == self.offsets.presc => {
                self.write_rate(offset, value, context);
            }
            _ if offset == self.offsets.icr => self.clear(value),
            _ if offset == self.offsets.rqr => self.request(value, context),
            _ if offset == self.offsets.tdr => self.transmit(value, context),
            _ => self.registers.set(offset, value),
        }
    }

    /// Sets a control register; what must not change while the block works is a finding.
    fn write_fixed(
        &mut self,
        number: usize,
        name: &str,
        offset: u32,
        value: u32,
        context: &mut Context<'_>,
    ) {
        let fixed = self.settings.fixed.get(number).copied().unwrap_or_default();
        let changed = (value ^ self.registers.get(offset)) & fixed;
        let mut value = value;
        if changed != 0 && self.registers.is_set(self.settings.enable) {
            context.findings.add(format!(
                "LPUART1_{name}: {changed:#010x} is changed while UE is set, and has no effect"
            ));
            value ^= changed;
        }
        self.registers.set(offset, value);
    }

    fn write_control(&mut self, value: u32, context: &mut Context<'_>) {
        self.write_fixed(0, "CR1", self.offsets.cr1, value, context);
        let enabled = self.registers.is_set(self.settings.enable);
        let s = &self.settings;
        let odd_length = [s.parity, s.length_0, s.length_1];
        if enabled && odd_length.iter().any(|bit| self.registers.is_set(*bit)) {
            context
                .findings
                .add("LPUART1_CR1: characters are not of 8 bits without parity, as the host's are");
        }
        let transmits = enabled && self.registers.is_set(self.settings.transmit);
        let receives = enabled && self.registers.is_set(self.settings.receive);
        // That it takes a bit until TE and RE are acknowledged is a guess; the manual says only that it takes time.
        let bit = self.cycles(1, context.clocks).unwrap_or_default();
        let ready = context.cycle + bit;
        if (transmits || receives) && self.divisor().is_none() {
            let brr = self.registers.get(self.offsets.brr);
            context.findings.add(format!(
                "LPUART1_BRR is {brr:#x} where TE or RE is set, outside of {:#x} to {:#x}",
                BRR_LIMITS.start(),
                BRR_LIMITS.end()
            ));
        }
        if !transmits {
            self.transmits_from = None;
        } else if self.transmits_from.is_none() {
            self.transmits_from = Some(ready);
            let idle = self.cycles(self.character_bits(), context.clocks);
            self.line_open = ready + idle.unwrap_or_default();
        }
        if !receives {
            self.receives_from = None;
            self.idle_at = None;
        } else if self.receives_from.is_none() {
            self.receives_from = Some(ready);
        }
        if !enabled {
            self.received.clear();
            self.waiting.clear();
            self.sending = None;
            self.status = self.flags.complete;
        }
        self.begin_sending(context.cycle, context);
    }

    fn write_rate(&mut self, offset: u32, value: u32, context: &mut Context<'_>) {
        if self.registers.is_set(self.settings.enable) {
            context
                .findings
                .add("LPUART1_BRR or LPUART1_PRESC is written while UE is set, and has no effect");
            return;
        }
        if offset == self.offsets.brr && !BRR_LIMITS.contains(&value) {
            context.findings.add(format!(
                "LPUART1_BRR: {value:#x} is outside of {:#x} to {:#x}",
                BRR_LIMITS.start(),
                BRR_LIMITS.end()
            ));
        }
        self.registers.set(offset, value);
    }

    fn clear(&mut self, value: u32) {
        for (flag, clear) in &self.flags.clears {
            if value & clear != 0 {
                self.status &= !flag;
            }
        }
    }

    fn request(&mut self, value: u32, context: &mut Context<'_>) {
        let s = &self.settings;
        if value & s.flush_received.mask != 0 {
            self.received.clear();
        }
        if value & s.flush_transmit.mask != 0 {
            self.waiting.clear();
        }
        if value & !(s.flush_received.mask | s.flush_transmit.mask) != 0 {
            context.findings.add(format!(
                "LPUART1_RQR: {value:#x} asks for what the emulator has not"
            ));
        }
    }

    fn transmit(&mut self, value: u32, context: &mut Context<'_>) {
        if self.transmits_from.is_none() {
            context
                .findings
                .add("LPUART1_TDR is written while the transmitter is off");
            return;
        }
        if self.waiting.len() >= self.depth() {
            context
                .findings
                .add("LPUART1_TDR is written while there is no space, and a byte is lost");
            return;
        }
        self.status &= !self.flags.complete;
        self.waiting.push_back(value.to_le_bytes()[0]);
        self.begin_sending(context.cycle, context);
    }

    /// Bits of a character: start, data, stop.
    pub(super) fn character_bits(&self) -> u64 {
        let long = u64::from(self.registers.is_set(self.settings.length_0));
        let short = u64::from(self.registers.is_set(self.settings.length_1));
        // RM0440, LPUART_CR2, STOP: 2 is two stop bits, 0 is one.
        let stops = if self.registers.value(self.settings.stop) == 2 {
            2
        } else {
            1
        };
        (1 + 8 + long + stops).saturating_sub(short)
    }
}
