//! The processor: `rsemu`'s Cortex-M4F with the memories of this chip.

mod comparison;
mod state;
#[cfg(test)]
mod tests;

use crate::memory_map::{BANK_SIZE, CCM, DEBUG, FLASH, PERIPHERALS, RAM, SECOND_BANK};
use fastrand::Rng;
use rsemu::core::space::{
    AddressSpace, DispatchPolicy, MemAttrs, MemOps, RamStore, Region, RomStore, RomWrite,
};
use rsemu::core::value::Width;
use rsemu::cpu::arm::v7m::sys::{Access, Exception, Sys};
use rsemu::cpu::arm::v7m::{ArmV7m, Config, xpsr};
use std::sync::Arc;

/// The priorities that the chip's interrupt controller knows: 16.
const PRIORITY_BITS: u8 = 4;

/// What answers is looked up by pages of 32 KiB, up to the end of RAM: a search by address takes longer.
const PAGES: DispatchPolicy = DispatchPolicy::Dense {
    page_bits: 15,
    cover: RAM.end as u64,
};

/// Where the program is at a moment.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ProgramPlace {
    /// The instruction to come.
    pub pc: u32,
    /// The number of the exception in progress; 0 for none.
    pub exception: u16,
}

/// A processor and its memories.
pub struct Processor {
    core: ArmV7m,
    space: Arc<AddressSpace>,
    /// RAM and CCM.
    memories: [Arc<RamStore>; 2],
    /// Interrupt lines as the peripherals have them, and as the core has been given them, bit by number.
    wanted: u128,
    given: u128,
    /// The level of the interrupt that cannot be masked.
    nmi: bool,
    settled: bool,
    /// It may sleep: what it did last took a cycle, as falling asleep and sleeping do. To ask the core takes longer.
    may_sleep: bool,
}

/// The priority of a program that handles no exception.
const BASE_PRIORITY: i32 = 256;

/// The number of the first exception that is an interrupt.
pub const FIRST_INTERRUPT: u16 = 16;

/// Why the memories could not be put together: a fault of this program.
#[derive(Debug, thiserror::Error)]
#[error("the emulated chip's memories do not fit together: {0}")]
pub struct MapError(String);

impl Processor {
    /// A processor that is about to start, with the first bank of the flash as it is, and what answers elsewhere.
    ///
    /// # Errors
    /// [`MapError`] if two memories overlap.
    pub fn new(
        flash: &[u8],
        second_bank: Arc<dyn MemOps>,
        peripherals: Arc<dyn MemOps>,
        debug: Arc<dyn MemOps>,
    ) -> Result<Self, MapError> {
        let space = AddressSpace::new("chip", 32).with_dispatch(PAGES);
        let first = Arc::new(RomStore::from_slice(
            flash.get(..BANK_SIZE as usize).unwrap_or(flash),
        ));
        let rom = |name| Region::rom(name, Arc::clone(&first), RomWrite::Fault);
        // The CCM has two addresses; what the second gives is the same memory.
        let ccm_size = u64::from(CCM.end - CCM.start);
        let ram_size = u64::from(RAM.end - RAM.start) - ccm_size;
        let (ram, ccm) = (
            Arc::new(RamStore::new(ram_size)),
            Arc::new(RamStore::new(ccm_size)),
        );
        let regions = [
            (rom("first bank"), u64::from(FLASH.start)),
            (rom("first bank at zero"), 0),
            (
                Region::io("second bank", u64::from(BANK_SIZE), second_bank),
                u64::from(SECOND_BANK),
            ),
            (Region::ram("ram", Arc::clone(&ram)), u64::from(RAM.start)),
            (Region::ram("ccm", Arc::clone(&ccm)), u64::from(CCM.start)),
            (
                Region::ram("ccm behind ram", Arc::clone(&ccm)),
                u64::from(RAM.start) + ram_size,
            ),
            (
                Region::io(
                    "peripherals",
                    u64::from(PERIPHERALS.end - PERIPHERALS.start),
                    peripherals,
                ),
                u64::from(PERIPHERALS.start),
            ),
            (
                Region::io("debug", u64::from(DEBUG.end - DEBUG.start), debug),
                u64::from(DEBUG.start),
            ),
        ];
        {
            let mut topology = space.topology();
            for (region, base) in regions {
                let mapped = topology.map(region, base);
                mapped.map_err(|error| MapError(error.to_string()))?;
            }
        }
        let space = Arc::new(space);
        Ok(Self {
            core: start(&space),
            space,
            memories: [ram, ccm],
            wanted: 0,
            given: 0,
            nmi: false,
            settled: true,
            may_sleep: false,
        })
    }

    /// Starts anew: what the memories hold stays.
    pub fn reset(&mut self) {
        self.core = start(&self.space);
        self.wanted = 0;
        self.given = 0;
        self.nmi = false;
        self.settled = true;
        self.may_sleep = false;
    }

    /// One instruction, or one entry of an exception; the cycles that it took.
    pub fn step(&mut self) -> u64 {
        if !self.settled {
            self.settle();
        }
        let cycles = self.core.step();
        self.may_sleep = cycles == 1;
        cycles
    }

    /// Sets the levels of the interrupts' lines, bit by number: those that have risen.
    pub fn set_lines(&mut self, levels: u128) -> u128 {
        let risen = levels & !self.wanted;
        self.settled &= levels == self.wanted;
        self.wanted = levels;
        risen
    }

    /// Hands changed lines to the core, where an exception does no harm.
    ///
    /// On entry of an exception `rsemu` 0.0.7 forgets where in an IT block the program was, and the flags of a floating-point
    /// comparison that were not fetched yet, and goes on wrongly afterwards. A line that waits for a few instructions is
    /// what the real core's own latency could do as well. The tests `the_core_alone_still_forgets_…` fail when this is no
    /// longer needed.
    fn settle(&mut self) {
        if self.core.xpsr() & xpsr::IT_MASK != 0
            || comparison::is_awaited(self.core.pc(), |address| self.half_word(address))
        {
            return;
        }
        let mut changed = self.wanted ^ self.given;
        while changed != 0 {
            let number = changed.trailing_zeros();
            let level = self.wanted >> number & 1 == 1;
            self.core.set_irq(number as u16, level);
            changed &= changed - 1;
        }
        self.given = self.wanted;
        if self.nmi {
            // It is asked for anew while its level is high: once its handler has ended, it begins again.
            self.core.with_sys(|system: &mut Sys| {
                if !system.is_active(Exception::NMI) {
                    system.set_pending(Exception::NMI, true);
                }
            });
        }
        self.settled = !self.nmi;
    }

    fn half_word(&self, address: u32) -> Option<u16> {
        let read = self
            .space
            .read(u64::from(address), Width::U16, MemAttrs::DEBUG);
        u16::try_from(read.ok()?).ok()
    }

    /// Sets the level of the interrupt that cannot be masked.
    pub fn set_nmi(&mut self, level: bool) {
        self.nmi = level;
        self.settled &= !level;
    }

    /// Whether it sleeps until an interrupt.
    #[must_use]
    pub fn sleeps(&self) -> bool {
        self.may_sleep && self.settled && self.core.is_asleep()
    }

    /// Lets the counter of cycles go on while the processor sleeps.
    pub fn count_asleep(&mut self, cycles: u64) {
        self.core.with_sys(|system| system.tick_cyccnt(cycles));
    }

    /// The stack pointer of exceptions, which the image uses for everything.
    #[must_use]
    pub fn stack_pointer(&self) -> u32 {
        self.core.msp()
    }

    /// The instruction at which the exception in progress came, by what is on the stack from its pointer on: the registers that
    /// the processor puts there, of which PC and xPSR are known by their form. None where there is no such pair.
    #[must_use]
    pub fn interrupted_at(&self, stack_pointer: u32) -> Option<u32> {
        let is_code = |pc: u32| pc & 1 == 0 && (FLASH.contains(&pc) || CCM.contains(&pc));
        let is_xpsr = |word: u32| word & xpsr::T != 0 && word & XPSR_RESERVED == 0;
        // A pointer that has run wild may be at the end of all addresses.
        let places = (0..).step_by(4).take(FRAME_SPAN);
        let mut places = places.map_while(|offset| stack_pointer.checked_add(offset));
        places.find_map(|at| {
            let xpsr = self.word(at.checked_add(4)?);
            self.word(at)
                .filter(|pc| is_code(*pc) && xpsr.is_some_and(is_xpsr))
        })
    }

    /// Whether an interrupt that is enabled would not be preempted by another one.
    #[must_use]
    pub fn withstands(&self, interrupt: u16, other: u16) -> bool {
        let [interrupt, other] = [interrupt, other].map(|one| Exception(FIRST_INTERRUPT + one));
        self.core.with_sys(|system| {
            system.is_enabled(interrupt)
                && system.priority_of(interrupt) <= system.priority_of(other)
        })
    }

    /// Whether an interrupt that is not being handled could not be taken now: interrupts are masked, or one of at least its
    /// urgency is handled.
    #[must_use]
    pub fn holds_off(&self, interrupt: u16) -> bool {
        let exception = Exception(FIRST_INTERRUPT + interrupt);
        let reached = self.core.execution_priority();
        self.core.with_sys(|system| {
            !system.is_active(exception) && reached <= system.priority_of(exception)
        })
    }

    /// Whether the program has enabled an interrupt.
    #[must_use]
    pub fn lets_through(&self, interrupt: u16) -> bool {
        let exception = Exception(FIRST_INTERRUPT + interrupt);
        self.core.with_sys(|system| system.is_enabled(exception))
    }

    /// What the CCM holds.
    #[must_use]
    pub fn ccm(&self) -> Vec<u8> {
        let [_, ccm] = &self.memories;
        let mut bytes = vec![0; (CCM.end - CCM.start) as usize];
        // It is as long as the memory.
        let _ = ccm.read_at(0, &mut bytes);
        bytes
    }

    /// Whether it has locked up: a fault within a fault.
    #[must_use]
    pub fn locked_up(&self) -> bool {
        self.core.is_locked_up()
    }

    /// Whether the program asks for a reset.
    #[must_use]
    pub fn asks_for_reset(&self) -> bool {
        self.core.reset_requested()
    }

    /// Where the program is.
    #[must_use]
    pub fn place(&self) -> ProgramPlace {
        ProgramPlace {
            pc: self.core.pc(),
            exception: self.core.current_exception().0,
        }
    }

    /// The address of the instruction to come.
    #[must_use]
    pub fn pc(&self) -> u32 {
        self.core.pc()
    }

    /// Whether a task has switched interrupts off.
    #[must_use]
    pub fn is_in_critical_section(&self) -> bool {
        self.core.current_exception().0 == 0 && self.core.regs().primask
    }

    /// How many accesses found nothing that answers, and where the last was.
    #[must_use]
    pub fn refused(&self) -> (u64, u32) {
        self.core.bus_faults()
    }

    /// A word of memory, without side effects.
    #[must_use]
    pub fn word(&self, address: u32) -> Option<u32> {
        let word = self
            .space
            .read(u64::from(address), Width::U32, MemAttrs::DEBUG);
        word.ok().and_then(|word| u32::try_from(word).ok())
    }

    /// Whether the MPU lets the program write to an address.
    #[must_use]
    pub fn permits_write(&self, address: u32) -> bool {
        let permits =
            |system: &mut Sys| system.mpu_permits(address, Access::Write, true, BASE_PRIORITY);
        self.core.with_sys(permits)
    }

    /// Sets a word of memory, as a debugger does; false where it cannot be written.
    pub fn set_word(&mut self, address: u32, word: u32) -> bool {
        let written = self.space.write(
            u64::from(address),
            Width::U32,
            u64::from(word),
            MemAttrs::DEBUG,
        );
        written.is_ok()
    }

    /// Fills RAM and CCM with a pattern, as a power-up leaves them: with anything.
    pub fn scramble_ram(&mut self, seed: u64) {
        let mut chance = Rng::with_seed(seed);
        for (memory, at) in self
            .memories
            .iter()
            .flat_map(|memory| (0..memory.len()).step_by(4).map(move |at| (memory, at)))
        {
            let word = chance.u32(..).to_le_bytes();
            // The place is within the memory.
            let _ = memory.write_at(at, &word);
        }
    }
}

/// Words from the stack pointer in which the registers of what was interrupted are looked for: the handlers of faults have
/// short texts there.
const FRAME_SPAN: usize = 256;

/// Bits of xPSR that are always zero.
const XPSR_RESERVED: u32 = 0xf << 20;

fn start(space: &Arc<AddressSpace>) -> ArmV7m {
    let config = Config::CORTEX_M4F
        .with_priority_bits(PRIORITY_BITS)
        .with_reset_vtor(FLASH.start);
    let core = ArmV7m::new(config);
    core.attach_space(Arc::clone(space));
    core
}
