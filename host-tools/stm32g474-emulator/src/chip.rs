//! The chip: processor, memories and peripherals in step.

mod coupling;
mod supply;
mod unserved;

use crate::board::Board;
use crate::bus::{BusShared, lock};
use crate::devices::SystemBreak;
use crate::facts::Facts;
use crate::findings::Findings;
use crate::image::Image;
use crate::memory_map::FLASH;
use crate::peripherals::Peripherals;
use crate::processor::{FIRST_INTERRUPT, MapError, Processor, ProgramPlace};
use crate::rcc::ResetFlag;
use coupling::{Coupled, couple};
use std::sync::atomic::Ordering;
use std::sync::{Arc, Mutex, MutexGuard};
use unserved::Unserved;

/// Why a chip stopped running.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stop {
    /// The pulse timer has come to its update.
    Update,
    /// ADC1 or ADC2 raises its interrupt, with which a tick begins.
    Converted,
    /// The program is at the first instruction of a watched function.
    Watched,
    /// The time is over.
    Time,
    /// The processor has locked up: a fault within a fault. Only a reset ends that; until then time passes.
    LockedUp,
    /// The chip was reset, and starts again.
    Reset(ResetFlag),
}

/// A chip on a board.
pub struct Chip {
    watched: Vec<u32>,
    watching: bool,
    /// The interrupt of ADC1 and ADC2.
    converted: u16,
    processor: Processor,
    peripherals: Arc<Mutex<Peripherals>>,
    shared: Arc<BusShared>,
    cycle: u64,
    next_event: u64,
    /// Whether the counter of cycles goes on while the processor sleeps.
    counts_asleep: bool,
    /// It is known that the processor has locked up.
    locked_up: bool,
    /// The cycle until which the processor waits for the flash.
    waits_until: u64,
    unserved: Unserved,
    /// The pages of the CCM that SYSCFG_SWPR protects, bit by number, and what the CCM held when it began to.
    protected: (u32, Vec<u8>),
    /// The cycle of the last reset, and where the program and its stack were then.
    before_reset: Option<(u64, ProgramPlace, u32)>,
}

/// The longest from one look at the processor to the next, for a lock-up or a request for a reset, cycles: 0.1 ms.
const LOOK_CYCLES: u64 = 17_000;

/// A page of the CCM, as SYSCFG_SWPR protects them, bytes: RM0440, SYSCFG_SWPR, of which a chip with 32 KiB has all 32.
const CCM_PAGE: usize = 1_024;

impl Chip {
    /// A chip that is about to start after a power-up.
    ///
    /// # Errors
    /// [`MapError`]: a fault of this program.
    pub fn new(image: &Image, board: &Board) -> Result<Self, MapError> {
        let mut peripherals = Peripherals::new(board);
        peripherals.devices.flash.load(FLASH.start, &image.flash);
        peripherals.devices.flash.set_program(image.program());
        if board.records_writes {
            peripherals.checks.record();
        }
        let Coupled {
            mut processor,
            peripherals,
            shared,
        } = couple(image, peripherals)?;
        processor.scramble_ram(board.seed);
        Ok(Self {
            processor,
            peripherals,
            shared,
            cycle: 0,
            next_event: 0,
            counts_asleep: false,
            locked_up: false,
            waits_until: 0,
            unserved: Unserved::new(image),
            protected: (0, Vec::new()),
            before_reset: None,
            watched: Vec::new(),
            watching: false,
            converted: Facts::chip().interrupt("ADC1_2").unwrap_or_default(),
        })
    }

    /// The same chip once more, with the same image: what happens to one does not happen to the other.
    ///
    /// # Errors
    /// [`MapError`]: a fault of this program.
    pub fn copy(&self, image: &Image) -> Result<Self, MapError> {
        let Coupled {
            mut processor,
            peripherals,
            shared,
        } = couple(image, lock(&self.peripherals).clone())?;
        processor.continue_from(&self.processor)?;
        shared.cycle.store(self.cycle, Ordering::Relaxed);
        // At worst the peripherals are asked once more.
        shared.accessed.store(true, Ordering::Relaxed);
        Ok(Self {
            processor,
            peripherals,
            shared,
            watched: self.watched.clone(),
            unserved: self.unserved.clone(),
            protected: self.protected.clone(),
            ..*self
        })
    }

    /// The peripherals. What is changed there takes effect with the next instruction.
    pub fn peripherals(&self) -> MutexGuard<'_, Peripherals> {
        self.shared.accessed.store(true, Ordering::Relaxed);
        let mut peripherals = lock(&self.peripherals);
        peripherals.set_cycle(self.cycle);
        peripherals
    }

    /// Where the program is, and its stack pointer; just after a reset, where they were before it.
    #[must_use]
    pub fn place(&self) -> (ProgramPlace, u32) {
        let reset = self.before_reset.filter(|(at, ..)| *at == self.cycle);
        let now = || (self.processor.place(), self.processor.stack_pointer());
        reset.map_or_else(now, |(_, place, stack)| (place, stack))
    }

    /// Reports a page of the CCM that was written although SYSCFG_SWPR protects it.
    pub fn check_protected(&self) {
        self.find_written_page(&mut self.peripherals().findings);
    }

    fn find_written_page(&self, findings: &mut Findings) {
        let (pages, before) = &self.protected;
        let now = self.processor.ccm();
        let both = now.chunks(CCM_PAGE).zip(before.chunks(CCM_PAGE));
        let mut changed = both.enumerate().filter(|(_, (now, before))| now != before);
        if let Some((page, _)) = changed.find(|(page, _)| pages >> page & 1 == 1) {
            findings.add(format!(
                "page {page} of the CCM is written, which SYSCFG_SWPR protects: the chip keeps what was there"
            ));
        }
    }

    /// The processor.
    pub fn processor(&self) -> &Processor {
        &self.processor
    }

    /// Cycles since the power-up.
    #[must_use]
    pub fn cycle(&self) -> u64 {
        self.cycle
    }

    /// Sets bytes of the flash, as a programmer does.
    pub fn load_flash(&mut self, address: u32, bytes: &[u8]) {
        lock(&self.peripherals).devices.flash.load(address, bytes);
    }

    /// Sets a word of RAM or CCM, as a debugger does; false where neither is.
    pub fn set_word(&mut self, address: u32, word: u32) -> bool {
        self.processor.set_word(address, word)
    }

    /// Lets [`Self::run`] stop at the first instruction of these functions.
    pub fn watch(&mut self, functions: Vec<u32>) {
        self.watched = functions;
    }

    /// Runs until something of interest happens, or to a cycle.
    pub fn run(&mut self, end: u64) -> Stop {
        while self.cycle < end {
            if let Some(stop) = self.step(end) {
                return stop;
            }
        }
        Stop::Time
    }

    /// One instruction, or sleep up to a cycle.
    #[inline]
    pub fn step(&mut self, end: u64) -> Option<Stop> {
        let accessed = self.shared.accessed.load(Ordering::Relaxed);
        if (accessed || self.cycle >= self.next_event)
            && let Some(stop) = self.service()
        {
            return Some(stop);
        }
        if self.cycle < self.waits_until {
            self.wait_until(self.next_event.min(end).min(self.waits_until));
            return None;
        }
        if self.locked_up || self.processor.sleeps() {
            self.sleep_until(self.next_event.min(end));
            return None;
        }
        self.cycle += self.processor.step();
        self.shared.cycle.store(self.cycle, Ordering::Relaxed);
        let stops = self.watching && self.watched.contains(&self.processor.pc());
        stops.then_some(Stop::Watched)
    }

    /// Holds the processor for some cycles while everything else goes on, as a bus that does not answer does; what
    /// happens meanwhile.
    pub fn hold_processor(&mut self, cycles: u64) -> Option<Stop> {
        let end = self.cycle + cycles;
        while self.cycle < end {
            if let Some(stop) = self.service() {
                return Some(stop);
            }
            self.wait_until(self.next_event.min(end));
        }
        None
    }

    /// A debugger halts the processor for some cycles, and the watchdogs that DBGMCU tells to; what happens meanwhile.
    ///
    /// Not modelled: timers that stand still. Their updates are no event of the halt.
    pub fn halt_by_debugger(&mut self, cycles: u64) -> Option<Stop> {
        let end = self.cycle + cycles;
        while self.cycle < end {
            let before = self.cycle;
            let happened = self.service();
            if matches!(happened, Some(Stop::Reset(_))) {
                return happened;
            }
            self.wait_until(self.next_event.min(end));
            let mut peripherals = lock(&self.peripherals);
            peripherals.devices.halt_watchdogs(self.cycle - before);
            self.next_event = self.cycle;
            self.unserved.restart(self.cycle);
        }
        None
    }

    /// The processor waits in the midst of an access.
    fn wait_until(&mut self, cycle: u64) {
        let passed = cycle.saturating_sub(self.cycle).max(1);
        self.processor.count_asleep(passed);
        self.cycle += passed;
        self.shared.cycle.store(self.cycle, Ordering::Relaxed);
    }

    /// Whether [`Self::run`] stops at the watched functions: it runs slower meanwhile.
    pub fn set_watching(&mut self, watching: bool) {
        self.watching = watching;
    }

    fn sleep_until(&mut self, cycle: u64) {
        let slept = cycle.saturating_sub(self.cycle).max(1);
        if self.counts_asleep {
            self.processor.count_asleep(slept);
        }
        self.cycle += slept;
        self.shared.cycle.store(self.cycle, Ordering::Relaxed);
    }

    fn service(&mut self) -> Option<Stop> {
        self.shared.accessed.store(false, Ordering::Relaxed);
        if self.processor.locked_up() && !self.locked_up {
            return Some(self.lock_up());
        }
        if self.processor.asks_for_reset() {
            return Some(self.reset(ResetFlag::Software));
        }
        let mut peripherals = lock(&self.peripherals);
        peripherals.set_cycle(self.cycle);
        peripherals.advance();
        let watchdogs = [
            (
                peripherals.devices.wwdg.expires_at(),
                ResetFlag::WindowWatchdog,
            ),
            (
                peripherals.devices.iwdg.expires_at(),
                ResetFlag::IndependentWatchdog,
            ),
        ];
        let expired = |(at, _): &&(Option<u64>, _)| at.is_some_and(|at| at <= self.cycle);
        if let Some((_, cause)) = watchdogs.iter().find(expired) {
            drop(peripherals);
            return Some(self.reset(*cause));
        }
        let place = self.processor.place();
        if peripherals.devices.wwdg.take_refreshed()
            && place.exception < FIRST_INTERRUPT
            && peripherals.devices.tim1.outputs().on
        {
            peripherals
                .findings
                .add("WWDG is refreshed by a task while the pulses are on: it may go on while the control interrupt hangs");
        }
        if peripherals.devices.iwdg.take_refreshed() && place.exception >= FIRST_INTERRUPT {
            peripherals
                .findings
                .add("IWDG is fed by an interrupt's handler, which may go on while all else hangs");
        }
        let levels = peripherals.devices.interrupts();
        if !self.locked_up {
            let now = (self.cycle, levels);
            let findings = &mut peripherals.findings;
            self.unserved.look(&self.processor, now, findings);
        }
        let pages = peripherals.devices.protected_ccm_pages();
        if pages != self.protected.0 {
            self.find_written_page(&mut peripherals.findings);
            self.protected = (pages, self.processor.ccm());
        }
        peripherals.findings.locate(place.pc);
        self.waits_until = peripherals.devices.flash.take_stall().unwrap_or_default();
        self.processor.set_nmi(peripherals.devices.nmi());
        let risen = self.processor.set_lines(levels);
        let converted = risen >> self.converted & 1 == 1;
        self.counts_asleep = peripherals.devices.debug_in_sleep();
        let latest = self.cycle + LOOK_CYCLES;
        let event = peripherals.devices.next_event();
        self.next_event = event.map_or(latest, |event| event.min(latest));
        let update = peripherals.devices.take_update();
        drop(peripherals);
        match (update, converted) {
            (true, _) => Some(Stop::Update),
            (false, true) => Some(Stop::Converted),
            (false, false) => None,
        }
    }

    /// The processor has locked up, and switches the pulses off if the image asks for that.
    fn lock_up(&mut self) -> Stop {
        self.locked_up = true;
        self.peripherals().break_by(SystemBreak::Lockup);
        Stop::LockedUp
    }

    /// Resets the chip, whose supply stays, and its memories with it.
    pub fn reset(&mut self, cause: ResetFlag) -> Stop {
        self.peripherals().reset(cause);
        let stack = self.processor.stack_pointer();
        self.before_reset = Some((self.cycle, self.processor.place(), stack));
        self.unserved.restart(self.cycle);
        self.protected = (0, Vec::new());
        self.processor.reset();
        self.locked_up = false;
        self.waits_until = 0;
        Stop::Reset(cause)
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test may panic")]
mod tests;
