//! Interrupts that nobody serves: without a handler, masked for good, or with a cause that the handler does not end.

use crate::facts::Facts;
use crate::findings::Findings;
use crate::image::Image;
use crate::memory_map::FLASH;
use crate::processor::{FIRST_INTERRUPT, Processor};

/// What cortex-m-rt puts into the vectors of interrupts without a handler.
const NO_HANDLER: &str = "DefaultHandler";

/// Interrupts that the vector table may have: as many as a word of levels.
const INTERRUPTS: u32 = u128::BITS;

/// A line that is high for as long stays so, cycles: 10 ms of 170 MHz. The tick holds the others off for 0.1 ms at most, and
/// until the program has set up an interrupt that it already asks for, less passes, too.
pub const STEADY_CYCLES: u64 = 1_700_000;

/// What is known of the lines.
#[derive(Clone, Debug, Default)]
pub struct Unserved {
    /// Interrupts without a handler, bit by number.
    without_handler: u128,
    /// Lines that were high at every look since the last end.
    steady: u128,
    end: u64,
}

impl Unserved {
    /// By the vectors of an image.
    pub fn new(image: &Image) -> Self {
        let bytes = |address: u32| {
            let at = address.checked_sub(FLASH.start)? as usize;
            image.flash.get(at..at + 4)?.try_into().ok()
        };
        let vector = |number| bytes(FLASH.start + 4 * (u32::from(FIRST_INTERRUPT) + number));
        let none = image.symbol(NO_HANDLER).map(u32::to_le_bytes);
        let without = (0..INTERRUPTS).filter(|&number| none.is_some() && vector(number) == none);
        Self {
            without_handler: without.fold(0, |all, number| all | 1 << number),
            ..Self::default()
        }
    }

    /// Forgets how long the lines have been high: after a reset or a halt.
    pub fn restart(&mut self, cycle: u64) {
        self.steady = 0;
        self.end = cycle + STEADY_CYCLES;
    }

    /// Looks at the exception in progress, and at the lines as they are now; to be called at each change of a line.
    pub fn look(
        &mut self,
        processor: &Processor,
        (cycle, levels): (u64, u128),
        findings: &mut Findings,
    ) {
        let handled = processor.place().exception.checked_sub(FIRST_INTERRUPT);
        if let Some(number) = handled.filter(|at| self.without_handler >> at & 1 == 1) {
            let text = format!("the interrupt {} comes, and has no handler", name(number));
            findings.add(text);
        }
        self.steady &= levels;
        if cycle < self.end {
            return;
        }
        let mut left = self.steady;
        while left != 0 {
            let number = left.trailing_zeros() as u16;
            let why = if processor.lets_through(number) {
                "its handler does not end its cause, or does not come"
            } else {
                "the program asks for it, and has not enabled it"
            };
            let text = format!("the interrupt {} stays pending: {why}", name(number));
            findings.add(text);
            left &= left - 1;
        }
        self.steady = levels;
        self.end = cycle + STEADY_CYCLES;
    }
}

fn name(number: u16) -> &'static str {
    Facts::chip()
        .interrupt_name(number)
        .unwrap_or("without a name")
}
