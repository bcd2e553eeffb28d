//! LPUART1: the serial line to the host.
//!
//! A character takes its ten bits at the rate that BRR, PRESC and the clock give; the host's characters take theirs at
//! the host's rate. Where these differ, the receiver samples what it does not understand, and that is a finding.
//!
//! Not modelled: parity, half duplex, flow control, DMA, wake-up, character match, breaks, inverted levels.

mod line;
mod places;
mod registers;
#[cfg(test)]
mod tests;
mod traffic;

use crate::clocks::Clocks;
use crate::device::{Context, Device, RegisterFile};
use crate::facts::Facts;
use line::CHARACTER_BITS;
use places::{LpuartFlags, LpuartOffsets, LpuartSettings};
use std::collections::VecDeque;

/// Characters in a FIFO: RM0440, LPUART implementation; without FIFO it is one.
const FIFO: usize = 8;

/// Divisors of the clock: RM0440, LPUART_PRESC.
const PRESCALERS: [u64; 12] = [1, 2, 4, 6, 8, 10, 12, 16, 32, 64, 128, 256];

/// What BRR may be: RM0440, LPUART_BRR; ST's own driver has the same limits.
const BRR_LIMITS: std::ops::RangeInclusive<u32> = 0x300..=0xf_ffff;

/// A byte that the chip sent.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Sent {
    /// What the host receives.
    pub byte: u8,
    /// The cycle in which its stop bit ended.
    pub cycle: u64,
}

/// A byte on its way to the chip.
#[derive(Clone, Copy, Debug)]
struct Arrival {
    byte: u8,
    baud: u32,
    start: u64,
    end: u64,
}

/// LPUART1.
#[derive(Clone, Debug)]
pub struct Lpuart {
    registers: RegisterFile,
    offsets: LpuartOffsets,
    settings: LpuartSettings,
    flags: LpuartFlags,
    /// The flags that stay until they are cleared.
    status: u32,
    received: VecDeque<u8>,
    waiting: VecDeque<u8>,
    /// What is being sent, and the cycle in which that ends.
    sending: Option<(u8, u64)>,
    /// Since these cycles transmitter and receiver work; none while they are off.
    transmits_from: Option<u64>,
    receives_from: Option<u64>,
    /// Transmitted characters begin after the idle one that opens the line.
    line_open: u64,
    /// When the line counts as idle.
    idle_at: Option<u64>,
    arriving: VecDeque<Arrival>,
    host_baud: Option<u32>,
    sent: VecDeque<Sent>,
}

impl Default for Lpuart {
    fn default() -> Self {
        Self::new()
    }
}

impl Lpuart {
    /// After a reset, nobody at the other end.
    ///
    /// # Panics
    /// If the facts do not know its registers.
    #[must_use]
    pub fn new() -> Self {
        let Some(block) = Facts::chip().block("LPUART1") else {
            panic!("the facts have no block LPUART1");
        };
        let registers = RegisterFile::new(block);
        let mut lpuart = Self {
            offsets: LpuartOffsets::new(&registers),
            settings: LpuartSettings::new(&registers),
            flags: LpuartFlags::new(&registers),
            registers,
            status: 0,
            received: VecDeque::new(),
            waiting: VecDeque::new(),
            sending: None,
            transmits_from: None,
            receives_from: None,
            line_open: 0,
            idle_at: None,
            arriving: VecDeque::new(),
            host_baud: None,
            sent: VecDeque::new(),
        };
        lpuart.reset();
        lpuart
    }

    /// The rate at which the host listens.
    pub fn set_host_baud(&mut self, baud: u32) {
        self.host_baud = (baud > 0).then_some(baud);
    }

    /// The host sends a byte at its own rate, after those that it sends already.
    pub fn host_send(&mut self, byte: u8, baud: u32, context: &mut Context<'_>) {
        self.set_host_baud(baud);
        let Some(duration) = context.clocks.cycles(CHARACTER_BITS, baud) else {
            return;
        };
        let before = self.arriving.back().map_or(0, |arrival| arrival.end);
        let start = context.cycle.max(before);
        let end = start + duration;
        self.arriving.push_back(Arrival {
            byte,
            baud,
            start,
            end,
        });
    }

    /// Whether it receives what is sent from now on.
    #[must_use]
    pub fn listens(&self, cycle: u64) -> bool {
        self.receives_from.is_some_and(|from| cycle >= from)
    }

    /// The next byte that the host received.
    pub fn host_receive(&mut self) -> Option<Sent> {
        self.sent.pop_front()
    }

    /// Whether the interrupt line `LPUART1` is active.
    #[must_use]
    pub fn interrupt(&self) -> bool {
        // The flags that depend on the cycle raise none.
        let status = self.isr(0);
        let control = [self.offsets.cr1, self.offsets.cr2, self.offsets.cr3];
        let control = control.map(|offset| self.registers.get(offset));
        self.flags.interrupts.iter().any(|(flag, number, enable)| {
            let word = control.get(*number).copied().unwrap_or_default();
            status & flag != 0 && word & enable != 0
        })
    }

    /// The rate at which it sends and receives, baud; none where the settings give none.
    #[must_use]
    pub fn baud(&self, clocks: &Clocks) -> Option<f64> {
        let divisor = self.divisor()? as f64;
        (clocks.lpuart1 > 0).then(|| f64::from(clocks.lpuart1) * 256.0 / divisor)
    }

    /// 256 periods of the clock in this number are a bit.
    fn divisor(&self) -> Option<u64> {
        let brr = self.registers.get(self.offsets.brr);
        let prescaler = self.registers.value(self.settings.prescaler) as usize;
        let prescaler = PRESCALERS.get(prescaler)?;
        BRR_LIMITS
            .contains(&brr)
            .then(|| u64::from(brr) * prescaler)
    }

    /// Cycles of a number of bits.
    fn cycles(&self, bits: u64, clocks: &Clocks) -> Option<u64> {
        let periods = self.divisor()? * bits;
        let all = periods * u64::from(clocks.hclk);
        (clocks.lpuart1 > 0).then(|| all.div_ceil(256 * u64::from(clocks.lpuart1)))
    }

    fn is_on(&self, from: Option<u64>, cycle: u64) -> bool {
        from.is_some_and(|from| from <= cycle)
    }

    fn depth(&self) -> usize {
        if self.registers.is_set(self.settings.fifo) {
            FIFO
        } else {
            1
        }
    }
}

impl Device for Lpuart {
    fn reset(&mut self) {
        self.registers.reset();
        // All other flags of ISR are computed.
        self.status = self.flags.complete;
        self.received.clear();
        self.waiting.clear();
        self.sending = None;
        self.transmits_from = None;
        self.receives_from = None;
        self.idle_at = None;
    }

    fn read(&mut self, offset: u32, context: &mut Context<'_>) -> u32 {
        self.settle(context);
        match offset {
            _ if offset == self.offsets.isr => self.isr(context.cycle),
            _ if offset == self.offsets.rdr => self.take_received(context),
            _ => self.registers.get(offset),
        }
    }

    fn write(&mut self, offset: u32, value: u32, context: &mut Context<'_>) {
        self.settle(context);
        self.write_register(offset, value, context);
    }

    fn next_event(&self) -> Option<u64> {
        let sending = self.sending.map(|(_, end)| end);
        let arriving = self.arriving.front().map(|arrival| arrival.end);
        [sending, arriving, self.idle_at]
            .into_iter()
            .flatten()
            .min()
    }

    fn advance(&mut self, context: &mut Context<'_>) {
        self.settle(context);
    }
}
